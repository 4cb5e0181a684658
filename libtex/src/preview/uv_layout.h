// SPDX-License-Identifier: Apache-2.0
// uv_layout.h: the triangles of a mesh over the map, where their UVs place them.

#pragma once

#include <tex/preview.h>

#include "preview/mesh_body.h"

namespace tex::inline v1::render {

// The picture `uv` of preview.h, with its legend if options.legend. Errors: unsupported (as preview()), out_of_memory,
// cancelled.
[[nodiscard]] Result<Texture> uv_layout(const MeshBody& mesh, const PreviewScene& scene, const PreviewOptions& options,
                                        Extent size, const Execution& execution);

}  // namespace tex::inline v1::render
