// SPDX-License-Identifier: Apache-2.0
// texel_counts.h: counts over every texel of the base level.

#pragma once

#include <array>
#include <cstdint>

#include <tex/types.h>

#include "checks/background.h"
#include "checks/stored.h"

namespace tex::inline v1 {

// Two codes of 8 bits, as a component.
inline constexpr float kTwoCodes = 4.0f / 255.0f;
// A vector shorter than this has no direction.
inline constexpr float kNullLength = 0.1f;

// The number of texels with a property, and the first of them, in rows from the top.
struct Tally {
    std::int64_t count = 0;
    int column = -1, row = -1;
    void add_row(std::int64_t in_row, int first_column, int at_row) {
        if (in_row > 0 && count == 0) {
            column = first_column;
            row = at_row;
        }
        count += in_row;
    }
};

enum class Property {
    not_finite,     // a component is NaN or infinite; no other property counts the texel
    null_vector,    // shorter than kNullLength (z stored)
    off_length,     // the length differs from 1 by more than kTwoCodes (z stored)
    z_below,        // z below -kTwoCodes (z stored)
    z_behind,       // z below -0.1 (z stored)
    beyond_unit,    // x^2 + y^2 above (1 + kTwoCodes)^2; in texel blocks, whose texels share a palette, above 1.3^2
    red_not_one,    // R below 1, for the layout (R, y, _, x)
    alpha_not_one,  // A below 1, if A is neither x nor y
    above_alpha,    // R, G or B is above A by more than one and a half codes
    grey,           // R, G and B are equal within one and a half codes
    flat_low,       // x and y are code 127 of 255
    flat_high,      // x and y are code 128
};
inline constexpr int kPropertyCount = 12;

struct TexelCounts {
    std::int64_t texels = 0;  // without the background
    std::int64_t all = 0;     // with it
    std::array<Tally, kPropertyCount> tally{};
    // Means over finite texels. z and length use the stored z, or else the reconstructed one.
    std::int64_t finite = 0;
    double mean_x = 0.0, mean_y = 0.0, mean_z = 0.0, mean_length = 0.0;
    float min_length = 0.0f, max_length = 0.0f;
    std::array<float, 4> low{}, high{};  // of the decoded channels
    double alpha_correlation = 0.0;      // correlation of A with the largest of R, G and B

    [[nodiscard]] const Tally& operator[](Property p) const { return tally[static_cast<std::size_t>(p)]; }
    [[nodiscard]] double share(Property p) const {
        const bool of_all = p == Property::red_not_one || p == Property::alpha_not_one || p == Property::above_alpha;
        const std::int64_t among = of_all ? all : texels;
        return among > 0 ? static_cast<double>((*this)[p].count) / static_cast<double>(among) : 0.0;
    }
};

// Leaves out the vectors of the background, which may be null; `low`, `high` and what concerns alpha have all texels.
// Errors: cancelled, out_of_memory.
Result<TexelCounts> count_texels(const Stored& stored, const Execution& execution,
                                 const Background* background = nullptr);

}  // namespace tex::inline v1
