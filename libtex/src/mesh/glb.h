// SPDX-License-Identifier: Apache-2.0
// glb.h: writes the chunks of a glTF file.

#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tex/types.h>

#include "mesh/gltf.h"

namespace tex::inline v1 {

// The file with another JSON and, if `binary` is set, another binary chunk. In a GLB file, what follows these chunks
// stays. `chunks` are those of the file. Errors: unsupported (a GLB file would be too long).
Result<std::vector<std::byte>> with_chunks(std::span<const std::byte> file, const GltfChunks& chunks, std::string json,
                                           const std::optional<std::vector<std::byte>>& binary);

// A GLB file. Errors: unsupported (it would be too long).
Result<std::vector<std::byte>> glb_of(std::string json, const std::vector<std::byte>& binary);

}  // namespace tex::inline v1
