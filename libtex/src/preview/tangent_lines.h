// SPDX-License-Identifier: Apache-2.0
// tangent_lines.h: the tangent spaces of a mesh's vertices, as lines.

#pragma once

#include "preview/colormap.h"
#include "preview/mesh_renderer.h"

namespace tex::inline v1::render {

// The colours of Catlike Coding's TangentSpaceVisualizer (Rendering 6, Bumpiness), in brighter shades.
inline constexpr Code kTangentColor{255, 92, 80};
inline constexpr Code kBinormalColor{92, 150, 255};
inline constexpr Code kNormalColor{88, 220, 100};

// The lines of `tangents` that preview.h describes.
[[nodiscard]] MeshLines tangent_lines(const MeshBody& mesh, const View& view, double width);

}  // namespace tex::inline v1::render
