// SPDX-License-Identifier: Apache-2.0
// bake.h: heights to normals, see tex/bake.h.

#pragma once

#include <tex/bake.h>

#include "reference/grid.h"

namespace tex::reference {

// The height at any texel, inside or beyond the border, by the rules of Wrap applied again and again.
double height_at(const Grid<double>& heights, Wrap wrap_x, Wrap wrap_y, int i, int j);

Grid<Vector> bake(const HeightField& field, const BakeOptions& options);

}  // namespace tex::reference
