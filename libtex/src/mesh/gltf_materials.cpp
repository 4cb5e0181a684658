// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <tex/mesh.h>

#include "mesh/gltf_buffers.h"

namespace tex::inline v1 {
namespace {

// A finite number that may be missing.
bool take(JsonValue value, double& number) {
    if (value.is_null()) return true;
    const std::optional<double> found = value.number();
    if (!found || !std::isfinite(*found)) return false;
    number = *found;
    return true;
}

// Two numbers that may be missing.
bool take(JsonValue pair, double& x, double& y) {
    return pair.is_null() || (pair.size() == 2 && take(pair[0], x) && take(pair[1], y));
}

// A set of UVs that may be missing.
bool take(JsonValue value, int& set) {
    if (value.is_null()) return true;
    const std::optional<double> found = value.number();
    if (!found || !(*found >= 0.0) || std::floor(*found) != *found) return false;
    set = static_cast<int>(std::min(*found, static_cast<double>(kMaxUvSets)));
    return true;
}

// glTF reads these slots as sRGB (glTF 2.0, 3.9; the KHR_materials extensions).
bool is_color_slot(std::string_view name) {
    return name == "baseColorTexture" || name == "emissiveTexture" || name == "diffuseTexture" ||
           name == "specularGlossinessTexture" || name.ends_with("ColorTexture");
}

Result<std::optional<GltfSlot>> slot_of(JsonValue info, const std::string& name) {
    const std::optional<std::int64_t> texture = info["index"].count();
    if (!texture) return std::optional<GltfSlot>();
    GltfSlot slot;
    slot.name = name;
    slot.is_color = is_color_slot(name);
    slot.texture = *texture;
    const JsonValue move = info["extensions"]["KHR_texture_transform"];
    UvTransform& to = slot.transform;
    if (!take(info["texCoord"], slot.uv_set) || !take(info["scale"], slot.scale))
        return bad_gltf("its " + name + " is damaged");
    if (!take(move["texCoord"], slot.uv_set) || !take(move["rotation"], to.rotation) ||
        !take(move["offset"], to.offset_x, to.offset_y) || !take(move["scale"], to.scale_x, to.scale_y) ||
        std::abs(to.rotation) > 1e6)
        return bad_gltf("KHR_texture_transform of its " + name + " is damaged");
    return std::optional<GltfSlot>(std::move(slot));
}

Result<void> add_slots(JsonValue object, const std::string& extension, std::vector<GltfSlot>& slots) {
    for (const std::string& key : object.keys()) {
        if (!key.ends_with("Texture")) continue;
        auto slot = slot_of(object[key], key);
        if (!slot) return slot.error();
        if (!*slot) continue;
        slots.push_back(std::move(**slot));
        slots.back().extension = extension;
    }
    return {};
}

// How the textures of a material without a normal map place a map: as all of them do, if they agree.
void take_common_transform(const std::vector<GltfSlot>& slots, MeshMaterial& material) {
    if (slots.empty()) return;
    const GltfSlot& first = slots.front();
    const bool agree = std::all_of(slots.begin(), slots.end(), [&](const GltfSlot& slot) {
        return slot.uv_set == first.uv_set && slot.transform == first.transform;
    });
    material.mixed_transforms = !agree;
    if (!agree) return;
    material.uv_set = first.uv_set;
    material.uv_transform = first.transform;
}

Result<void> take_alpha(JsonValue description, MeshMaterial& material) {
    const std::string mode = description["alphaMode"].text().value_or("OPAQUE");
    if (mode == "MASK") material.alpha_mode = AlphaMode::mask;
    if (mode == "BLEND") material.alpha_mode = AlphaMode::blend;
    const JsonValue factor = description["pbrMetallicRoughness"]["baseColorFactor"];
    if (!take(description["alphaCutoff"], material.alpha_cutoff) ||
        (factor.size() == 4 && !take(factor[3], material.alpha)))
        return bad_gltf("its alpha is damaged");
    return {};
}

Result<MeshMaterial> material_of(JsonValue root, JsonValue description) {
    MeshMaterial material;
    material.name = description["name"].text().value_or("");
    if (auto taken = take_alpha(description, material); !taken) return taken.error();
    const auto slots = slots_of(description);
    if (!slots) return slots.error();
    const auto normal =
        std::find_if(slots->begin(), slots->end(), [](const GltfSlot& slot) { return slot.name == "normalTexture"; });
    if (normal == slots->end()) {
        take_common_transform(*slots, material);
        return material;
    }
    material.has_normal_map = true;
    material.uv_set = normal->uv_set;
    material.uv_transform = normal->transform;
    const auto image = root["textures"][static_cast<std::size_t>(normal->texture)]["source"].count();
    if (!image) return material;
    const std::string uri = root["images"][static_cast<std::size_t>(*image)]["uri"].text().value_or("");
    if (!is_data_uri(uri)) material.normal_map = uri;
    return material;
}

}  // namespace

Result<std::vector<GltfSlot>> slots_of(JsonValue material) {
    std::vector<GltfSlot> slots;
    if (const auto added = add_slots(material["pbrMetallicRoughness"], {}, slots); !added) return added.error();
    if (const auto added = add_slots(material, {}, slots); !added) return added.error();
    for (const std::string& name : material["extensions"].keys()) {
        if (const auto added = add_slots(material["extensions"][name], name, slots); !added) return added.error();
    }
    return slots;
}

Result<std::vector<MeshMaterial>> gltf_materials(JsonValue root) {
    const JsonValue list = root["materials"];
    std::vector<MeshMaterial> materials;
    for (std::size_t k = 0; k < list.size(); ++k) {
        if (!list[k].is_object()) return bad_gltf("material " + std::to_string(k) + " is damaged");
        auto material = material_of(root, list[k]);
        if (!material) return bad_gltf("material " + std::to_string(k) + ": " + material.error().reason);
        materials.push_back(std::move(*material));
    }
    return materials;
}

}  // namespace tex::inline v1
