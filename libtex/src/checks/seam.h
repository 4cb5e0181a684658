// SPDX-License-Identifier: Apache-2.0
// seam.h: measures whether opposite borders of a map fit together.

#pragma once

#include <array>

#include "checks/stored.h"

namespace tex::inline v1 {

inline constexpr double kOverJoints = 1.2;

// Mean steps of one component between neighbouring lines.
struct SeamSteps {
    bool of_columns = false;  // from the right border to the left; otherwise from the bottom border to the top
    double border = 0.0;      // from the last line to the first
    double usual = 0.0;       // the 98th percentile of those inside, or half a code if that is more
    double largest = 0.0;     // of those inside

    [[nodiscard]] double ratio() const { return usual > 0.0 ? border / usual : 0.0; }
    // Whether the border stands out from every joint inside: joints differ a little.
    [[nodiscard]] bool stands_out() const { return border > kOverJoints * largest; }
};

// x and y, from column to column and from row to row. Every texel counts. Along an axis of fewer than 8 texels, nothing
// is measured.
struct Seam {
    std::array<SeamSteps, 4> steps = {};

    [[nodiscard]] double worst() const;  // the largest ratio
    // The largest ratio of those that stand out; null if none does.
    [[nodiscard]] const SeamSteps* worst_standing_out() const;
};
Seam measure_seam(const Stored& stored);

// measure_seam(), with all 0 for what cannot stand out with a ratio of `least` or more. In most maps, the first few
// lines inside tell, so that this takes next to no time.
Seam find_seam(const Stored& stored, double least);

}  // namespace tex::inline v1
