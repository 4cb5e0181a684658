// SPDX-License-Identifier: Apache-2.0
// uastc_color_fit.h: fits lines of UASTC to values that are no directions: R, G and B, each for itself.

#pragma once

#include <cstdint>

namespace tex::inline v1 {

// Codes from 0 to 255 that need not be whole. Errors are their squared differences, summed over R, G and B.
struct UastcColors {
    alignas(64) float code[3][16];
    bool is_grey;  // R, G and B are equal: red alone is fitted, and stands for all of them
};

// Texels that share two endpoints and a plane of weights.
struct UastcColorLine {
    int range;          // of the endpoints: of kAstcRangeTable
    int weight_bits;    // 2 to 5
    unsigned texels;    // bit k is texel k
    unsigned channels;  // bit c is channel c; others are not touched
};

struct UastcColorFit {
    float error;
    std::uint8_t ends[2][3];  // numbers: see UastcContent
    std::uint8_t weights[16];
};

// Ends on the principal axis, then so many solutions by least squares for the weights that these give.
[[nodiscard]] UastcColorFit fit_uastc_colors(const UastcColors& colors, const UastcColorLine& line, int solves);

// Moves ends to neighbouring codes, one after the other and both of a channel together, while that helps, so often at
// most.
void improve_uastc_colors(const UastcColors& colors, const UastcColorLine& line, int rounds, UastcColorFit& fit);

// The number whose code is nearest to a value.
[[nodiscard]] std::uint8_t uastc_color_number(int range, float code);

}  // namespace tex::inline v1
