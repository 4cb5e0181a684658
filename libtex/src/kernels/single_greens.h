// SPDX-License-Identifier: Apache-2.0
// single_greens.h: the single values that a green palette can hold.

#pragma once

#include <cstdint>

namespace tex::inline v1 {

// A value in thirds of a code, and the nearest endpoints (6 bits) of which it is one third, two thirds or an end; if
// several are equally near, the greatest ones.
struct SingleGreen {
    int third;
    int lower;
    int distance;
};

// The nearest such value that is not above, or not below, a value of 0 to 765 thirds.
const SingleGreen& single_green_below(int third);
const SingleGreen& single_green_above(int third);

// For endpoints at most kMaxSingleDistance apart, because the error of hardware grows with that distance. Any
// value is at most two thirds of a code from one of these. The tables cover 0 to kMostThirds thirds; each entry is
// third << 16 | lower << 8 | distance.
inline constexpr int kMaxSingleDistance = 11;
inline constexpr int kMostThirds = 3 * 255;
const std::int32_t* single_greens_below();
const std::int32_t* single_greens_above();

}  // namespace tex::inline v1
