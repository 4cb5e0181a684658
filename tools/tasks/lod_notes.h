// SPDX-License-Identifier: Apache-2.0
// lod_notes.h: what simplified models lack, as messages.

#pragma once

#include <tex/mesh.h>

#include "tasks/job.h"

namespace tex::cli {

// Whether normals are multiples of 1/127, as gltfpack writes them, and not only along axes.
[[nodiscard]] bool has_coarse_normals(const Mesh& mesh);

// Says what the low mesh of a job with a model as output lacks. Errors: those of read_model().
[[nodiscard]] Result<void> note_lacks(Job& job);

}  // namespace tex::cli
