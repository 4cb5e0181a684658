// SPDX-License-Identifier: Apache-2.0
// swizzle.h: the names of the layouts of normal maps, and how the layout of a texture is found.

#pragma once

#include <string>

#include <tex/execution.h>
#include <tex/names.h>
#include <tex/result.h>
#include <tex/texture.h>

#pragma GCC visibility push(default)
namespace tex {

inline constexpr Named<Swizzle> kSwizzleNames[] = {
    {kSwizzleXyz, "rgb", "x, y, z in R, G, B"},
    {kSwizzleDxt5nm, "dxt5nm", "x in A, y in G (Unity; also xGxR, AG)"},
    {{Component::other, Component::y, Component::z, Component::x}, "rxgb", "x in A, y in G, z in B (Doom 3)"},
    {kSwizzleXy, "rg", "x in R, y in G"},
    {kSwizzleYx, "gr", "y in R, x in G (3Dc, ATI2)"},
    {{Component::z, Component::y, Component::x, Component::other}, "bgr", "z, y, x in R, G, B"},
    {kSwizzleXxxy, "ra", "x in R, G and B, y in A (ASTC)"},
};

// The name in kSwizzleNames of the layout with x, y and z in the same channels as in `swizzle`; if there is none, the
// letters of to_string(). Files, reports and messages name a layout by this word.
[[nodiscard]] std::string layout_name(const Swizzle& swizzle);

// Finds the channels of `texture` that hold the normal. This is its own swizzle if the file states it or if the format
// leaves no choice (fewer than four channels). Otherwise the texels of the base level decide, up to about 2^20 of them,
// spread over the map:
//
//   ra       in ASTC and KTX2 (Texture::x_in_grey), R, G and B are equal (x in all three), and A is not 1 everywhere
//   rgb      R and B are constant (within 8/255), and those of a flat map (x = 0, z = 1): A is something else
//   dxt5nm   R and B are constant otherwise, and A varies or R, G, B cannot be a unit vector (if they are floats:
//            neither unchanged nor as (n + 1) / 2); or A varies and R, G and B are equal (y in all three)
//   rxgb     R is constant, A is not, and A, G, B are nearer to unit vectors than R, G, B
//   rgb      all others
//
// A texture without x or y in its own swizzle (one channel) keeps it; unpack() then reports what is missing.
//
// Errors: as decode() of the base level. The same result for every number of threads.
[[nodiscard]] Result<Swizzle> guess_swizzle(const Texture& texture, const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
