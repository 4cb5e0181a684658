// SPDX-License-Identifier: Apache-2.0
// integrate.h: heights from normals, see tex/surface.h: the same sum of squares, as a matrix.

#pragma once

#include <tex/surface.h>

#include "reference/grid.h"

namespace tex::reference {

// The heights of the least sum, with mean 0, for maps of a few hundred texels. Both axes repeat or are mirrored, and
// options.least_z and least_response have no effect.
Grid<double> integrate(const Grid<Vector>& map, const IntegrateOptions& options);

}  // namespace tex::reference
