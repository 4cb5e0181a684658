// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_images.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "mesh/gltf_materials.h"

namespace tex::inline v1 {

int image_of_texture(JsonValue root, std::int64_t texture) {
    const JsonValue description = root["textures"][static_cast<std::size_t>(texture)];
    const auto image_at = [&](JsonValue source) {
        const std::optional<std::int64_t> image = source.count();
        return image && static_cast<std::size_t>(*image) < root["images"].size() ? static_cast<int>(*image) : -1;
    };
    for (const char* const extension : kTextureExtensions) {
        const int image = image_at(description["extensions"][extension]["source"]);
        if (image >= 0) return image;
    }
    return image_at(description["source"]);
}

std::optional<NormalSlot> normal_slot(const GltfSlot& slot) {
    if (slot.name == "normalTexture" && slot.extension.empty()) return NormalSlot::normal;
    if (slot.name == "clearcoatNormalTexture") return NormalSlot::clearcoat_normal;
    return std::nullopt;
}

namespace {

// Where the bytes of an image are. Those in the file are read if `reads` is set.
Result<void> locate(JsonValue description, GltfBuffers& buffers, bool reads, ModelImage& image) {
    if (const JsonValue view = description["bufferView"]; !view.is_null()) {
        if (!reads) return {};
        const auto bytes = buffers.view_bytes(view);
        if (!bytes) return bytes.error();
        image.bytes.assign(bytes->begin(), bytes->end());
        return {};
    }
    const std::string uri = description["uri"].text().value_or("");
    if (uri.empty()) return bad_gltf("has neither bytes nor a file");
    if (!is_data_uri(uri)) {
        auto path = path_of_uri(uri);
        if (!path)
            return Error{path.error().code, {}, "its file \"" + uri.substr(0, 80) + "\" is not one in its folder"};
        image.file = std::move(*path);
        return {};
    }
    if (!reads) return {};
    auto bytes = decode_data_uri(uri);
    if (!bytes) return bytes.error();
    image.bytes = std::move(*bytes);
    return {};
}

std::string name_of_image(JsonValue description, const ModelImage& image, std::size_t number) {
    const std::string name = description["name"].text().value_or("");
    if (!name.empty()) return name;
    if (!image.file.empty()) return image.file.substr(image.file.rfind('/') + 1);
    return "image " + std::to_string(number);
}

// For each image, the first one with the same bytes: exporters describe an image once for each of its uses. What their
// files or buffer views have twice is not compared.
std::vector<std::size_t> first_of_same(JsonValue images) {
    std::map<std::string, std::size_t> first;
    std::vector<std::size_t> same;
    for (std::size_t k = 0; k < images.size(); ++k) {
        const auto view = images[k]["bufferView"].count();
        const auto uri = images[k]["uri"].text();
        std::string key = view ? "view " + std::to_string(*view) : "none " + std::to_string(k);
        if (!view && uri && is_data_uri(*uri)) key = *uri;
        if (!view && uri && !is_data_uri(*uri)) {
            const auto path = path_of_uri(*uri);
            key = "file " + (path ? *path : *uri);
        }
        same.push_back(first.emplace(std::move(key), k).first->second);
    }
    return same;
}

}  // namespace

Result<std::vector<ModelMap>> gltf_maps(JsonValue root) {
    std::vector<ModelMap> maps;
    const JsonValue materials = root["materials"];
    for (std::size_t m = 0; m < materials.size(); ++m) {
        const auto slots = slots_of(materials[m]);
        if (!slots) return bad_gltf("material " + std::to_string(m) + ": " + slots.error().reason);
        const std::size_t first = maps.size();
        for (const GltfSlot& slot : *slots) {
            const auto kind = normal_slot(slot);
            if (!kind) continue;
            ModelMap map;
            map.material = static_cast<int>(m);
            map.slot = *kind;
            map.image = image_of_texture(root, slot.texture);
            map.uv_set = slot.uv_set;
            map.uv_transform = slot.transform;
            map.scale = slot.scale;
            map.is_double_sided = materials[m]["doubleSided"].boolean().value_or(false);
            maps.push_back(map);
        }
        std::stable_sort(maps.begin() + static_cast<std::ptrdiff_t>(first), maps.end(),
                         [](const ModelMap& a, const ModelMap& b) { return a.slot < b.slot; });
    }
    return maps;
}

std::vector<ModelTexture> gltf_textures(JsonValue root) {
    std::vector<ModelTexture> textures;
    const JsonValue materials = root["materials"];
    for (std::size_t m = 0; m < materials.size(); ++m) {
        const auto slots = slots_of(materials[m]);
        if (!slots) continue;
        for (const GltfSlot& slot : *slots) {
            textures.push_back({static_cast<int>(m), slot.name, slot.extension, image_of_texture(root, slot.texture),
                                slot.uv_set, slot.transform});
        }
    }
    return textures;
}

std::vector<ModelImage> gltf_images(JsonValue root, GltfBuffers& buffers, const std::vector<ModelMap>& maps,
                                    bool reads_all) {
    const JsonValue list = root["images"], materials = root["materials"];
    std::vector<ModelImage> images(list.size());
    for (std::size_t k = 0; k < images.size(); ++k) {
        const auto uses = [&](const ModelMap& map) { return map.image == static_cast<int>(k); };
        const bool reads = reads_all || std::any_of(maps.begin(), maps.end(), uses);
        if (const auto located = locate(list[k], buffers, reads, images[k]); !located)
            images[k].error = located.error();
        images[k].name = name_of_image(list[k], images[k], k);
        images[k].mime_type = list[k]["mimeType"].text().value_or("");
    }
    const std::vector<std::size_t> same = first_of_same(list);
    for (std::size_t m = 0; m < materials.size(); ++m) {
        const auto slots = slots_of(materials[m]);
        if (!slots) continue;
        for (const GltfSlot& slot : *slots) {
            const int image = image_of_texture(root, slot.texture);
            if (image < 0) continue;
            ModelImage& first = images[same[static_cast<std::size_t>(image)]];
            first.uses.push_back({static_cast<int>(m), slot.name, slot.is_color});
        }
    }
    for (std::size_t k = 0; k < images.size(); ++k) {
        if (same[k] != k) images[k].uses = images[same[k]].uses;
    }
    return images;
}

}  // namespace tex::inline v1
