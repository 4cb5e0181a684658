// SPDX-License-Identifier: Apache-2.0
// blend.h: blends detail normals with base normals, see tex/blend.h.

#pragma once

#include <vector>

#include <tex/blend.h>

#include "reference/grid.h"

namespace tex::reference {

Vector blended(Vector base, Vector detail, BlendMode mode);

// The bilinear sample at (u, v), v upwards, in widths and heights; not normalised.
Vector bilinear(const Grid<Vector>& map, double u, double v, Wrap wrap_x, Wrap wrap_y);

// The result of blend() for a base with the result's extent and one layer. The layer has all the levels
// that it needs.
Grid<Vector> blend(const Grid<Vector>& base, const std::vector<Grid<Vector>>& detail, const Layer& layer,
                   const BlendOptions& options);

}  // namespace tex::reference
