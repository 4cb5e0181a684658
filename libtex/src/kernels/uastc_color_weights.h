// SPDX-License-Identifier: Apache-2.0
// uastc_color_weights.h: the codes of endpoints, and the weights for given ones, of lines of UASTC (uastc_color_fit.h).

#pragma once

#include <cstdint>

#include "kernels/uastc_color_fit.h"

namespace tex::inline v1 {

// The codes of all numbers of a range, and the number nearest to each code.
struct UastcColorRange {
    int levels = 0;
    std::uint8_t code[256] = {}, nearest[256] = {};

    // The number nearest to a code that need not be whole.
    [[nodiscard]] std::uint8_t round(float code) const;
};
[[nodiscard]] const UastcColorRange& uastc_color_range(int number);

// What is fitted: some of the channels of some texels.
struct UastcColorPart {
    const UastcColors& colors;
    const UastcColorRange& range;
    const std::uint8_t* meaning;        // of weights: 0 to 64
    int levels;                         // so many weights
    bool is_exact = false;              // whether the best weights are searched for in any case
    alignas(64) float inside[16] = {};  // 1 or 0
    int channel[3] = {}, active = 0;
};

// Sets the weights for the ends, and the error. Of more than four weights in several channels, unless `is_exact`, those
// are taken that are nearest on the line, which are the best ones but for a few texels between two of them.
void settle_uastc_colors(const UastcColorPart& part, UastcColorFit& fit);
// The best weights.
void settle_uastc_colors_exactly(const UastcColorPart& part, UastcColorFit& fit);

}  // namespace tex::inline v1
