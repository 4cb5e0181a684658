// SPDX-License-Identifier: Apache-2.0
// single_greens.h: the single values that a green palette can hold.

#pragma once

namespace tex {

// A value in thirds of a code, and the nearest endpoints (6 bits) of which it is one third, two thirds or an end; the greatest
// of several.
struct SingleGreen {
    int third;
    int lower;
    int distance;
};

// Those at or below and at or above a value of 0 to 765 thirds.
const SingleGreen& single_green_below(int third);
const SingleGreen& single_green_above(int third);

// The nearest one to `value`, 0 to 255 codes, with endpoints at most kMaxSingleDistance apart: two thirds of a code away at most. (The error of
// hardware grows with that distance.) Of two equally near ones the greater.
inline constexpr int kMaxSingleDistance = 11;
SingleGreen nearest_single_green(float value);

}  // namespace tex
