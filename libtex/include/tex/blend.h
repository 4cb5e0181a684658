// SPDX-License-Identifier: Apache-2.0
// blend.h: detail normals on top of base normals.

#pragma once

#include <vector>

#include <tex/execution.h>
#include <tex/height_field.h>
#include <tex/mip_chain.h>
#include <tex/names.h>
#include <tex/normal_map.h>
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
//   rnm                 t = a + (0, 0, 1), u = (-b.x, -b.y, b.z):           turns b into the frame of a
//   (Barre-Brisebois,
//                       normalize(t dot(t, u) / t.z - u)                    Hill: Blending in Detail, 2012)
//   overlay             a < 1/2 ? 2 a b : 1 - 2 (1 - a)(1 - b) of each       an image editor's; for comparison
//                       (n + 1) / 2, then normalised
//
// A result with z below 0 gets z = 0 before it is normalised; a vector shorter than 1e-6 becomes (0, 0, 1). With a flat
// detail or a flat base, whiteout, partial-derivative and rnm give the other map; whiteout, partial-derivative
// and linear do not mind the order. (Catlike Coding, Rendering 6, 3.4 and 3.5, derives the first three.)
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

// A detail map and how it lies on the base. The point (u, v) of the result, (0, 0) at its lower left corner and (1, 1)
// at its upper right, shows the detail at
//
//     (u, v) tiling + offset          in detail widths and heights, v upwards (Unity's _ST)
//
// `rotation` first turns the detail counter-clockwise about the middle of the result, whose texels are square:
// (u, v) becomes the point that lies there before the turn; the vectors turn with it. Tiling does not change vectors.
struct Layer {
    MipChain detail;     // the base level at least; levels that are missing are made where they are needed
    float scale = 1.0f;  // see scale()
    float tiling_x = 1.0f, tiling_y = 1.0f;             // above 0, at most kMaxTiling
    float offset_x = 0.0f, offset_y = 0.0f;             // at most kMaxTiling in magnitude
    float rotation = 0.0f;                              // degrees; finite
    Wrap wrap_x = Wrap::repeat, wrap_y = Wrap::repeat;  // clamp repeats the border texel, mirror does not flip vectors

    // How much of the layer shows: the result is normalize(lerp(without the layer, with it, strength mask)).
    float strength = 1.0f;  // 0 to 1
    Plane<float> mask;      // 0 to 1, over the whole result; of any extent: sampled bilinearly. Empty: 1 everywhere
};

struct BlendOptions {
    BlendMode mode = BlendMode::whiteout;
    float base_scale = 1.0f;                            // see scale()
    ScaleMode scale_mode = ScaleMode::slope;            // of the base and of every layer
    Extent extent;                                      // of the result; 0x0: the base's
    Wrap wrap_x = Wrap::repeat, wrap_y = Wrap::repeat;  // of the base, where the result has another extent
};

// Blends layers on a base, one after the other.
//
// Maps are sampled as GPUs do: bilinearly between texel centres, and where they shrink trilinearly between mip levels,
// at the level log2 of how many texels lie in one of the result (of the two directions the greater), in steps of 1/256.
// A chain of one level gets the levels that are needed (box filter, averages of vectors); of a chain of more the last
// one is used where they do not suffice. Sampled vectors are normalised, then scaled, turned and blended.
//
// The result is one level: its mips are to be built from it, not blended level by level.
//
// Preconditions (asserted): chains are not empty; numbers are in the ranges above; masks are finite.
// Errors: out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<NormalMap> blend(MipChain base, std::vector<Layer> layers, const BlendOptions& options = {},
                                      const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
