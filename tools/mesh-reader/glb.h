// SPDX-License-Identifier: Apache-2.0
// glb.h: writes what Assimp has read as a GLB file (glTF 2.0), which libtex reads like any other.
//
// The file differs from glTF in one point: v of its UVs points up, as in Assimp's, because 1 - v would round. Bounds of
// positions, which glTF requires, are left out. Bones, animations, lights, cameras and textures are left out; a
// material says only whether it has a normal map.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <assimp/scene.h>

namespace tex::reader {

struct Glb {
    std::string json;             // with spaces at its end, so that it has a multiple of four bytes
    std::vector<std::byte> data;  // the same with zeros
    [[nodiscard]] std::size_t bytes() const { return 12 + 8 + json.size() + 8 + data.size(); }
};

// Precondition: the meshes of the scene consist of triangles.
Glb glb_of(const aiScene& scene);

}  // namespace tex::reader
