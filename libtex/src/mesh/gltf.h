// SPDX-License-Identifier: Apache-2.0
// gltf.h: reads glTF 2.0, as text and as GLB.

#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <tex/mesh.h>
#include <tex/result.h>

#include "mesh/gltf_buffers.h"
#include "mesh/json.h"

namespace tex {

// Whether a file that begins with these bytes is glTF: "glTF", or "{" after white space.
bool is_gltf(std::span<const std::byte> head);

// Errors: those of read_mesh() (mesh_io.h), without a file unless `load` names one.
Result<Mesh> parse_gltf(std::span<const std::byte> bytes, const LoadBeside& load);

// The relative paths of the files that hold buffers, each once. Errors: bad_data, unsupported.
Result<std::vector<std::string>> gltf_buffer_files(std::span<const std::byte> bytes);

// The places of meshes in the scene that the file shows first, or, if it has no scene, in all of its nodes.
// Errors: bad_data.
Result<std::vector<MeshNode>> gltf_nodes(JsonValue root);

}  // namespace tex
