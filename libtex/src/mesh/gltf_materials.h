// SPDX-License-Identifier: Apache-2.0
// gltf_materials.h: which textures the materials of a glTF file use, and how they place them.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tex/mesh.h>
#include <tex/types.h>

#include "mesh/json.h"

namespace tex::inline v1 {

// A slot of a material that names a texture.
struct GltfSlot {
    std::string name;       // "normalTexture"
    std::string extension;  // "KHR_materials_clearcoat", or empty
    bool is_color = false;  // read as sRGB
    std::int64_t texture = 0;
    int uv_set = 0;
    UvTransform transform;
    double scale = 1.0;
};

// The slots of a material, in the order of their names; those of extensions last. Errors: bad_data.
Result<std::vector<GltfSlot>> slots_of(JsonValue material);

// Errors: bad_data.
Result<std::vector<MeshMaterial>> gltf_materials(JsonValue root);

}  // namespace tex::inline v1
