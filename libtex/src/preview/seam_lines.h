// SPDX-License-Identifier: Apache-2.0
// seam_lines.h: the UV seams of a mesh, coloured by what the map decodes to on both sides.

#pragma once

#include <tex/preview.h>

#include "preview/legend.h"
#include "preview/mesh_renderer.h"

namespace tex::inline v1::render {

struct SeamLines {
    MeshLines lines;
    ColorScale scale;
};

// The lines of `seams` that preview.h describes, with a scale up to options.maximum. No lines if there are no seams.
[[nodiscard]] SeamLines seam_lines(const MeshBody& mesh, const PreviewScene& scene, const PreviewOptions& options,
                                   double width);

}  // namespace tex::inline v1::render
