// SPDX-License-Identifier: Apache-2.0

#include "formats/png/png_rows.h"

#include <algorithm>
#include <cstring>

namespace tex::inline v1 {
namespace {

constexpr std::size_t kMostHeld = std::size_t{1} << 21;
constexpr std::uint8_t kFilters = 5;

// So many rows that they need no more memory than that.
int rows_held(std::size_t stride) {
    const std::size_t rows = kMostHeld / stride;
    return static_cast<int>(std::clamp<std::size_t>(rows, 1, kPngRowsTogether));
}

}  // namespace

PlainPngRows::PlainPngRows(PngInput& input, std::uint32_t length, Extent extent, const PngKind& kind)
    : extent_(extent), kind_(kind), count_(kind.row_bytes(static_cast<std::size_t>(extent.width))),
      stride_(count_ + kPngRowGap), most_(std::min(rows_held(stride_), extent.height)),
      texels_(input, length, static_cast<double>(count_ + 1) * extent.height),
      held_(kPngZeros + static_cast<std::size_t>(most_ + 1) * stride_) {}

// Replaces the held rows by the next ones.
Result<bool> PlainPngRows::fill() {
    if (held_rows_ > 0) std::memcpy(row(-1), row(held_rows_ - 1), count_);
    held_rows_ = std::min(most_, extent_.height - next_);
    given_ = 0;
    next_ += held_rows_;
    std::uint8_t filters[kPngRowsTogether];
    for (int k = 0; k < held_rows_; ++k) {
        // The number of the filter comes before the row, where zeros belong.
        std::uint8_t* const filter = row(k) - 1;
        Result<bool> plain = texels_.read(filter, count_ + 1);
        if (!plain || !*plain) return plain;
        if (*filter >= kFilters) return false;
        filters[k] = *filter;
        *filter = 0;
    }
    unfilter_png_rows(row(-1), stride_, count_, kind_.filter_step(), held_rows_, filters);
    return true;
}

Result<bool> PlainPngRows::decode(int count, std::size_t row_bytes, std::uint8_t* rows) {
    for (int j = 0; j < count; ++j, rows += row_bytes) {
        if (given_ == held_rows_) {
            Result<bool> plain = fill();
            if (!plain || !*plain) return plain;
        }
        expand_png_row(kind_, row(given_++), static_cast<std::size_t>(extent_.width), rows);
    }
    return true;
}

}  // namespace tex::inline v1
