// SPDX-License-Identifier: Apache-2.0
// bending_grid.h: one grid of heights in steps, and the steps towards the least bending energy on it: see deband.h.

#pragma once

#include <tex/execution.h>
#include <tex/height_field.h>
#include <tex/image.h>
#include <tex/result.h>

#include "threads/parallel.h"

namespace tex {

struct BendingGrid {
    Plane<float> codes;      // NaN where no height is known
    Plane<float> low, high;  // the bounds; empty: half a step around the code
    Plane<float> weights;    // of the pull to the code, for each square of 2x2 texels
    Wrap wrap_x = Wrap::repeat;
    Wrap wrap_y = Wrap::repeat;
    float least = 0.0f;     // no height is below
    float greatest = 0.0f;  // no height is above

    [[nodiscard]] Extent extent() const { return codes.extent(); }
};

// Rows of a strip: the same for every number of threads.
inline constexpr int kBendingStrip = 64;

// Moves `heights`, which are within the bounds, `steps` steps towards the least energy.
// Errors: out_of_memory, cancelled.
Result<void> relax(const BendingGrid& grid, int steps, Plane<float>& heights, const Execution& execution,
                   ProgressSpan span);

// The grid of half the size, without weights.
Result<BendingGrid> halve(const BendingGrid& grid, const Execution& execution);

// Heights of a grid of half the size, on `grid`, within its bounds. Heights that are NaN become grid.least.
Result<Plane<float>> refine(const Plane<float>& coarse, const BendingGrid& grid, const Execution& execution);

// The bounds of row j: rows of the grid, or computed into `low` and `high`.
struct RowBounds {
    const float* low;
    const float* high;
};
RowBounds bounds_of(const BendingGrid& grid, int j, float* low, float* high);

}  // namespace tex
