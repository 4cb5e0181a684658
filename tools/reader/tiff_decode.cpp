// SPDX-License-Identifier: Apache-2.0

#include <tiffio.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "decoders.h"
#include "open_input.h"
#include "tiff_tags.h"

namespace tex::reader {
namespace {

std::string& first_error() {
    static thread_local std::string text;
    return text;
}

void keep_error(const char* /*module*/, const char* format, va_list values) {
    char text[512];
    std::vsnprintf(text, sizeof text, format, values);
    if (first_error().empty()) first_error() = text;
}

// libtiff passes on what libjpeg-turbo warns of, which is damage. Its own warnings, as of tags in a wrong order, are
// not.
void keep_warning(const char* module, const char* format, va_list values) {
    if (module != nullptr && std::string_view(module) == "JPEGLib") keep_error(module, format, values);
}

// The layout of the first picture of a file.
struct Layout {
    std::uint32_t width = 0, height = 0;
    std::uint16_t channels = 1, bits = 1, format = 1, photometric = 0, planar = 1, compression = 1;
    // A chunk is a tile, or a strip, which is as wide as the picture.
    bool has_tiles = false;
    std::uint32_t chunk_width = 0, chunk_height = 0;

    [[nodiscard]] bool is_planar() const { return planar == PLANARCONFIG_SEPARATE && channels > 1; }
    [[nodiscard]] bool is_palette() const { return photometric == PHOTOMETRIC_PALETTE; }
    // Whether libtiff turns the colours to RGB of 8 bits. JPEG in TIFF is turned to RGB by its own decoder.
    [[nodiscard]] bool needs_rgb() const {
        const bool is_jpeg = compression == COMPRESSION_JPEG;
        return compression == COMPRESSION_OJPEG || (photometric == PHOTOMETRIC_YCBCR && !is_jpeg) ||
               photometric == PHOTOMETRIC_CIELAB || photometric == PHOTOMETRIC_ICCLAB ||
               photometric == PHOTOMETRIC_LOGL || photometric == PHOTOMETRIC_LOGLUV;
    }
};

Layout layout_of(TIFF* tiff) {
    Layout layout;
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

bool refuse_damaged(ReaderHeader& header) {
    const std::string& text = first_error();
    return refuse(header, ErrorCode::bad_data, "damaged: " + (text.empty() ? "a part cannot be decoded" : text));
}

// The reason why a picture is refused, or an empty text.
std::string unsupported_reason(TIFF* tiff, const Layout& layout) {
    std::uint32_t depth = 1;
    TIFFGetField(tiff, TIFFTAG_IMAGEDEPTH, &depth);
    if (layout.photometric == PHOTOMETRIC_SEPARATED) return kCmykReason;
    if (depth > 1) return "volumes are not read";
    if (layout.format == SAMPLEFORMAT_COMPLEXINT || layout.format == SAMPLEFORMAT_COMPLEXIEEEFP)
        return "complex numbers are not read";
    if (TIFFIsCODECConfigured(layout.compression) == 0)
        return "TIFF compression " + std::to_string(layout.compression) + " is not supported";
    const bool is_log = layout.photometric == PHOTOMETRIC_LOGL || layout.photometric == PHOTOMETRIC_LOGLUV;
    if (is_log && layout.compression != COMPRESSION_SGILOG && layout.compression != COMPRESSION_SGILOG24)
        return "LogLuv colours that are not compressed as such are not supported";
    char text[1024] = {};
    if (layout.needs_rgb() && TIFFRGBAImageOK(tiff, text) == 0) return text;
    if (layout.is_palette() && (layout.bits > 16 || layout.format != SAMPLEFORMAT_UINT))
        return "a palette of " + std::to_string(layout.bits) + " bits is not supported";
    return {};
}

// Reads rows of a picture, those of a row of chunks at a time.
class Chunks {
public:
    Chunks(TIFF* tiff, const Layout& layout, const Samples& samples) : tiff_(tiff), layout_(layout), samples_(samples) {
        const tmsize_t bytes = layout.has_tiles ? TIFFTileSize(tiff) : TIFFStripSize(tiff);
        const tmsize_t row = layout.has_tiles ? TIFFTileRowSize(tiff) : TIFFScanlineSize(tiff);
        row_bytes_ = static_cast<std::size_t>(std::max<tmsize_t>(row, 0));
        chunk_.resize(static_cast<std::size_t>(std::max<tmsize_t>(bytes, 0)));
        const std::size_t samples_of_row = std::size_t{layout.chunk_width} * (layout.is_planar() ? 1 : layout.channels);
        is_sound_ = row > 0 && bytes > 0 && row_bytes_ >= (samples_of_row * layout.bits + 7) / 8 &&
                    chunk_.size() >= row_bytes_ * layout.chunk_height;
        if (layout.is_palette()) {
            is_sound_ =
                is_sound_ && TIFFGetField(tiff, TIFFTAG_COLORMAP, &palette_[0], &palette_[1], &palette_[2]) != 0;
            find_shift();
        }
    }

    // Whether the sizes that libtiff gives fit the layout.
    [[nodiscard]] bool is_sound() const { return is_sound_; }

    // Reads rows [y, y + count), of a whole row of chunks. False if they are damaged.
    bool read(std::uint32_t y, std::uint32_t count, std::byte* rows) {
        const int planes = layout_.is_planar() && !layout_.is_palette() ? layout_.channels : 1;
        for (int plane = 0; plane < planes; ++plane) {
            for (std::uint32_t x = 0; x < layout_.width; x += layout_.chunk_width) {
                if (!fetch(x, y, static_cast<std::uint16_t>(plane), count)) return false;
                place(x, plane, count, rows);
            }
        }
        return true;
    }

private:
    // Palettes of old files have numbers of 8 bits.
    void find_shift() {
        const std::size_t entries = std::size_t{1} << layout_.bits;
        bool has_wide = false;
        for (const std::uint16_t* part : palette_) {
            has_wide = has_wide || (is_sound_ && std::any_of(part, part + entries, [](auto v) { return v > 255; }));
        }
        palette_unit_ = has_wide ? 257 : 1;
    }

    bool fetch(std::uint32_t x, std::uint32_t y, std::uint16_t plane, std::uint32_t count) {
        const auto size = static_cast<tmsize_t>(chunk_.size());
        const tmsize_t got =
            layout_.has_tiles ? TIFFReadEncodedTile(tiff_, TIFFComputeTile(tiff_, x, y, 0, plane), chunk_.data(), size)
                              : TIFFReadEncodedStrip(tiff_, TIFFComputeStrip(tiff_, y, plane), chunk_.data(), size);
        // Some decoders report success but leave an error message behind.
        return got >= 0 && static_cast<std::size_t>(got) >= row_bytes_ * count && first_error().empty();
    }

    void place(std::uint32_t x, int plane, std::uint32_t count, std::byte* rows) const {
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

    void place_colours(const std::byte* from, std::size_t columns, std::byte* to) const {
        const std::size_t step = layout_.is_planar() ? 1 : layout_.channels;
        for (std::size_t i = 0; i < columns; ++i) {
            const std::uint64_t code = code_at(from, layout_.bits, i * step);
            for (const std::uint16_t* part : palette_) *to++ = static_cast<std::byte>(part[code] / palette_unit_);
        }
    }

    TIFF* tiff_;
    const Layout& layout_;
    const Samples& samples_;
    std::size_t row_bytes_ = 0;
    std::vector<std::byte> chunk_;
    bool is_sound_ = false;
    std::uint16_t* palette_[3] = {};
    int palette_unit_ = 257;
};

bool read_chunks(TIFF* tiff, const Layout& layout, const Samples& samples, ReaderHeader& header, Canvas& canvas) {
    Chunks chunks(tiff, layout, samples);
    if (!chunks.is_sound()) return refuse_damaged(header);
    const std::size_t row =
        std::size_t{layout.width} * static_cast<std::size_t>(header.channels) * reader_type_bytes(header.type);
    std::vector<std::byte> rows(row * std::min(layout.chunk_height, layout.height));
    for (std::uint32_t y = 0; y < layout.height; y += layout.chunk_height) {
        const std::uint32_t count = std::min(layout.chunk_height, layout.height - y);
        if (!chunks.read(y, count, rows.data())) return refuse_damaged(header);
        canvas.put(rows.data(), static_cast<int>(count));
    }
    canvas.end();
    return true;
}

// Colours that libtiff converts, in memory as a whole.
bool read_rgb(TIFF* tiff, const Layout& layout, ReaderHeader& header, Canvas& canvas) {
    std::vector<std::uint32_t> texels(std::size_t{layout.width} * layout.height);
    TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);  // the canvas turns the picture
    if (TIFFReadRGBAImageOriented(tiff, layout.width, layout.height, texels.data(), ORIENTATION_TOPLEFT, 1) == 0 ||
        !first_error().empty())
        return refuse_damaged(header);
    std::vector<std::uint8_t> row(std::size_t{layout.width} * 3);
    for (std::size_t j = 0; j < layout.height; ++j) {
        for (std::size_t i = 0; i < layout.width; ++i) {
            const std::uint32_t texel = texels[j * layout.width + i];
            row[3 * i] = static_cast<std::uint8_t>(TIFFGetR(texel));
            row[3 * i + 1] = static_cast<std::uint8_t>(TIFFGetG(texel));
            row[3 * i + 2] = static_cast<std::uint8_t>(TIFFGetB(texel));
        }
        canvas.put(row.data(), 1);
    }
    canvas.end();
    return true;
}

struct Closer {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};

}  // namespace

bool decode_tiff(const Task& task, ReaderHeader& header) {
    TIFFSetWarningHandler(keep_warning);
    TIFFSetErrorHandler(keep_error);
    first_error().clear();
    const std::unique_ptr<TIFF, Closer> file(open_tiff_input());
    if (!file) return refuse_damaged(header);
    TIFF* const tiff = file.get();
    const Layout layout = layout_of(tiff);
    if (layout.compression == COMPRESSION_JPEG) TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
    if (const std::string reason = unsupported_reason(tiff, layout); !reason.empty())
        return refuse(header, ErrorCode::unsupported, reason);
    Samples samples{layout.bits, layout.format, layout.photometric == PHOTOMETRIC_MINISWHITE, ReaderType::u8};
    if (!choose_type(samples)) {
        return refuse(header, ErrorCode::unsupported,
                      "samples of " + std::to_string(layout.bits) + " bits and format " +
                          std::to_string(layout.format) + " are not supported");
    }
    constexpr std::uint32_t kMost = 0x7fffffff;
    header.width = static_cast<std::int32_t>(std::min(layout.width, kMost));
    header.height = static_cast<std::int32_t>(std::min(layout.height, kMost));
    const bool is_colour = layout.needs_rgb() || layout.is_palette();
    header.channels = is_colour ? 3 : layout.channels;
    header.type = is_colour ? ReaderType::u8 : samples.type;
    const auto container = static_cast<std::uint32_t>(8 * reader_type_bytes(header.type));
    header.bits = is_colour ? 8 : std::min<std::uint32_t>(layout.bits, container);
    if (is_colour) samples = Samples{};
    if (layout.chunk_width == 0 || layout.chunk_height == 0) return refuse_damaged(header);
    name_channels(header);
    read_tags(tiff, header);
    header.stored.kind = static_cast<std::uint32_t>(layout.format);
    header.stored.bits = layout.bits;
    Canvas canvas(header);
    if (!canvas.begin(task)) return false;
    return layout.needs_rgb() ? read_rgb(tiff, layout, header, canvas)
                              : read_chunks(tiff, layout, samples, header, canvas);
}

}  // namespace tex::reader
