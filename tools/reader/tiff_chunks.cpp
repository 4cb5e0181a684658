// SPDX-License-Identifier: Apache-2.0

#include "tiff_chunks.h"

#include <algorithm>
#include <cstring>

namespace tex::reader {
namespace {

bool is_absent(TIFF* tiff, std::uint32_t chunk) {
    return TIFFGetStrileOffset(tiff, chunk) == 0 || TIFFGetStrileByteCount(tiff, chunk) == 0;
}

}  // namespace

std::string& tiff_error() {
    static thread_local std::string text;
    return text;
}

TiffLayout tiff_layout(TIFF* tiff) {
    TiffLayout layout;
    TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &layout.width);
    TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &layout.height);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &layout.channels);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &layout.bits);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &layout.format);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &layout.planar);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &layout.compression);
    if (TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &layout.photometric) == 0)
        layout.photometric = layout.channels < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB;
    if (layout.format == SAMPLEFORMAT_VOID) layout.format = SAMPLEFORMAT_UINT;
    layout.has_tiles = TIFFIsTiled(tiff) != 0;
    if (layout.has_tiles) {
        TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &layout.chunk_width);
        TIFFGetField(tiff, TIFFTAG_TILELENGTH, &layout.chunk_height);
    } else {
        layout.chunk_width = layout.width;
        TIFFGetFieldDefaulted(tiff, TIFFTAG_ROWSPERSTRIP, &layout.chunk_height);
        layout.chunk_height = std::min(layout.chunk_height, layout.height);
    }
    return layout;
}

ChunkCount count_chunks(TIFF* tiff, const TiffLayout& layout) {
    ChunkCount count;
    count.all = layout.has_tiles ? TIFFNumberOfTiles(tiff) : TIFFNumberOfStrips(tiff);
    for (std::uint32_t chunk = 0; chunk < count.all; ++chunk) count.absent += is_absent(tiff, chunk) ? 1 : 0;
    return count;
}

TiffChunks::TiffChunks(TIFF* tiff, const TiffLayout& layout, const Samples& samples, std::optional<double> no_data)
    : tiff_(tiff), layout_(layout), samples_(samples) {
    const tmsize_t bytes = layout.has_tiles ? TIFFTileSize(tiff) : TIFFStripSize(tiff);
    const tmsize_t row = layout.has_tiles ? TIFFTileRowSize(tiff) : TIFFScanlineSize(tiff);
    row_bytes_ = static_cast<std::size_t>(std::max<tmsize_t>(row, 0));
    chunk_.resize(static_cast<std::size_t>(std::max<tmsize_t>(bytes, 0)));
    const std::size_t samples_of_row = std::size_t{layout.chunk_width} * (layout.is_planar() ? 1 : layout.channels);
    is_sound_ = row > 0 && bytes > 0 && row_bytes_ >= (samples_of_row * layout.bits + 7) / 8 &&
                chunk_.size() >= row_bytes_ * layout.chunk_height;
    if (layout.is_palette()) {
        is_sound_ = is_sound_ && TIFFGetField(tiff, TIFFTAG_COLORMAP, &palette_[0], &palette_[1], &palette_[2]) != 0;
        find_shift();
    } else if (no_data) {
        no_data_.resize(reader_type_bytes(samples.type));
        if (!put_value(*no_data, samples, no_data_.data())) no_data_.clear();
    }
}

bool TiffChunks::read(std::uint32_t y, std::uint32_t count, std::byte* rows) {
    const int planes = layout_.is_planar() && !layout_.is_palette() ? layout_.channels : 1;
    for (int plane = 0; plane < planes; ++plane) {
        for (std::uint32_t x = 0; x < layout_.width; x += layout_.chunk_width) {
            const std::uint32_t chunk = chunk_at(x, y, static_cast<std::uint16_t>(plane));
            const bool absent = is_absent(tiff_, chunk);
            if (absent && !no_data_.empty()) {
                place_no_data(x, plane, count, rows);
                continue;
            }
            if (absent) std::fill(chunk_.begin(), chunk_.end(), std::byte{0});
            if (!absent && !fetch(chunk, count)) return false;
            place(x, plane, count, rows);
        }
    }
    return true;
}

// Palettes of old files have numbers of 8 bits.
void TiffChunks::find_shift() {
    const std::size_t entries = std::size_t{1} << layout_.bits;
    bool has_wide = false;
    for (const std::uint16_t* part : palette_) {
        has_wide = has_wide || (is_sound_ && std::any_of(part, part + entries, [](auto v) { return v > 255; }));
    }
    palette_unit_ = has_wide ? 257 : 1;
}

std::uint32_t TiffChunks::chunk_at(std::uint32_t x, std::uint32_t y, std::uint16_t plane) const {
    return layout_.has_tiles ? TIFFComputeTile(tiff_, x, y, 0, plane) : TIFFComputeStrip(tiff_, y, plane);
}

bool TiffChunks::fetch(std::uint32_t chunk, std::uint32_t count) {
    const auto size = static_cast<tmsize_t>(chunk_.size());
    const tmsize_t got = layout_.has_tiles ? TIFFReadEncodedTile(tiff_, chunk, chunk_.data(), size)
                                           : TIFFReadEncodedStrip(tiff_, chunk, chunk_.data(), size);
    // Some decoders report success but leave an error message behind.
    return got >= 0 && static_cast<std::size_t>(got) >= row_bytes_ * count && tiff_error().empty();
}

void TiffChunks::place(std::uint32_t x, int plane, std::uint32_t count, std::byte* rows) const {
    const std::size_t columns = std::min(layout_.chunk_width, layout_.width - x);
    const std::size_t channels = layout_.is_palette() ? 3 : layout_.channels;
    const std::size_t bytes = reader_type_bytes(samples_.type);
    for (std::uint32_t j = 0; j < count; ++j) {
        const std::byte* const from = &chunk_[row_bytes_ * j];
        std::byte* const to = rows + (std::size_t{layout_.width} * j + x) * channels * bytes;
        if (layout_.is_palette()) {
            place_colours(from, columns, to);
        } else if (layout_.is_planar()) {
            unpack(samples_, from, columns, channels, to + static_cast<std::size_t>(plane) * bytes);
        } else {
            unpack(samples_, from, columns * channels, 1, to);
        }
    }
}

void TiffChunks::place_colours(const std::byte* from, std::size_t columns, std::byte* to) const {
    const std::size_t step = layout_.is_planar() ? 1 : layout_.channels;
    for (std::size_t i = 0; i < columns; ++i) {
        const std::uint64_t code = code_at(from, layout_.bits, i * step);
        for (const std::uint16_t* part : palette_) *to++ = static_cast<std::byte>(part[code] / palette_unit_);
    }
}

void TiffChunks::place_no_data(std::uint32_t x, int plane, std::uint32_t count, std::byte* rows) const {
    const std::size_t columns = std::min(layout_.chunk_width, layout_.width - x);
    const std::size_t channels = layout_.channels, bytes = no_data_.size();
    const std::size_t step = layout_.is_planar() ? channels : 1;
    const std::size_t samples = layout_.is_planar() ? columns : columns * channels;
    for (std::uint32_t j = 0; j < count; ++j) {
        std::byte* const to = rows + ((std::size_t{layout_.width} * j + x) * channels +
                                      static_cast<std::size_t>(layout_.is_planar() ? plane : 0)) *
                                         bytes;
        for (std::size_t k = 0; k < samples; ++k) std::memcpy(to + k * step * bytes, no_data_.data(), bytes);
    }
}

}  // namespace tex::reader
