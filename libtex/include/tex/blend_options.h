// SPDX-License-Identifier: Apache-2.0
// blend_options.h: how layers lie on a base and blend with it: see blend.h.

#pragma once

#include <tex/height_field.h>
#include <tex/image.h>
#include <tex/mip_chain.h>
#include <tex/names.h>
#include <tex/result.h>
#include <tex/scale.h>

#pragma GCC visibility push(default)
namespace tex {

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
[[nodiscard]] Result<void> validate(const BlendOptions& options);
[[nodiscard]] Result<void> validate(const Layer& layer);

}  // namespace tex
#pragma GCC visibility pop
