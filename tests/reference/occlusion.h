// SPDX-License-Identifier: Apache-2.0
// occlusion.h: what the horizon of a texel leaves open, in double and by brute force.

#pragma once

#include <tex/surface.h>

namespace tex::reference {

struct Sky {
    double occlusion = 0.0, sky_view = 0.0;
    double bent[3] = {};  // unit length
};

// Looks round from a texel in so many directions, in steps of a quarter texel over the bilinear surface, as far as
// the field is long and wide together, and integrates the light in steps of an angle. The slopes p (to the right) and
// q (upwards) are those of the texel's normal. distance: as OcclusionOptions.
Sky sky_of(const HeightField& field, int column, int row, double p, double q, int directions, double distance = 0.0);

// The tangent of its horizon in the direction (x, y), a unit vector with y upwards, found in the same steps; at least 0
// without a distance.
double horizon_of(const HeightField& field, int column, int row, double x, double y, double distance = 0.0);

}  // namespace tex::reference
