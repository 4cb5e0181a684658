// SPDX-License-Identifier: Apache-2.0

#include "formats/bmp/bmp_rle.h"

#include <algorithm>
#include <cstring>

#include "formats/byte_range.h"

namespace tex::inline v1 {
namespace {

// How a row ended.
enum class End { row, moved, picture, bytes };

class BmpCodes {
public:
    BmpCodes(ByteRange& bytes, int width, int depth) : bytes_(bytes), width_(width), is_rle4_(depth == 4) {}

    // Reads codes to the end of a row that begins in `column`, and writes its indices if `row` is not null. Texels to
    // the right of the picture count for nothing.
    End read_row(int column, std::uint8_t* row);

    [[nodiscard]] int rows_down() const { return down_; }  // if the row ended with a move
    [[nodiscard]] int column() const { return column_; }

private:
    bool read_indices(int count, std::uint8_t* row);
    bool move();
    void put(int k, std::byte pair, std::uint8_t* row) const {
        const auto code = std::to_integer<std::uint8_t>(pair);
        const int column = column_ + k;
        if (row == nullptr || column >= width_) return;
        row[column] = !is_rle4_ ? code : k % 2 == 0 ? code >> 4 : code & 15;
    }
    void advance(int count) { column_ = std::min(column_ + count, width_); }

    ByteRange& bytes_;
    const int width_;
    const bool is_rle4_;
    int column_ = 0;
    int down_ = 0;
};

bool BmpCodes::read_indices(int count, std::uint8_t* row) {
    const int used = is_rle4_ ? (count + 1) / 2 : count;
    const std::byte* const from = bytes_.take(static_cast<std::size_t>(used + used % 2));
    if (from == nullptr) return false;
    for (int k = 0; k < count; ++k) put(k, from[is_rle4_ ? k / 2 : k], row);
    advance(count);
    return true;
}

bool BmpCodes::move() {
    const std::byte* const by = bytes_.take(2);
    if (by == nullptr) return false;
    advance(std::to_integer<int>(by[0]));
    down_ = std::to_integer<int>(by[1]);
    return true;
}

End BmpCodes::read_row(int column, std::uint8_t* row) {
    column_ = column;
    down_ = 0;
    while (const std::byte* const code = bytes_.take(2)) {
        const int count = std::to_integer<int>(code[0]), what = std::to_integer<int>(code[1]);
        if (count > 0) {
            for (int k = 0; k < count; ++k) put(k, code[1], row);
            advance(count);
        } else if (what == 0) {
            return End::row;
        } else if (what == 1) {
            return End::picture;
        } else if (what == 2) {
            if (!move()) return End::bytes;
            if (down_ > 0) return End::moved;
        } else if (!read_indices(what, row)) {
            return End::bytes;
        }
    }
    return End::bytes;
}

}  // namespace

Result<std::vector<BmpRowStart>> find_bmp_rows(const InputFile& file, const BmpHeader& header) {
    const auto height = static_cast<std::size_t>(header.extent.height);
    std::vector<BmpRowStart> starts = {{header.first, 0, false}};
    starts.reserve(height + 1);
    ByteRange bytes(file, header.first, *file.size());
    BmpCodes codes(bytes, header.extent.width, header.depth);
    while (starts.size() <= height) {
        const End end = codes.read_row(starts.back().column, nullptr);
        if (end == End::bytes) return bytes.error();
        if (end == End::picture) break;
        const auto skipped = static_cast<std::size_t>(end == End::moved ? codes.rows_down() - 1 : 0);
        starts.resize(std::min(starts.size() + skipped, height), {bytes.position(), 0, true});
        starts.push_back({bytes.position(), end == End::moved ? codes.column() : 0, false});
    }
    starts.resize(height + 1, {bytes.position(), 0, true});
    return starts;
}

Result<void> read_bmp_rows(const InputFile& file, const BmpHeader& header, const std::vector<BmpRowStart>& starts,
                           int first, int count, std::uint8_t* indices) {
    const auto width = static_cast<std::size_t>(header.extent.width);
    const auto begin = static_cast<std::size_t>(first), end = begin + static_cast<std::size_t>(count);
    std::memset(indices, 0, width * static_cast<std::size_t>(count));
    ByteRange bytes(file, starts[begin].place, starts[end].place);
    BmpCodes codes(bytes, header.extent.width, header.depth);
    for (std::size_t j = begin; j < end; ++j, indices += width) {
        if (!starts[j].is_skipped && codes.read_row(starts[j].column, indices) == End::bytes) return bytes.error();
    }
    return {};
}

}  // namespace tex::inline v1
