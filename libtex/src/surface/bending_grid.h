// SPDX-License-Identifier: Apache-2.0
// bending_grid.h: one grid of heights in steps, and the steps towards the least bending energy on it: see deband.h.

#pragma once

#include <tex/height.h>
#include <tex/types.h>

#include "kernels/deband.h"
#include "threads/parallel.h"

namespace tex::inline v1 {

struct BendingGrid {
    Plane<float> codes;    // NaN where no height is known
    Plane<float> weights;  // of the pull to the code, for each square of 2x2 texels
    Wrap wrap_x = Wrap::repeat;
    Wrap wrap_y = Wrap::repeat;
    CodeRange range;

    [[nodiscard]] Extent extent() const { return codes.extent(); }
};

// Rows of a strip: the same for every number of threads.
inline constexpr int kBendingStrip = 64;

// Moves `heights`, which are within the bounds, `steps` steps towards the least energy.
// Errors: out_of_memory, cancelled.
Result<void> relax(const BendingGrid& grid, int steps, Plane<float>& heights, const Execution& execution,
                   ProgressSpan span);

// A plane of half the size, each row of which `halve_two` makes of two: see kernels/deband.h.
using HalveRows = void(const float* upper, const float* lower, int count, float* out);
Result<Plane<float>> halve(const Plane<float>& plane, HalveRows* halve_two, const Execution& execution);

// Heights of a grid of half the size, on `grid`, within its bounds.
Result<Plane<float>> refine(const Plane<float>& coarse, const BendingGrid& grid, const Execution& execution);

}  // namespace tex::inline v1
