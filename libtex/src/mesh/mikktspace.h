// SPDX-License-Identifier: Apache-2.0
// mikktspace.h: tangents as MikkTSpace makes them.
//
// Morten S. Mikkelsen, Simulation of Wrinkled Surfaces Revisited, 2008. The steps of the reference implementation
// (mikktspace.c, for triangles and an angular threshold of 180 degrees), each on threads where the result cannot depend
// on it:
//
//     weld        corners of equal position, normal and UV are one vertex (weld.h)
//     sort out    triangles with two corners at one position take no part until the end
//     directions  s and t, in which u and v grow, of each triangle; the sign of its area in UV space
//     neighbours  triangles that share an edge (neighbours.h)
//     groups      of corners around a vertex: neighbours of equal sign. Triangles without area in UV space join the
//                 first group that reaches them and take its sign
//     tangents    of groups: sums of s, weighted by angles. A group is divided if it has opposite directions
//     the rest    corners of triangles without area take the tangent of any other corner of their vertex

#pragma once

#include <vector>

#include <tex/mesh.h>
#include <tex/types.h>

namespace tex::inline v1 {

// The tangents of all corners. w is 1 where u and v turn counter-clockwise on the triangle, and -1 elsewhere.
// Preconditions: check_part(part), normals and the set of UVs exist.
// Errors: unsupported (kMaxFan), out_of_memory, cancelled.
Result<std::vector<Float4>> mikktspace_tangents(const MeshPart& part, int uv_set, const Execution& execution);

}  // namespace tex::inline v1
