// SPDX-License-Identifier: Apache-2.0
// gltf_images.h: the images of a glTF file, and the normal maps that its materials make of them.

#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <tex/mesh.h>
#include <tex/types.h>

#include "mesh/gltf_buffers.h"
#include "mesh/gltf_materials.h"
#include "mesh/json.h"

namespace tex::inline v1 {

// The extensions by which a texture names another image than `source` does, in the order in which they count.
inline constexpr const char* kTextureExtensions[] = {"KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_webp",
                                                     "EXT_texture_avif"};

// The image that a texture shows, or -1: the first source that is there.
int image_of_texture(JsonValue root, std::int64_t texture);

// Which normals a slot holds, if it holds any.
std::optional<NormalSlot> normal_slot(const GltfSlot& slot);

// Errors: bad_data.
Result<std::vector<ModelMap>> gltf_maps(JsonValue root);

// All slots of the materials, which gltf_maps() has found to be sound.
std::vector<ModelTexture> gltf_textures(JsonValue root);

// All images, with their uses, and the bytes of those that `maps` use, or of all if `reads_all` is set.
// `ModelImage::file` is relative to the file. What is wrong with an image is its own error.
std::vector<ModelImage> gltf_images(JsonValue root, GltfBuffers& buffers, const std::vector<ModelMap>& maps,
                                    bool reads_all);

}  // namespace tex::inline v1
