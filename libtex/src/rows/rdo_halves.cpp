// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_halves.h"

#include <algorithm>
#include <cmath>

namespace tex::inline v1 {

RdoHalves::RdoHalves(HalfKind kind, std::size_t most) : kind_(kind) {
    constexpr std::size_t kSlack = 32;  // kernels read whole vectors
    for (std::vector<std::int16_t>& column : parts_) column.resize(most + kSlack);
    means_.resize(most + kSlack);
    lengths_.resize(most + kSlack);
    halves_.reserve(most);
}

void RdoHalves::add(const std::byte* half) {
    const HalfShape shape = half_shape(kind_, half);
    // What is not a line has no direction, so that it is found rarely, and its errors are great.
    const CopyDirection direction = shape.is_line ? copy_direction(shape.weights) : CopyDirection{};
    for (std::size_t k = 0; k < 16; ++k) parts_[k][halves_.size()] = direction.parts[k];
    const CopyHalf& added = halves_.emplace_back(copy_half(shape));
    const float mean = added.sum * (1.0f / 16.0f);
    const float length = std::sqrt(std::max(0.0f, added.squares - added.sum * mean));
    const CopySize size = copy_size(shape.line.offset + shape.line.slope * mean, std::fabs(shape.line.slope) * length);
    means_[halves_.size() - 1] = size.mean;
    lengths_[halves_.size() - 1] = size.length;
}

CopyTable RdoHalves::from(std::size_t first) const {
    CopyTable table{};
    for (std::size_t k = 0; k < 16; ++k) table.parts[k] = parts_[k].data() + first;
    table.means = means_.data() + first;
    table.lengths = lengths_.data() + first;
    table.halves = halves_.data() + first;
    return table;
}

}  // namespace tex::inline v1
