// SPDX-License-Identifier: Apache-2.0
// transfer_options.h: how normals are transferred from one mesh to another: see transfer.h.

#pragma once

#include <tex/convert_options.h>
#include <tex/names.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// The directions D of the rays: see transfer.h.
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
[[nodiscard]] Result<void> validate(const TransferOptions& options);

}  // namespace tex
#pragma GCC visibility pop
