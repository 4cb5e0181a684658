// SPDX-License-Identifier: Apache-2.0
// scale.h: normals made steeper or flatter.

#pragma once

#include <tex/execution.h>
#include <tex/mip_chain.h>
#include <tex/normal_map.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// The greatest magnitude of a scale.
inline constexpr float kMaxScale = 1e6f;

// What scale() takes, as a value.
struct Scaling {
    float scale = 1.0f;
    ScaleMode mode = ScaleMode::slope;
};

// Scales every normal by `scale`, the bump scale of shaders:
//
//   slope   normalize(s x, s y, z)                            what scaling the height by s does (glTF's
//   normalTexture.scale) xy      x' = s x, y' = s y, z' = reconstruct_z(x', y')    UnpackScaleNormal (Catlike Coding,
//   Rendering 6, 2.3),
//           and normalize(x', y', z')                         which differs from it only where x'^2 + y'^2 is above 1
//
// The two agree at s = 1 and near flat; on a normal tilted by 32 degrees they lie 2 degrees apart at s = 0.5 and 39 at
// s = 2. Scaling by s and then by 1 / s gives the map back in slope mode. s = 0 gives (0, 0, 1) everywhere. Negative s
// turns bumps into dents. z below 0 counts as 0, and a vector that scaling makes shorter than 1e-6 becomes (0, 0, 1).
//
// Every level of a chain is scaled by itself.
//
// Preconditions (asserted): `scale` is finite, at most kMaxScale in magnitude; normals have unit length.
// Errors: out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<NormalMap> scale(NormalMap map, float scale, ScaleMode mode = ScaleMode::slope,
                                      const Execution& execution = {});
[[nodiscard]] Result<MipChain> scale(MipChain chain, float scale, ScaleMode mode = ScaleMode::slope,
                                     const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
