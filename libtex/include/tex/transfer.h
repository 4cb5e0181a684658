// SPDX-License-Identifier: Apache-2.0
// transfer.h: normals from a mesh to another, with heights, occlusion and more.

#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include <tex/mesh.h>
#include <tex/types.h>

namespace tex::inline v1 {

// -- transfer ------------------------------------------------------------------------------------------------------
//
// Makes a normal map of a low mesh from a high one: the rays of what artists call baking.
//
// Each sample of the low mesh, a texel or one of n x n places in it, has a point P on the triangle whose UVs cover it
// (Coverage), and a direction D (RayMode) of unit length, out of the surface:
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
// none, or what HighDetail::normals say in the tangent space of the high mesh. With `backfaces`, n of a triangle that
// is seen from behind is turned round if it is on the side that the triangle faces. The texel's vector is the
// normalised sum of its samples that hit, converted to tangent space at the texel's centre by the decoder, or at the
// covered sample nearest to it. A texel is *missed* if triangles of the low mesh cover it, but no ray hits.
//
// Second rays start at each hit of a sample, N = rays_per_hit of them, in directions about n (about the triangle's own
// normal G if n points into it), each as often as its cosine with n says: the k-th point of Sobol's sequence, which the
// texel's place scrambles (Burley 2020). Directions below the triangle's plane are reflected by it, so that no
// triangle hides itself. They start off the surface by 2^-32 of the largest coordinate, less than a float can tell.
// Every triangle blocks them, from both sides, up to occlusion_distance. Without backfaces all is on the side of G;
// with them, on the side from which the ray came.
//
//     occlusion  the part of second rays that nothing blocks: 1 is open, 0 closed. Of a plane below an infinite wall
//                at a right angle, 1/2; its standard deviation is at most sqrt(v (1 - v) / N).
//     bent       the normalised sum of the directions that nothing blocks, in tangent space; n if all are blocked
//     thickness  the mean distance to the first triangle along N such directions about -n, at most occlusion_distance.
//                Those that meet none count as that distance, or not at all if there is no limit. It is 4/3 r in a
//                sphere of radius r.
//
// Automatic `front` and `back` follow from both meshes. They are the largest distances of the high mesh's vertices from
// the low mesh, and of the low mesh's corners and middles of triangles from the high one along their D, outwards and
// inwards, plus a quarter, plus a thousandth of the low mesh's diagonal. Distances of more than a tenth of the diagonal
// do not count, because what is so far away belongs to something else.

// The directions D of the rays: see above.
enum class RayMode { smooth, straight, vertex };

inline constexpr Named<RayMode> kRayModeNames[] = {
    {RayMode::smooth, "smooth", "averaged normals: no gaps at hard edges, skewed details on flat faces"},
    {RayMode::straight, "straight", "averaged normals near hard edges alone, the faces' own elsewhere"},
    {RayMode::vertex, "vertex", "the normals of the low mesh: gaps where they are split"},
};

// Which point counts if a ray meets several.
enum class HitChoice { outermost, nearest };

inline constexpr Named<HitChoice> kHitChoiceNames[] = {
    {HitChoice::outermost, "outermost", "the first one from outside: keeps floating details"},
    {HitChoice::nearest, "nearest", "the one nearest to the low mesh, on either side"},
};

// A length: in the unit of the meshes, in percent of the diagonal of the low mesh's box, or found from the meshes.
struct Reach {
    enum class Unit { automatic, absolute, percent };
    Unit unit = Unit::automatic;
    double value = 0.0;  // finite, 0 or more; means nothing if automatic
};

inline constexpr int kMaxRaysPerHit = 4096;

struct TransferOptions {
    RayMode rays = RayMode::smooth;
    Reach front, back;  // how far rays reach outside and inside of the low mesh
    HitChoice hit = HitChoice::outermost;
    bool backfaces = false;  // faces seen from behind count, too

    // With RayMode::straight: an edge is hard if its faces differ by more than this angle in degrees, 0 to 180; within
    // `straight_width` of hard edges, D turns to the averaged normals. Automatic: 5 percent.
    double straight_angle = 30.0;
    Reach straight_width;

    int padding = kPadAll;  // the width in texels of the border around each chart, 0 or more
    int subsamples = 1;     // of a texel, in each direction, 1 to kMaxSubsamples

    // The maps to make besides the one in tangent space: from the rays, and from second rays that start where they hit.
    bool object = false, heights = false, positions = false;
    bool occlusion = false, bent = false, thickness = false;
    bool vertex_colors = false;

    int rays_per_hit = 64;     // second rays: 1 to kMaxRaysPerHit; as many again for thickness
    Reach occlusion_distance;  // how far second rays reach; automatic: without limit

    [[nodiscard]] bool has_second_rays() const { return occlusion || bent || thickness; }
};

// Whether every option is in its range. transfer() calls it first. Errors: bad_option, which names the option.
[[nodiscard]] TEX_API Result<void> validate(const TransferOptions& options);

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
    NormalMap object;      // in the space of the meshes: see "convert" above
    Plane<float> heights;  // the mean distance of the hits from P along D, in the unit of the meshes: outside is > 0
    Plane<float> position[3];  // x, y, z of the mean hit
    Plane<float> occlusion;    // 0 to 1; background is 1
    NormalMap bent;
    Plane<float> thickness;  // in the unit of the meshes
    // If the inputs have them. The id is that of most hits of a texel, the smallest one of several; colours are means.
    Plane<std::int32_t> ids;  // kNoId: background
    Image color;              // R, G, B; background is 0
    // If the options ask for them: the mean of MeshPart::colors at the hits, interpolated. R, G, B; parts without
    // colours are white, and background is 0.
    Image vertex_color;
    Plane<TexelOrigin> origin;

    // Counts of texels; those of samples say so.
    std::int64_t covered = 0;   // hit or missed
    std::int64_t missed = 0;    // no ray of theirs hit
    std::int64_t overlaps = 0;  // samples that several triangles of the low mesh cover: the first decides
    std::int64_t moved = 0;     // samples that triangles from outside of 0 to 1 cover, too, and do not decide
    std::int64_t backward = 0;  // z is negative in tangent space, so that most encodings cannot hold them
    std::int64_t singular = 0;  // the low mesh has no tangent space there: they are (0, 0, 1)
    std::int64_t behind = 0;    // samples whose rays hit, or would hit, only triangles seen from behind

    std::int64_t rays = 0;  // all that were cast from samples and from hits

    // What was used, in the unit of the meshes; with a cage, front is the largest distance from it.
    double front = 0.0, back = 0.0;
    double diagonal = 0.0;                   // of the low mesh's box
    float lowest = 0.0f, highest = 0.0f;     // heights of hits, also if no map of heights is made
    float thinnest = 0.0f, thickest = 0.0f;  // of hits

    // What would have hit the missed texels, by a line through the first sample of each: the reach in front and behind
    // that 95 percent of those need whose line meets a triangle from outside, and the number of the others.
    double needed_front = 0.0, needed_back = 0.0;
    std::int64_t hopeless = 0;
};

inline constexpr std::int32_t kNoId = -1;

// Pictures on a part of the high mesh, at its UVs, which repeat. They are filtered bilinearly, without mip levels: of
// pictures that are finer than the map, subsamples make the mean. What pointers show must stay until transfer()
// returns.
struct HighDetail {
    // The part's own normal map in tangent space, y up, the engine that decodes it, and the part's tangents, one for
    // each corner. Null: none. The part must have normals.
    const NormalMap* normals = nullptr;
    const std::vector<Float4>* tangents = nullptr;
    Decoder decoder = Decoder::gltf;
    // Its colours: one plane is grey, of more the first three count. Null: the part is white.
    const Image* color = nullptr;
    int uv_set = 0;  // of both
    // Where this is below the cutoff, at its own set of UVs, there is nothing, and rays pass. Null: the part is solid.
    // A ray passes at most 64 triangles.
    const Plane<float>* alpha = nullptr;
    float alpha_cutoff = 0.5f;
    int alpha_uv_set = 0;
};

// What transfer() makes of a high mesh before it casts rays, kept for several low meshes or several parts of one: that
// is most of the time where the high mesh has many triangles and the maps few texels. It holds trees of boxes over the
// parts that rays met together, of at most twice as many triangles as the high mesh has, for the vector and the places
// that the last call was given; another one empties it. A vector is known by its address and those of its parts, which
// must stay as they are. Of calls at the same time, one uses it, and the others make trees of their own.
class SharedTrees;

[[nodiscard]] TEX_API std::shared_ptr<SharedTrees> share_trees();

// What transfer() may be given beside the two meshes. What pointers show must stay as it is until it returns.
struct TransferInputs {
    // The rest of the low mesh if `low` is a part of it, such as a UDIM tile. Its triangles get no texels, but count
    // for everything else: the directions of rays, which leave no gap between both parts, hard edges, the diagonal and,
    // if there are no groups, automatic reach. Only positions and normals are read.
    const MeshPart* around = nullptr;
    // The low mesh, pushed outwards: the same triangles, of which only the positions count. Rays start at O = C, the
    // same place of the cage's triangle, with D = normalize(C - P) and |C - P| in place of `front`, and a millionth of
    // the low mesh's diagonal more, so that they meet what lies on the cage. Where C is P, D is that of `rays`.
    const MeshPart* cage = nullptr;
    // With RayMode::straight, k of each place of the map, from 0 (smooth) to 1 (straight), in place of the distance to
    // hard edges. A picture of any size, which is filtered bilinearly and lies over the map.
    const Plane<float>* skew = nullptr;
    // A picture like `skew`, of a factor for `front`, 0 or more.
    const Plane<float>* offset = nullptr;
    // Rays from triangles of the low mesh meet the parts of the high one that have the same number: one for each
    // triangle, and one for each part. Rays of a number that no part has are missed. Second rays meet all parts. Both
    // are empty: all rays meet all parts.
    std::vector<int> low_groups, high_groups;
    // What TransferredMaps::ids shows of each part of the high mesh, 0 or more. Empty: there is no such map.
    std::vector<std::int32_t> high_ids;
    // What lies on each part of the high mesh. Empty: nothing.
    std::vector<HighDetail> high_details;
    // Counts rays while they are cast; may be null.
    std::atomic<std::int64_t>* rays = nullptr;
    // Where parts of the high mesh stand, any number of times: see places_in_scene(). Then `high_groups` and `high_ids`
    // have a number for each place; `high_details` are of the parts, with tangents of their own space. Rays hit exactly
    // what they would hit if there were copies of the parts in this order. If there are more than 2^24 vertices in all
    // places, automatic reach looks at some of them. Empty: each part stands once, where it is stored.
    std::vector<PartPlace> high_places = {};
    // Where the trees of the high mesh are kept for other calls; null: nowhere.
    std::shared_ptr<SharedTrees> trees = {};
};

// Makes the maps of the low mesh. `high`: the triangles that rays hit, in the same space as `low.part`. Parts need
// neither normals nor UVs.
//
// Errors: bad_data     a part does not pass check_part()
//         bad_option   the extent is empty or too large; as validate(options); the low mesh has no normals, no such set
//                      of UVs, not as many tangents as corners; its triangles cover no texel of the map; `high` is
//                      empty; no ray hits anything (the reason says how far apart the meshes are); the cage has other
//                      triangles; a skew or offset is empty, negative or not finite; groups, ids or details do not fit
//                      the meshes; a place is of no part
//         unsupported  as to_tangent_space(); more than kMaxTriangles triangles in `high`, or more than 2^32 - 2 in all
//                      its places; so many triangles lie over each other, or are so long and thin, that rays would be
//                      tested against thousands of them: on average, 512 rays in a row take more than 4096 looks at
//                      boxes or at four triangles
//         out_of_memory, cancelled
// The time of a ray is limited by that, whatever the meshes are. Copies of a triangle cost nothing.
// The same bytes for every number of threads, processor and compiler.
// Memory: 13 bytes for each texel, 12 more for object space, positions, bent normals and colours, 4 for heights,
// occlusion and thickness, and 4 while borders are filled; about 100 bytes for each triangle of the high mesh (twice
// that for groups with second rays) and 200 for each of the low one; and about 700 for each of high_places.
[[nodiscard]] TEX_API Result<TransferredMaps> transfer(Extent extent, const TangentSpace& low,
                                                       const std::vector<MeshPart>& high,
                                                       const TransferOptions& options = {},
                                                       const Execution& execution = {});
[[nodiscard]] TEX_API Result<TransferredMaps> transfer(Extent extent, const TangentSpace& low,
                                                       const std::vector<MeshPart>& high, const TransferInputs& inputs,
                                                       const TransferOptions& options = {},
                                                       const Execution& execution = {});

}  // namespace tex::inline v1
