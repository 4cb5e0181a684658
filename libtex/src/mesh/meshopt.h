// SPDX-License-Identifier: Apache-2.0
// meshopt.h: tangents as meshoptimizer makes them.
//
// meshopt_generateTangents() of meshoptimizer 1.3 without flags, for unindexed corners. It follows the same paper as
// MikkTSpace. What differs:
//
//     groups      join at every pair of triangles that share an edge, whichever pair is first. Triangles without area,
//                 in space or in UV space, belong to groups of triangles with one sign, and pass it on
//     weights     angle times the lengths of both edges, so that slivers weigh little. The angle is an approximation
//     the rest    (1, 0, 0), and -1 for triangles whose groups have no sign

#pragma once

#include <vector>

#include <tex/mesh.h>
#include <tex/types.h>

namespace tex::inline v1 {

// Returns what mikktspace_tangents() does, by the other method.
Result<std::vector<Float4>> meshopt_tangents(const MeshPart& part, int uv_set, const Execution& execution);

}  // namespace tex::inline v1
