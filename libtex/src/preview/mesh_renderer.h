// SPDX-License-Identifier: Apache-2.0
// mesh_renderer.h: computes every pixel of a picture of a mesh.

#pragma once

#include <vector>

#include "preview/colormap.h"
#include "preview/renderer.h"

namespace tex::inline v1::render {

// A line in the picture's world, which hides what is behind it and is hidden by what is clearly in front of it.
struct MeshLine {
    Vec3 from, to;
    Code color;
};

struct MeshLines {
    std::vector<MeshLine> lines;  // at most 2^28
    double width = 1.5;           // pixels
};

// Renders stage.mesh, with the lines on it. Errors: unsupported (as preview()), out_of_memory, cancelled.
[[nodiscard]] Result<Texture> render_mesh(const Stage& stage, Space space, const Surface& surface,
                                          const MeshLines& lines, const Execution& execution);

}  // namespace tex::inline v1::render
