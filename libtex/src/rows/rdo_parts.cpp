// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_parts.h"

#include <algorithm>
#include <cstddef>

namespace tex::inline v1 {
namespace {

constexpr int kSquare = 512;
constexpr int kLeastRest = 64;

// The squares along an axis of so many texels.
int squares_of(int texels) { return std::max(1, (texels + kSquare - kLeastRest) / kSquare); }

}  // namespace

RdoParts::RdoParts(Extent level, int first)
    : level_(level), first_(first), across_(squares_of(level.width)), last_down_(squares_of(level.height) - 1) {}

int RdoParts::at(int column, int row) const {
    const auto down = [this](int its_row) { return std::min(its_row / kSquare, last_down_); };
    const int i = std::min(column / kSquare, across_ - 1);
    return across_ * (down(first_ + row) - down(first_)) + i;
}

std::vector<int> RdoParts::of_blocks(Extent block, int across, int rows) const {
    std::vector<int> parts;
    parts.reserve(static_cast<std::size_t>(across) * static_cast<std::size_t>(rows));
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < across; ++column)
            parts.push_back(at(block.width * column + block.width / 2, block.height * row + block.height / 2));
    }
    return parts;
}

}  // namespace tex::inline v1
