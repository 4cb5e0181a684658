// SPDX-License-Identifier: Apache-2.0
// transfer.h: makes a normal map of a low mesh from a high one: the rays of what artists call baking.
//
// Each sample of the low mesh, a texel or one of n x n places in it, has a point P on the triangle whose UVs cover it
// (convert.h: coverage), and a direction D (RayMode) of unit length, out of the surface:
//
//     smooth    the interpolated normals S of the low mesh's positions: the sum of the normals of all triangles that
//               meet at a position, each weighted by its angle there. They are the same on both sides of hard edges and
//               seams, so rays leave no gap, but bend on large flat faces.
//     straight  k = smoothstep(0, straight_width, the distance from P to the nearest hard edge),
//               D = normalize(mix(S, F, k)), where F is made as S, but from triangles on the same side of all hard
//               edges alone: on a flat face, its own normal. D is continuous, so there are no gaps, and does not bend
//               farther from hard edges than the width. An edge is hard if its faces differ by more than
//               straight_angle, or if it has not two triangles. The distance is a straight line.
//     vertex    the low mesh's own normals, interpolated
//
// The ray starts at O = P + front D and runs along -D for front + back. `outermost` takes the first triangle of the
// high mesh that it meets; `nearest` takes the one that is nearest to P. Triangles that are seen from behind, from
// which D does not point outwards, are passed over unless `backfaces` is set. The test of a ray against a triangle is
// watertight (Woop, Benthin, Wald, Watertight Ray/Triangle Intersection, JCGT 2 (1), 2013), in double: no ray passes
// between two triangles with a common edge. Among triangles at the same distance, the first one wins.
//
// At the hit, n is the normalised interpolated normal of the high mesh, or the triangle's own where the high mesh has
// none. The texel's vector is the normalised sum of its samples that hit, converted to tangent space at the texel's
// centre by the decoder (convert.h), or at the covered sample nearest to it. A texel is *missed* if triangles of the
// low mesh cover it, but no ray hits.
//
// Automatic `front` and `back` follow from both meshes. They are the largest distances of the high mesh's vertices from
// the low mesh, and of the low mesh's corners and middles of triangles from the high one along their D, outwards and
// inwards, plus a quarter, plus a thousandth of the low mesh's diagonal. Distances of more than a tenth of the diagonal
// do not count, because what is so far away belongs to something else.

#pragma once

#include <cstdint>
#include <vector>

#include <tex/convert_options.h>
#include <tex/execution.h>
#include <tex/image.h>
#include <tex/mesh.h>
#include <tex/normal_map.h>
#include <tex/result.h>
#include <tex/transfer_options.h>

#pragma GCC visibility push(default)
namespace tex {

// How a texel of a transferred map got its normal.
enum class TexelOrigin : std::uint8_t {
    none,     // it is background: (0, 0, 1)
    padding,  // it is outside of all triangles, and a copy of the nearest texel with a hit
    missed,   // it is the same inside of a triangle: no ray hit
    hit,      // rays hit the high mesh
};

struct TransferredMaps {
    NormalMap map;  // in tangent space
    // If the options ask for them, otherwise empty. Texels are filled as those of `map`; background is (0, 0, 1) in
    // object space and 0 elsewhere.
    NormalMap object;      // in the space of the meshes: see convert.h
    Plane<float> heights;  // the mean distance of the hits from P along D, in the unit of the meshes: outside is > 0
    Plane<float> position[3];  // x, y, z of the mean hit
    Plane<TexelOrigin> origin;

    // Counts of texels; those of samples say so.
    std::int64_t covered = 0;   // hit or missed
    std::int64_t missed = 0;    // no ray of theirs hit
    std::int64_t overlaps = 0;  // samples that several triangles of the low mesh cover: the first decides
    std::int64_t backward = 0;  // z is negative in tangent space, so that most encodings cannot hold them
    std::int64_t singular = 0;  // the low mesh has no tangent space there: they are (0, 0, 1)
    std::int64_t behind = 0;    // samples whose rays hit, or would hit, only triangles seen from behind

    double front = 0.0, back = 0.0;       // as used, in the unit of the meshes
    double diagonal = 0.0;                // of the low mesh's box
    float lowest = 0.0f, highest = 0.0f;  // heights of hits, also if no map of heights is made

    // What would have hit the missed texels, by a line through the first sample of each: the reach in front and behind
    // that 95 percent of those need whose line meets a triangle from outside, and the number of the others.
    double needed_front = 0.0, needed_back = 0.0;
    std::int64_t hopeless = 0;
};

// Makes the maps of the low mesh. `high`: the triangles that rays hit, in the same space as `low.part`. Parts need
// neither normals nor UVs.
//
// Errors: bad_data     a part does not pass check_part()
//         bad_option   the extent is empty or too large; as validate(options); the low mesh has no normals, no such set
//         of UVs, not as many tangents as corners; its triangles
//                      cover no texel of the map; `high` is empty; no ray hits anything (the reason says how far apart
//                      the meshes are)
//         unsupported  as to_tangent_space(); more than kMaxTriangles triangles in `high`
//         out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
// Memory: 13 bytes for each texel, 12 more for object space, 4 for heights, 12 for positions, and 4 while borders are
// filled; about 100 bytes for each triangle of the high mesh and 200 for each of the low one.
[[nodiscard]] Result<TransferredMaps> transfer(Extent extent, const TangentSpace& low,
                                               const std::vector<MeshPart>& high, const TransferOptions& options = {},
                                               const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
