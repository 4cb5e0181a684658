// SPDX-License-Identifier: Apache-2.0
// copy_values.h: what a search for copies (copy_search.h) compares: halves of blocks that may be copied, and the values
// of a half that searches.

#pragma once

#include <array>
#include <cstdint>

#include "blocks/block_half.h"

namespace tex::inline v1 {

// The shape (blocks/block_half.h) of a half that may be copied.
struct CopyHalf {
    HalfShape shape;
    float sum;      // of the weights
    float squares;  // the sum of their squares
    float inverse;  // 1 / (16 squares - sum^2), or 0 if all weights are equal
};
[[nodiscard]] CopyHalf copy_half(const HalfShape& shape);

// 16 numbers without their mean, as a unit vector in the cosine basis (of 4x4 texels, orthonormal), in units of
// 1/kDirectionUnit: the three lowest frequencies, the length of all others, rounded up, and the twelve others. Zeros if
// all numbers are equal.
inline constexpr int kDirectionUnit = 32000;
struct CopyDirection {
    std::int16_t parts[16];
};
[[nodiscard]] CopyDirection copy_direction(const float values[16]);

// The mean of 16 numbers, and the root of the sum of the squares of their distances from it, in units of 1/kMeanUnit
// and 1/kLengthUnit, rounded and limited to what 16 bits hold.
inline constexpr float kMeanUnit = 32000.0f;
inline constexpr float kLengthUnit = 8000.0f;
struct CopySize {
    std::int16_t mean, length;
};
[[nodiscard]] CopySize copy_size(float mean, float length);

// The values of a half that searches for what it may copy.
struct CopyValues {
    float values[16];
    float sum, squares;  // of the values, and of their squares
    CopyDirection direction;
    CopySize size;
};
[[nodiscard]] CopyValues copy_values(const float values[16]);

// The least sums of squared differences between 16 values and those of a half with the weights of another one,
//     [0]    whose offset and slope are free
//     [1]    whose slope is that of the other half, if keeps_slope is set; otherwise, whose offset is
//     [2]    whose offset and slope are those of the other half
// The later two are never less than the first. Rounding to codes is ignored. All are quadratic forms of the sums of the
// values, of the weights, of their squares and of their products.
[[nodiscard]] std::array<float, 3> copy_errors(const CopyHalf& half, const CopyValues& values, bool keeps_slope);

// The sum of the squared distances of the values from their mean.
[[nodiscard]] float spread_of(const CopyValues& values);

}  // namespace tex::inline v1
