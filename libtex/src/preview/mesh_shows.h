// SPDX-License-Identifier: Apache-2.0
// mesh_shows.h: the pictures that only a mesh has.

#pragma once

#include <tex/preview.h>

#include "preview/renderer.h"

namespace tex::inline v1::render {

// The picture options.show, with its legend. Preconditions: needs_mesh(options.show), stage.mesh. Errors: as preview().
[[nodiscard]] Result<Texture> show_mesh(const PreviewScene& scene, const PreviewOptions& options, const Stage& stage,
                                        const Execution& execution);

}  // namespace tex::inline v1::render
