// SPDX-License-Identifier: Apache-2.0
// seam.h: measures whether opposite borders of a map fit together.

#pragma once

#include "checks/stored.h"

namespace tex::inline v1 {

// The mean step of x or y from the last line to the first, divided by the 98th percentile of the mean steps between
// lines inside. Every texel counts. 0 along an axis of fewer than 8 texels.
struct Seam {
    double ratio_x = 0.0;  // from the right border to the left
    double ratio_y = 0.0;  // from the bottom border to the top
    [[nodiscard]] double worst() const { return ratio_x > ratio_y ? ratio_x : ratio_y; }
};
Seam measure_seam(const Stored& stored);

}  // namespace tex::inline v1
