// SPDX-License-Identifier: Apache-2.0
// gltf_slots.h: changes the text of slots of materials, of textures, and the lists of extensions.

#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <tex/file.h>
#include <tex/mesh.h>

#include "mesh/gltf_materials.h"
#include "mesh/json.h"
#include "mesh/json_text.h"

namespace tex::inline v1 {

// The slot in the text of its material, or null if that lacks it.
JsonNode* slot_node(JsonNode& material, const GltfSlot& slot);

// Adds a slot that the material lacks, such as normalTexture, with this texture.
JsonNode* add_slot(JsonNode& material, const std::string& name, std::int64_t texture);

// Gives the slot, which is described as `slot`, the scale, the set of UVs and the transform of the map.
void set_slot(JsonNode& root, JsonNode& node, const GltfSlot& slot, const ModelMap& map);

// Makes a texture show an image.
void show_image(JsonNode& root, JsonNode& texture, std::int64_t image, Container container);
// Adds a texture that does. Returns its number.
std::int64_t add_texture(JsonNode& root, std::optional<std::int64_t> sampler, std::int64_t image, Container container);

// Adds an extension to the lists of those that are used, and, if it is needed to draw the model, required.
void add_extension(JsonNode& root, const std::string& name, bool is_required);
// Takes it out of both lists.
void remove_extension(JsonNode& root, const std::string& name);
// Takes extensions of textures, and KHR_texture_transform, out of both lists if the file had them and the text no
// longer does.
void forget_extensions(JsonValue before, JsonNode& root);

}  // namespace tex::inline v1
