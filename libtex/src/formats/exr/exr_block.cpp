// SPDX-License-Identifier: Apache-2.0

#include "formats/exr/exr_block.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <span>

#include "formats/exr/exr_chunk.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{256} << 10;  // of texels: enough to be worth a thread

// Appends 32-bit integers. Files and, as exr_write.cpp asserts, processors are little-endian.
void append(std::vector<std::byte>& bytes, std::initializer_list<std::int32_t> values) {
    for (const std::int32_t value : values) {
        const auto* from = reinterpret_cast<const std::byte*>(&value);
        bytes.insert(bytes.end(), from, from + sizeof value);
    }
}

int divide_up(int a, int b) { return (a + b - 1) / b; }

// Copies every value of one channel.
template <class Value>
void copy_channel(const std::byte* texels, std::size_t texel_bytes, int count, std::byte* out) {
    for (int i = 0; i < count; ++i, texels += texel_bytes, out += sizeof(Value))
        std::memcpy(out, texels, sizeof(Value));
}

}  // namespace

int ExrGrid::band_rows() const { return has_tiles ? kExrTile : chunk_lines(Imf::ZIP_COMPRESSION); }

int ExrGrid::bands() const { return divide_up(extent.height, band_rows()); }

int ExrGrid::chunks_of_band() const { return divide_up(extent.width, chunk_width()); }

int ExrGrid::chunks_of_block() const {
    const std::size_t chunk = static_cast<std::size_t>(chunk_width() * band_rows()) * texel_bytes();
    return static_cast<int>(std::max<std::size_t>(1, kBlockBytes / chunk));
}

void ExrBand::begin(const ExrGrid& grid, int its_index) {
    index = its_index;
    rows = std::min(grid.band_rows(), grid.extent.height - index * grid.band_rows());
    held = 0;
    texels.resize(static_cast<std::size_t>(rows) * grid.row_bytes());
}

int ExrBand::add(const ExrGrid& grid, const std::byte* from, int count) {
    const int taken = std::min(count, rows - held);
    std::memcpy(texels.data() + static_cast<std::size_t>(held) * grid.row_bytes(), from,
                static_cast<std::size_t>(taken) * grid.row_bytes());
    held += taken;
    return taken;
}

Result<void> ExrBlock::run() {
    const std::shared_ptr<Zipper> zipper = zippers_.take([] { return std::make_unique<Zipper>(); });
    for (int chunk = begin_; chunk < end_; ++chunk) append_chunk(chunk, *zipper);
    chunks_.bytes.shrink_to_fit();  // blocks of smaller levels wait for long
    band_.reset();
    return {};
}

// A chunk is a head (the number of its first line, or the places of the tile and of the level, each across and down;
// then the size in bytes) and its bytes. In these, values are sorted by line, then by channel. Channels come in the
// order of their names: A, B, G, R.
void ExrBlock::append_chunk(int chunk, Zipper& zipper) {
    const int first = chunk * grid_.chunk_width();
    const int width = std::min(grid_.chunk_width(), grid_.extent.width - first);
    const std::size_t channel_size = static_cast<std::size_t>(width) * grid_.channel_bytes;
    zipper.texels.resize(static_cast<std::size_t>(band_->rows * grid_.channels) * channel_size);
    std::byte* out = zipper.texels.data();
    for (int j = 0; j < band_->rows; ++j) {
        const std::byte* const row = band_->texels.data() + static_cast<std::size_t>(j) * grid_.row_bytes() +
                                     static_cast<std::size_t>(first) * grid_.texel_bytes();
        for (int k = grid_.channels - 1; k >= 0; --k, out += channel_size) {
            const std::byte* const values = row + static_cast<std::size_t>(k) * grid_.channel_bytes;
            if (grid_.channel_bytes == 2)
                copy_channel<std::uint16_t>(values, grid_.texel_bytes(), width, out);
            else
                copy_channel<std::uint32_t>(values, grid_.texel_bytes(), width, out);
        }
    }
    const std::span<const std::byte> bytes = zipper.chunk();
    const std::size_t begin = chunks_.bytes.size();
    const auto size = static_cast<std::int32_t>(bytes.size());
    if (grid_.has_tiles)
        append(chunks_.bytes, {chunk, band_->index, grid_.level, grid_.level, size});
    else
        append(chunks_.bytes, {band_->index * grid_.band_rows(), size});
    chunks_.bytes.insert(chunks_.bytes.end(), bytes.begin(), bytes.end());
    chunks_.sizes.push_back(chunks_.bytes.size() - begin);
}

}  // namespace tex::inline v1
