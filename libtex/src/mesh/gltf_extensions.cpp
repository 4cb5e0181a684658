// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_extensions.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "mesh/gltf_buffers.h"

namespace tex::inline v1 {
namespace {

// Extensions that libtex reads, or that change neither triangles nor their attributes nor where textures lie.
bool is_known(std::string_view name) {
    for (const std::string_view known : {"KHR_draco_mesh_compression",
                                         "EXT_meshopt_compression",
                                         "KHR_meshopt_compression",
                                         "KHR_mesh_quantization",
                                         "KHR_texture_transform",
                                         "EXT_mesh_gpu_instancing",
                                         "KHR_texture_basisu",
                                         "EXT_texture_webp",
                                         "EXT_texture_avif",
                                         "MSFT_texture_dds",
                                         "KHR_lights_punctual",
                                         "KHR_animation_pointer",
                                         "KHR_xmp",
                                         "KHR_xmp_json_ld",
                                         "KHR_interactivity",
                                         "EXT_mesh_features",
                                         "EXT_mesh_manifold",
                                         "EXT_structural_metadata",
                                         "EXT_instance_features",
                                         "CESIUM_primitive_outline",
                                         "CESIUM_RTC",
                                         "FB_ngon_encoding",
                                         "MSFT_lod",
                                         "VRM"}) {
        if (name == known) return true;
    }
    for (const std::string_view harmless : {"KHR_materials_", "KHR_node_", "KHR_audio", "KHR_physics_", "EXT_lights_",
                                            "ADOBE_materials_", "OMI_", "VRMC_"}) {
        if (name.starts_with(harmless)) return true;
    }
    return false;
}

class Search {
public:
    std::vector<std::string> names;

    void add_extensions_of(JsonValue object) {
        for (std::string& name : object["extensions"].keys()) {
            if (is_known(name) || std::find(names.begin(), names.end(), name) != names.end()) continue;
            names.push_back(std::move(name));
        }
    }
    void add_all(JsonValue list) {
        for (std::size_t k = 0; k < list.size(); ++k) add_extensions_of(list[k]);
    }
    // Places of textures are the members called ...Texture of a material, and of its extensions. The depth of JSON is
    // limited (json.h).
    void add_textures_of(JsonValue object) {
        for (const std::string& key : object.keys()) {
            if (key.ends_with("Texture")) add_extensions_of(object[key]);
            add_textures_of(object[key]);
        }
    }
};

}  // namespace

Result<void> check_required_extensions(JsonValue root) {
    const JsonValue required = root["extensionsRequired"];
    if (!required.is_null() && !required.is_array()) return bad_gltf("its extensionsRequired is no list");
    for (std::size_t k = 0; k < required.size(); ++k) {
        const std::optional<std::string> name = required[k].text();
        if (!name) return bad_gltf("its extensionsRequired holds what is no name");
        if (!is_known(*name))
            return Error{ErrorCode::unsupported, {}, "requires the extension " + *name + ", which is not supported"};
    }
    return {};
}

std::vector<std::string> ignored_extensions(JsonValue root) {
    Search search;
    const JsonValue meshes = root["meshes"], materials = root["materials"];
    for (std::size_t k = 0; k < meshes.size(); ++k) search.add_all(meshes[k]["primitives"]);
    search.add_all(root["accessors"]);
    search.add_all(root["bufferViews"]);
    for (std::size_t k = 0; k < materials.size(); ++k) search.add_textures_of(materials[k]);
    std::vector<std::string> sentences;
    for (const std::string& name : search.names)
        sentences.push_back("uses the extension " + name.substr(0, 80) +
                            ", which libtex does not know: UVs, normals or tangents may be others in an engine");
    return sentences;
}

}  // namespace tex::inline v1
