// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_slots.h"

#include <utility>

#include "mesh/gltf_images.h"

namespace tex::inline v1 {
namespace {

constexpr const char* kTransform = "KHR_texture_transform";

std::string text_of(const JsonNode& node) {
    std::string text;
    node.write(text);
    return text;
}

std::string transform_text(const UvTransform& to) {
    std::string text = "{\"offset\":[" + json_number(to.offset_x) + ',' + json_number(to.offset_y) + ']';
    if (to.rotation != 0.0) text += ",\"rotation\":" + json_number(to.rotation);
    return text + ",\"scale\":[" + json_number(to.scale_x) + ',' + json_number(to.scale_y) + "]}";
}

// Whether an object below has such a member.
bool has_member(JsonValue value, std::string_view name) {
    for (std::size_t k = 0; k < value.size(); ++k) {
        if (has_member(value[k], name)) return true;
    }
    for (const std::string& key : value.keys()) {
        if (key == name || has_member(value[key], name)) return true;
    }
    return false;
}

void forget_transform(JsonValue before, JsonNode& root) {
    JsonNode* const materials = root.member("materials");
    if (materials == nullptr || !has_member(before["materials"], kTransform)) return;
    const std::string text = text_of(*materials);
    const auto now = JsonDocument::parse(text);
    if (now && !has_member(now->root(), kTransform)) remove_extension(root, kTransform);
}

}  // namespace

JsonNode* slot_node(JsonNode& material, const GltfSlot& slot) {
    JsonNode* node = &material;
    if (!slot.extension.empty()) node = node->member("extensions")->member(slot.extension);
    if (JsonNode* const info = node->member(slot.name)) return info;
    JsonNode* const roughness = node->member("pbrMetallicRoughness");
    return roughness == nullptr ? nullptr : roughness->member(slot.name);
}

JsonNode* add_slot(JsonNode& material, const std::string& name, std::int64_t texture) {
    material.set(name, "{\"index\":" + std::to_string(texture) + "}");
    return material.member(name);
}

void set_slot(JsonNode& root, JsonNode& node, const GltfSlot& slot, const ModelMap& map) {
    if (map.scale != slot.scale) map.scale == 1.0 ? node.remove("scale") : node.set("scale", json_number(map.scale));
    if (map.uv_set == slot.uv_set && map.uv_transform == slot.transform) return;
    // The extension may name another set of UVs, which counts instead of that of the slot.
    map.uv_set == 0 ? node.remove("texCoord") : node.set("texCoord", std::to_string(map.uv_set));
    JsonNode* extensions = node.member("extensions");
    if (map.uv_transform == UvTransform{}) {
        if (extensions == nullptr) return;
        extensions->remove(kTransform);
        if (extensions->size() == 0) node.remove("extensions");
        return;
    }
    if (extensions == nullptr) node.set("extensions", "{}");
    node.member("extensions")->set(kTransform, transform_text(map.uv_transform));
    add_extension(root, kTransform, false);
}

void show_image(JsonNode& root, JsonNode& texture, std::int64_t image, Container container) {
    const char* const extension = container == Container::webp   ? "EXT_texture_webp"
                                  : container == Container::ktx2 ? "KHR_texture_basisu"
                                                                 : nullptr;
    if (JsonNode* const extensions = texture.member("extensions")) {
        for (const char* const name : kTextureExtensions) extensions->remove(name);
        if (extensions->size() == 0) texture.remove("extensions");
    }
    if (extension == nullptr) {
        const JsonNode* const source = texture.member("source");
        if (source == nullptr || text_of(*source) != std::to_string(image))
            texture.set("source", std::to_string(image));
        return;
    }
    texture.remove("source");
    if (texture.member("extensions") == nullptr) texture.set("extensions", "{}");
    texture.member("extensions")->set(extension, "{\"source\":" + std::to_string(image) + "}");
    add_extension(root, extension, true);
}

std::int64_t add_texture(JsonNode& root, std::optional<std::int64_t> sampler, std::int64_t image, Container container) {
    if (root.member("textures") == nullptr) root.set("textures", "[]");
    JsonNode& list = *root.member("textures");
    list.append(sampler ? "{\"sampler\":" + std::to_string(*sampler) + "}" : "{}");
    show_image(root, *list.element(list.size() - 1), image, container);
    return static_cast<std::int64_t>(list.size()) - 1;
}

void add_extension(JsonNode& root, const std::string& name, bool is_required) {
    for (const char* const list : {"extensionsUsed", "extensionsRequired"}) {
        if (list == std::string_view("extensionsRequired") && !is_required) continue;
        if (root.member(list) == nullptr) root.set(list, "[]");
        JsonNode& node = *root.member(list);
        bool is_there = false;
        for (std::size_t k = 0; k < node.size(); ++k)
            is_there = is_there || text_of(*node.element(k)) == json_string(name);
        if (!is_there) node.append(json_string(name));
    }
}

void remove_extension(JsonNode& root, const std::string& name) {
    for (const char* const list : {"extensionsUsed", "extensionsRequired"}) {
        JsonNode* const node = root.member(list);
        if (node == nullptr) continue;
        for (std::size_t k = node->size(); k-- > 0;) {
            if (text_of(*node->element(k)) == json_string(name)) node->remove_element(k);
        }
        if (node->size() == 0) root.remove(list);
    }
}

void forget_extensions(JsonValue before, JsonNode& root) {
    JsonNode* const textures = root.member("textures");
    for (const char* const name : kTextureExtensions) {
        bool was_used = false, is_used = false;
        for (std::size_t t = 0; t < before["textures"].size(); ++t)
            was_used = was_used || !before["textures"][t]["extensions"][name].is_null();
        for (std::size_t t = 0; was_used && t < textures->size(); ++t) {
            JsonNode* const extensions = textures->element(t)->member("extensions");
            is_used = is_used || (extensions != nullptr && extensions->member(name) != nullptr);
        }
        if (was_used && !is_used) remove_extension(root, name);
    }
    forget_transform(before, root);
}

}  // namespace tex::inline v1
