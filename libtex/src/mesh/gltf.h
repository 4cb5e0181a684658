// SPDX-License-Identifier: Apache-2.0
// gltf.h: reads glTF 2.0, as text and as GLB.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tex/mesh.h>
#include <tex/types.h>

#include "mesh/gltf_buffers.h"
#include "mesh/gltf_draco.h"
#include "mesh/json.h"

namespace tex::inline v1 {

// Whether a file that begins with these bytes is glTF: "glTF", or "{" after white space.
bool is_gltf(std::span<const std::byte> head);

// The JSON and the bytes of a file; of a text, its JSON alone.
struct GltfChunks {
    std::string_view json;
    std::span<const std::byte> binary;
};

// Errors: bad_data, unsupported.
Result<GltfChunks> gltf_chunks(std::span<const std::byte> bytes);

// The length of the JSON in a file of `size` bytes, which begins behind the header, if the file is GLB and its header
// is sound; else nothing.
inline constexpr std::int64_t kGlbHeader = 20;
std::optional<std::size_t> glb_json_length(std::span<const std::byte> head, std::int64_t size);

// Errors: those of read_mesh() (mesh_io.h), without a file unless `load` names one; unsupported if triangles are
// compressed by Draco and `draco` is empty. `colors`: whether colours of vertices are read.
Result<Mesh> parse_gltf(std::span<const std::byte> bytes, const LoadBeside& load, const DecodeDraco& draco = {},
                        bool colors = false);

// Reads a file that is already parsed.
Result<Mesh> parse_gltf(JsonValue root, GltfBuffers& buffers, const DecodeDraco& draco, bool colors);

// Errors: bad_data, unsupported (the version; a required extension).
Result<void> check_asset(JsonValue root);

// The relative paths of the files that hold buffers, each once. Errors: bad_data, unsupported.
Result<std::vector<std::string>> gltf_buffer_files(std::span<const std::byte> bytes);

// The places of meshes in the scene that the file shows first, or, if it has no scene, in all of its nodes.
// A node with instances (EXT_mesh_gpu_instancing) is in it once for each, called NAME[0], NAME[1] ... Errors: as
// GltfBuffers::accessor().
Result<std::vector<MeshNode>> gltf_nodes(JsonValue root, GltfBuffers& buffers);

}  // namespace tex::inline v1
