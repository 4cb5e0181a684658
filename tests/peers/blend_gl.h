// SPDX-License-Identifier: Apache-2.0
// blend_gl.h: the whiteout blend of a base and a tiled detail map as a shader, run by Mesa's software OpenGL.

#pragma once

#include <vector>

#include <tex/types.h>

namespace peers {

struct GlBlend {
    const tex::MipChain* base = nullptr;  // drawn texel by texel
    const tex::MipChain* detail = nullptr;
    float tiling_x = 1.0f, tiling_y = 1.0f;
    float offset_x = 0.0f, offset_y = 0.0f;
    float base_scale = 1.0f, detail_scale = 1.0f;
};

// x, y, z and 1 of each texel of the base, rows from the top. Both maps are RGBA32F, repeated and sampled trilinearly.
// Empty where OpenGL reported an error.
std::vector<float> draw_whiteout(const GlBlend& blend);

}  // namespace peers
