// SPDX-License-Identifier: Apache-2.0
// found_reach.h: how far rays must reach: automatic `front` and `back` of transfer.h.

#pragma once

#include "rays/ray_directions.h"
#include "rays/ray_groups.h"

namespace tex::inline v1 {

// In the unit of the meshes.
struct FoundReach {
    double front = 0.0, back = 0.0;
};

// Both are at least a thousandth of `diagonal`. Errors: unsupported (RayWork), out_of_memory, cancelled.
Result<FoundReach> found_reach(const MeshPart& low, const RayDirections& directions, const RayGroups& groups,
                               double diagonal, const Execution& execution);

// The smallest distance of the low mesh's vertices from what their rays may meet; of some of them, if all cost too
// much.
double distance_between(const MeshPart& low, const RayGroups& groups);

}  // namespace tex::inline v1
