// SPDX-License-Identifier: Apache-2.0
// tangent_rules.h: the rules about a mesh without its map: N701 to N706, N731.

#pragma once

#include <cstddef>

#include <tex/mesh.h>

#include "checks/findings.h"

namespace tex::inline v1 {

inline constexpr double kDegrees = 57.295779513082320877;  // of a radian

// Twice the area of a triangle in the map, positive if its corners are counter-clockwise there. MikkTSpace takes w from
// its sign.
double area_in_map(const MeshPart& part, std::size_t triangle);

// Precondition: context.options.mesh is not null. Errors: as make_tangents().
Result<void> check_tangent_rules(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
