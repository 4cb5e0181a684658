// SPDX-License-Identifier: Apache-2.0
// gltf_output.h: a glTF file with changes, as text or as GLB.

#pragma once

#include "mesh/gltf_writer.h"

namespace tex::inline v1 {

// The file with these changes, as model output in pipeline.h describes, in the form that `place` says. If the output is
// in the folder of the input, copies are left out. Errors: those of read_model_maps(), `load`; bad_option, unsupported
// as write_model().
Result<WrittenGltf> write_gltf(std::span<const std::byte> file, const LoadBeside& load, const ModelPlace& place,
                               const ModelChanges& changes);

}  // namespace tex::inline v1
