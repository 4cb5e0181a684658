// SPDX-License-Identifier: Apache-2.0
// gltf_mirrors.h: meshes that nodes mirror, mirrored themselves, so that their nodes need not.

#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tex/pipeline.h>
#include <tex/types.h>

#include "mesh/gltf.h"
#include "mesh/gltf_buffers.h"

namespace tex::inline v1 {

// A file in which some nodes no longer mirror.
struct UnmirroredGltf {
    std::vector<std::byte> bytes;
    std::map<std::string, std::vector<std::byte>> files;  // buffers beside it that changed, by their paths
    std::vector<ModelTangents> tangents;                  // for the parts as they are now
    int applied = 0, left = 0;                            // nodes that no longer mirror, and that still do
};

// Mirrors the meshes that get tangents in x where the scale of a node, or of one that it is in, mirrors them, and turns
// the x of that node over: the scene stays as it is. Engines disagree about tangents below a node that mirrors. A mesh
// that other nodes show as it is gets a copy. Nodes with skins and meshes that Draco compresses do not count; instances
// and animations that point at nodes leave a node as it is. Nothing if no node mirrors. Errors: those of accessors and
// `load`.
Result<std::optional<UnmirroredGltf>> apply_mirrors(std::span<const std::byte> file, const GltfChunks& chunks,
                                                    JsonValue root, const LoadBeside& load,
                                                    const std::vector<ModelTangents>& tangents);

}  // namespace tex::inline v1
