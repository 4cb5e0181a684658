// SPDX-License-Identifier: Apache-2.0
// bending_weights.h: how strongly the input holds the heights, from how rough the ground is: see deband.h.

#pragma once

#include <tex/types.h>

#include "surface/bending_grid.h"

namespace tex::inline v1 {

// The weights of a grid, for each square of 2x2 texels. `finer` are those of the next finer grid; null for the finest.
// Errors: out_of_memory, cancelled.
Result<Plane<float>> bending_weights(const BendingGrid& grid, const Plane<float>* finer, const Execution& execution);

}  // namespace tex::inline v1
