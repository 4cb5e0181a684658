// SPDX-License-Identifier: Apache-2.0
// bake.h: converts heights to normals, see tex/bake.h.

#pragma once

#include <tex/bake.h>

#include "reference/grid.h"

namespace tex::reference {

// The height at any texel, inside or outside the border. Outside, the rules of Wrap are applied repeatedly.
double height_at(const Grid<double>& heights, Wrap wrap_x, Wrap wrap_y, int i, int j);

Grid<Vector> bake(const HeightField& field, const BakeOptions& options);

}  // namespace tex::reference
