// SPDX-License-Identifier: Apache-2.0

#include "rows/rdo_halves.h"

namespace tex {

RdoHalves::RdoHalves(HalfKind kind, std::size_t most) : kind_(kind) {
    for (std::vector<float>& column : weights_) column.resize(most + kVectorSlack);
    for (std::vector<float>* column : {&sum_, &squares_, &inverse_, &offset_, &slope_})
        column->resize(most + kVectorSlack);
}

void RdoHalves::add(const std::byte* half) {
    const HalfShape shape = half_shape(kind_, half);
    float sum = 0.0f;
    float squares = 0.0f;
    for (std::size_t k = 0; k < 16; ++k) {
        weights_[k][count_] = shape.weights[k];
        sum += shape.weights[k];
        squares += shape.weights[k] * shape.weights[k];
    }
    const float variance = 16.0f * squares - sum * sum;
    sum_[count_] = sum;
    squares_[count_] = squares;
    inverse_[count_] = variance > 1e-3f ? 1.0f / variance : 0.0f;
    offset_[count_] = shape.line.offset;
    slope_[count_] = shape.line.slope;
    if (!shape.is_line) {
        // The errors of what is not a line must not look small.
        inverse_[count_] = -1e6f;
        offset_[count_] = 1e6f;
    }
    ++count_;
}

LineTable RdoHalves::from(std::size_t first) const {
    LineTable table{};
    for (std::size_t k = 0; k < 16; ++k) table.weights[k] = weights_[k].data() + first;
    table.sum = sum_.data() + first;
    table.squares = squares_.data() + first;
    table.inverse = inverse_.data() + first;
    table.offset = offset_.data() + first;
    table.slope = slope_.data() + first;
    return table;
}

}  // namespace tex
