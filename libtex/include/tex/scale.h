// SPDX-License-Identifier: Apache-2.0
// scale.h: makes normals steeper or flatter.

#pragma once

#include <tex/execution.h>
#include <tex/mip_chain.h>
#include <tex/normal_map.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

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
[[nodiscard]] Result<NormalMap> scale(NormalMap map, float scale, ScaleMode mode = ScaleMode::slope,
                                      const Execution& execution = {});
[[nodiscard]] Result<MipChain> scale(MipChain chain, float scale, ScaleMode mode = ScaleMode::slope,
                                     const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
