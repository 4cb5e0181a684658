// SPDX-License-Identifier: Apache-2.0
// tangents.h: makes the tangents of a mesh, by the method that a baker or an engine uses.
//
// A normal map and the tangents that decode it belong together. If the engine makes tangents by another method than the
// baker, the shading is wrong by the angle between the two, which shows most along the seams of UV charts.

#pragma once

#include <vector>

#include <tex/execution.h>
#include <tex/mesh.h>
#include <tex/names.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// How tangents are made.
//
//   mikktspace  corners weld if position, normal and UV are equal. Triangles around a corner form groups, which end at
//               edges that are not shared and where the UVs change from mirrored to not mirrored. A group's tangent is
//               the sum of the directions in which u grows on its triangles, each projected into the plane of the
//               normal and weighted by the triangle's angle. Degenerate triangles take the tangents of their
//               neighbours. (Morten S. Mikkelsen, Simulation of Wrinkled Surfaces Revisited, 2008, and mikktspace.h.)
//               Results are those of the reference implementation, including the neighbours that it misses: it leaves
//               the edges of the last vertex unsorted.
//   meshopt     meshoptimizer 1.3 (meshopt_generateTangents without flags): similar groups, but larger triangles weigh
//               more. The weight is the product of the angle and the lengths of both edges, in the plane of the normal.
enum class TangentMethod { mikktspace, meshopt };

inline constexpr Named<TangentMethod> kTangentMethodNames[] = {
    {TangentMethod::mikktspace, "mikktspace", "MikkTSpace: most bakers, Blender, Unity, Unreal"},
    {TangentMethod::meshopt, "meshopt", "meshoptimizer 1.3 with its own weights: Godot"},
};

// The most triangles that may meet at one vertex if their tangents point in opposite directions (mikktspace) or at all
// (meshopt). The methods compare all pairs of these.
inline constexpr int kMaxFan = 4096;

// The tangents of all corners: one for each element of part.indices, from set `uv_set` of its UVs. Tangents have unit
// length; corners for which the method finds no direction have (1, 0, 0). w is as described in mesh.h.
// Vertices whose corners have different tangents must be split before the tangents become an attribute of vertices.
//
// Errors: bad_data     check_part(part) fails
//         bad_option   the part has no normals or no such set of UVs
//         unsupported  more than kMaxFan triangles meet at one vertex, as explained there
//         out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
// Memory: about 50 bytes for each corner, including the result.
[[nodiscard]] Result<std::vector<Float4>> make_tangents(const MeshPart& part,
                                                        TangentMethod method = TangentMethod::mikktspace,
                                                        int uv_set = 0, const Execution& execution = {});

// The tangents that the part's vertices have, one for each corner. Errors: bad_option (there are none), out_of_memory.
[[nodiscard]] Result<std::vector<Float4>> stored_tangents(const MeshPart& part);

}  // namespace tex
#pragma GCC visibility pop
