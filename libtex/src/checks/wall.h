// SPDX-License-Identifier: Apache-2.0
// wall.h: finds a wall along the border of a map whose heights do not repeat, as BorderSlope does while it is baked.

#pragma once

#include "checks/stored.h"

namespace tex::inline v1 {

// BorderSlope::ratio() of the map if it is above BorderSlope::kWall, otherwise 0. Texels that are not finite are flat.
// In most maps, the first few lines inside are steep enough to tell that there is none.
double find_wall(const Stored& stored);

}  // namespace tex::inline v1
