// SPDX-License-Identifier: Apache-2.0
// bending_weights.h: how strongly the input holds the heights, from how rough the ground is: see deband.h.

#pragma once

#include <tex/execution.h>
#include <tex/image.h>
#include <tex/result.h>

#include "surface/bending_grid.h"

namespace tex {

// The weights of the finest grid, for each square of 2x2 texels. `half` is the grid of half the size; null if there is
// none. Errors: out_of_memory, cancelled.
Result<Plane<float>> finest_weights(const BendingGrid& grid, const BendingGrid* half, const Execution& execution);

// The weights of a grid, the next finer one of which has the weights `finer`.
Result<Plane<float>> coarser_weights(const BendingGrid& grid, const Plane<float>& finer, const Execution& execution);

}  // namespace tex
