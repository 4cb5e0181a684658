// SPDX-License-Identifier: Apache-2.0

#include <tex/mesh.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <system_error>
#include <utility>

#include <tex/file.h>

#include "files/beside.h"
#include "files/input_file.h"
#include "files/path_names.h"
#include "formats/file_types.h"
#include "formats/reader/reader_mesh.h"
#include "formats/texture_rows.h"
#include "mesh/gltf.h"
#include "mesh/gltf_images.h"
#include "mesh/gltf_materials.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

enum class Geometry { read, left_out };

Result<Model> parse_model(const std::string& path, std::span<const std::byte> bytes, const MeshReadOptions& options,
                          Geometry geometry) {
    const LoadBeside load = [&](const std::string& name) { return read_named(path, name, options.max_bytes); };
    const DecodeDraco draco = [&](std::span<const std::byte> request) {
        return decode_draco_with_reader(path, request, options.reader);
    };
    const auto chunks = gltf_chunks(bytes);
    if (!chunks) return chunks.error();
    const auto document = JsonDocument::parse(chunks->json);
    if (!document) return document.error();
    const JsonValue root = document->root();
    GltfBuffers buffers(root, chunks->json.size(), chunks->binary, load);
    Model model;
    model.file = path;
    if (geometry == Geometry::read) {
        auto mesh = parse_gltf(root, buffers, draco, options.colors);
        if (!mesh) return mesh.error();
        model.mesh = std::move(*mesh);
    } else {
        if (auto known = check_asset(root); !known) return known.error();
        auto materials = gltf_materials(root);
        if (!materials) return materials.error();
        model.mesh.materials = std::move(*materials);
    }
    auto maps = gltf_maps(root);
    if (!maps) return maps.error();
    model.images = gltf_images(root, buffers, *maps, options.images);
    model.textures = gltf_textures(root);
    model.maps = std::move(*maps);
    for (ModelImage& image : model.images) {
        if (image.file.empty()) continue;
        image.file = beside(path, image.file);
        if (const auto regular = check_regular(image.file); !regular)
            image.error = Error{regular.error().code, {}, regular.error().reason};
    }
    return model;
}

std::string material_text(const Model& model, int material) {
    const auto index = static_cast<std::size_t>(material);
    const bool named = index < model.mesh.materials.size() && !model.mesh.materials[index].name.empty();
    return named ? model.mesh.materials[index].name : std::to_string(material);
}

bool is_called_model(const std::string& path) {
    std::string extension = slashed(std::filesystem::path(path).extension());
    for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return extension == ".gltf" || extension == ".glb";
}

const ModelImage* image_of(const Model& model, const ModelMap& map) {
    const auto index = static_cast<std::size_t>(map.image);
    return map.image >= 0 && index < model.images.size() ? &model.images[index] : nullptr;
}

}  // namespace

bool is_model(const std::string& path) {
    std::error_code error;
    if (path == "-" || !std::filesystem::is_regular_file(path, error)) return false;
    const auto file = InputFile::open(path);
    if (!file) return false;
    const FileType& type = file_type_for(file->head());
    return is_gltf(file->head()) || (is_called_model(path) && type.magic.empty() && type.claims == nullptr);
}

namespace {

Result<Model> read_model(const std::string& path, const MeshReadOptions& options, Geometry geometry) {
    return no_throw([&]() -> Result<Model> {
        if (path == "-") return Error{ErrorCode::unsupported, path, "a model cannot come from standard input"};
        const auto bytes = read_at_most(path, options.max_bytes);
        if (!bytes) return bytes.error();
        if (!is_gltf(*bytes)) return Error{ErrorCode::unsupported, path, "is not a glTF model"};
        auto model = parse_model(path, *bytes, options, geometry);
        if (!model) return model.error().of(path);
        return model;
    });
}

}  // namespace

Result<Model> read_model(const std::string& path, const MeshReadOptions& options) {
    return read_model(path, options, Geometry::read);
}

Result<Model> read_model_maps(const std::string& path, const MeshReadOptions& options) {
    return read_model(path, options, Geometry::left_out);
}

std::string map_name(const Model& model, const ModelMap& map) {
    const ModelImage* const image = image_of(model, map);
    return material_text(model, map.material) + (map.slot == NormalSlot::clearcoat_normal ? " (clearcoat)" : "") +
           ": " + (image == nullptr ? "no image" : image->name);
}

Result<Texture> read_map(const Model& model, const ModelMap& map, const ReadOptions& options) {
    return no_throw([&]() -> Result<Texture> {
        const ModelImage* const image = image_of(model, map);
        if (image == nullptr) return Error{ErrorCode::bad_data, model.file, "its texture has no image"};
        const std::string name = model.file + ": " + image->name;
        if (image->error) return image->error->of(name);
        if (!image->file.empty()) return read_texture(image->file, options);
        auto file = InputFile::from_memory(name, image->bytes);
        if (!file) return file.error();
        return read_texture(*file, options);
    });
}

// By its number, with so many zeros before it that no material has this name.
MeshSelection selection_of(const Model& model, const ModelMap& map) {
    MeshSelection selection;
    selection.material = std::to_string(map.material);
    const auto& materials = model.mesh.materials;
    const auto is_name = [&](const MeshMaterial& material) { return material.name == selection.material; };
    while (std::any_of(materials.begin(), materials.end(), is_name)) selection.material.insert(0, 1, '0');
    const auto index = static_cast<std::size_t>(map.material);
    if (index < materials.size() && materials[index].has_normal_map && materials[index].uv_set != map.uv_set)
        selection.uv_set = map.uv_set;
    if (index < materials.size() && !materials[index].has_normal_map) selection.uv_set = map.uv_set;
    selection.uv_transform = map.uv_transform;
    return selection;
}

Result<std::vector<ModelMap>> maps_of(const Model& model, const std::string& material) {
    if (material.empty()) return model.maps;
    const auto& materials = model.mesh.materials;
    const auto named = std::find_if(materials.begin(), materials.end(),
                                    [&](const MeshMaterial& candidate) { return candidate.name == material; });
    std::size_t index = static_cast<std::size_t>(named - materials.begin());
    if (named == materials.end()) {
        const auto [end, error] = std::from_chars(material.data(), material.data() + material.size(), index);
        if (error != std::errc() || end != material.data() + material.size() || index >= materials.size())
            return Error{ErrorCode::bad_option, model.file, "has no material \"" + material + '"'};
    }
    std::vector<ModelMap> maps;
    for (const ModelMap& map : model.maps) {
        if (map.material == static_cast<int>(index)) maps.push_back(map);
    }
    return maps;
}

}  // namespace tex::inline v1
