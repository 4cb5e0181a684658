// SPDX-License-Identifier: Apache-2.0
// blend.h: normals are scaled and blended.

#pragma once

#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {

// -- scale ---------------------------------------------------------------------------------------------------------
//
// Makes normals steeper or flatter.

// The greatest magnitude of a scale.
inline constexpr float kMaxScale = 1e6f;

// The arguments of scale() as a value.
struct Scaling {
    float scale = 1.0f;
    ScaleMode mode = ScaleMode::slope;
};

// Scales every normal by `scale`, the bump scale of shaders:
//
//   slope   normalize(s x, s y, z)                             as scaling the height by s does (glTF's
//                                                              normalTexture.scale)
//   xy      x' = s x, y' = s y, z' = reconstruct_z(x', y'),    UnpackScaleNormal (Catlike Coding, Rendering 6, 2.3),
//           then normalize(x', y', z')                         but normalised, which matters only if x'^2 + y'^2 > 1
//
// The two agree at s = 1 and near flat. On a normal tilted by 32 degrees they differ by 2 degrees at s = 0.5 and by 39
// at s = 2. In slope mode, scaling by s and then by 1 / s restores the map. s = 0 gives (0, 0, 1) everywhere. Negative
// s turns bumps into dents. z below 0 counts as 0, and a vector that scaling makes shorter than 1e-6 becomes (0, 0, 1).
//
// Each level of a chain is scaled on its own.
//
// Precondition: normals have unit length.
// Errors: bad_option (a map has no texels; `scale` is not finite, or above kMaxScale in magnitude), out_of_memory,
//         cancelled
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<NormalMap> scale(NormalMap map, float scale, ScaleMode mode = ScaleMode::slope,
                                              const Execution& execution = {});
[[nodiscard]] TEX_API Result<MipChain> scale(MipChain chain, float scale, ScaleMode mode = ScaleMode::slope,
                                             const Execution& execution = {});

// -- blend ---------------------------------------------------------------------------------------------------------
//
// Detail normals blended over base normals.

// How a base normal a and a detail normal b become one.
//
//   whiteout            normalize(a.x + b.x, a.y + b.y, a.z b.z)            Oat, SIGGRAPH 2007; Unity's BlendNormals
//   linear              normalize(a + b)                                    flattens both
//   partial-derivative  normalize(a.x b.z + b.x a.z, a.y b.z + b.y a.z, a.z b.z)   adds the slopes, as heights add
//   udn                 normalize(a.x + b.x, a.y + b.y, a.z)                Unreal Developer Network
//   rnm                 t = a + (0, 0, 1), u = (-b.x, -b.y, b.z):           rotates b into the frame of a
//                       normalize(t dot(t, u) / t.z - u)                    (Barre-Brisebois, Hill: Blending in
//                                                                           Detail, 2012)
//   overlay             a < 1/2 ? 2 a b : 1 - 2 (1 - a)(1 - b) of each      as in an image editor; for comparison
//                       (n + 1) / 2, then normalised
//
// If z of a result is below 0, it becomes 0 before the result is normalised; a vector shorter than 1e-6 becomes
// (0, 0, 1). If the detail or the base is flat, whiteout, partial-derivative and rnm give the other map. whiteout,
// partial-derivative and linear are commutative. (Catlike Coding, Rendering 6, 3.4 and 3.5, derives the first three.)
enum class BlendMode { whiteout, linear, partial_derivative, udn, rnm, overlay };

inline constexpr Named<BlendMode> kBlendModeNames[] = {
    {BlendMode::whiteout, "whiteout", "add x and y, multiply z: keeps both maps strong"},
    {BlendMode::linear, "linear", "add the vectors: flattens both"},
    {BlendMode::partial_derivative, "partial-derivative", "add the slopes, as heights add"},
    {BlendMode::udn, "udn", "add x and y, keep the base's z"},
    {BlendMode::rnm, "rnm", "turn the detail into the base's frame"},
    {BlendMode::overlay, "overlay", "an image editor's overlay of the colours"},
};

// The greatest tiling, and the greatest magnitude of an offset.
inline constexpr float kMaxTiling = 4096.0f;

// A detail map and its place on the base. The point (u, v) of the result, with (0, 0) at its lower left corner and
// (1, 1) at its upper right corner, shows the detail at
//
//     (u, v) tiling + offset          in detail widths and heights, v upwards (Unity's _ST)
//
// `rotation` first rotates the detail counter-clockwise about the middle of the result, whose texels are square: (u, v)
// becomes the point that was there before the rotation. The vectors rotate too. Tiling does not change vectors.
struct Layer {
    MipChain detail;                         // at least the base level; missing levels are made if they are needed
    float scale = 1.0f;                      // see scale()
    float tiling_x = 1.0f, tiling_y = 1.0f;  // above 0, at most kMaxTiling
    float offset_x = 0.0f, offset_y = 0.0f;  // at most kMaxTiling in magnitude
    float rotation = 0.0f;                   // degrees; finite
    Wrap wrap_x = Wrap::repeat, wrap_y = Wrap::repeat;  // clamp repeats the border texel, mirror does not flip vectors

    // How much of the layer shows: the result is normalize(lerp(without the layer, with it, strength mask)).
    float strength = 1.0f;  // 0 to 1
    Plane<float> mask;      // 0 to 1, over the whole result; any extent, sampled bilinearly; empty: 1 everywhere
};

struct BlendOptions {
    BlendMode mode = BlendMode::whiteout;
    float base_scale = 1.0f;                            // see scale()
    ScaleMode scale_mode = ScaleMode::slope;            // of the base and of every layer
    Extent extent;                                      // of the result; 0x0: the base's
    Wrap wrap_x = Wrap::repeat, wrap_y = Wrap::repeat;  // of the base, if the result has another extent
};

// Whether every number is in its range; not whether the layer has a map. The verbs call it first. Errors: bad_option,
// which names the option.
[[nodiscard]] TEX_API Result<void> validate(const BlendOptions& options);
[[nodiscard]] TEX_API Result<void> validate(const Layer& layer);

// Blends layers over a base, one after the other.
//
// Maps are sampled as on a GPU: bilinearly between texel centres and, if they shrink, trilinearly between mip levels.
// The level is log2 of the number of map texels along one texel of the result (the larger of both directions), in steps
// of 1/256. If a chain has one level, the other levels are made as needed (box filter, averages of vectors); if it has
// more but too few, the last one is used. Sampled vectors are normalised, then scaled, rotated and blended.
//
// The result has the data beside the normals of the base (NormalMap::blue, alpha, length), sampled as its normals are;
// levels that are made hold the means. Where a layer has a mask and its detail the same channel, the channel goes from
// that of the base to that of the detail as the mask says, times the strength: out = base + w (detail - base).
//
// The result is one level. Build its mip levels from it; do not blend level by level.
//
// Precondition: masks are finite.
// Errors: bad_option (a chain has no level, or levels of other extents than those of level_extent(); as validate()),
//         out_of_memory, cancelled
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] TEX_API Result<NormalMap> blend(MipChain base, std::vector<Layer> layers,
                                              const BlendOptions& options = {}, const Execution& execution = {});

}  // namespace tex::inline v1
