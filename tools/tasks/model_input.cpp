// SPDX-License-Identifier: Apache-2.0

#include "tasks/model_input.h"

#include <algorithm>
#include <map>
#include <utility>

#include <tex/mesh.h>

namespace tex::cli {
namespace {

// A material's name as a part of a file's name: without separators, and not hidden.
std::string field_of(const Model& model, const ModelMap& map) {
    std::string text = model.mesh.materials[static_cast<std::size_t>(map.material)].name;
    for (char& c : text) {
        const bool is_special = std::string_view("/\\:*?\"<>|").find(c) != std::string_view::npos;
        if (is_special || static_cast<unsigned char>(c) < ' ') c = '_';
    }
    if (text.starts_with('.')) text.front() = '_';
    if (text.empty()) text = std::to_string(map.material);
    return text + (map.slot == NormalSlot::clearcoat_normal ? "_clearcoat" : "");
}

// Files may have many thousand materials, so that names are counted once.
using Counts = std::map<std::string, int>;

std::vector<std::string> fields_of(const Model& model, const std::vector<ModelMap>& maps) {
    Counts counts;
    std::vector<std::string> fields;
    for (const ModelMap& map : maps) {
        fields.push_back(field_of(model, map));
        ++counts[fields.back()];
    }
    std::vector<std::string> unique = fields;
    for (std::size_t k = 0; k < fields.size(); ++k) {
        if (counts[fields[k]] == 1) continue;
        do unique[k] += "_" + std::to_string(maps[k].material);
        while (counts.contains(unique[k]));
        counts[unique[k]] = 1;
    }
    return unique;
}

Counts names_of_materials(const Model& model) {
    Counts counts;
    for (const MeshMaterial& material : model.mesh.materials) ++counts[material.name];
    return counts;
}

// The map's material, as maps_of() finds it.
std::string material_of(const Model& model, const ModelMap& map, const Counts& names) {
    const std::string& name = model.mesh.materials[static_cast<std::size_t>(map.material)].name;
    return name.empty() || names.at(name) > 1 ? selection_of(model, map).material : name;
}

// The files of the geometry, apart from the model.
std::vector<std::string> buffers_of(const std::string& file, const MeshReadOptions& options) {
    const auto files = mesh_files(file, options);
    return files ? std::vector<std::string>(files->begin() + 1, files->end()) : std::vector<std::string>();
}

const ModelImage* image_of(const Model& model, const ModelMap& map) {
    return map.image < 0 ? nullptr : &model.images[static_cast<std::size_t>(map.image)];
}

// The number of the material with this name or number; nothing for all of them.
Result<std::optional<int>> number_of_material(const Model& model, const std::string& material) {
    if (material.empty()) return std::optional<int>();
    Model numbered;
    numbered.file = model.file;
    numbered.mesh.materials = model.mesh.materials;
    for (std::size_t m = 0; m < numbered.mesh.materials.size(); ++m)
        numbered.maps.emplace_back().material = static_cast<int>(m);
    const auto maps = maps_of(numbered, material);
    if (!maps) return maps.error();
    return std::optional<int>(maps->front().material);
}

std::vector<std::shared_ptr<const ModelInput>> maps_in(const std::string& file, const std::string& material,
                                                       const MeshReadOptions& options,
                                                       const std::shared_ptr<LastModel>& last) {
    const auto one = [](ModelInput input) {
        return std::vector<std::shared_ptr<const ModelInput>>{std::make_shared<const ModelInput>(std::move(input))};
    };
    const auto model = read_model_maps(file, options);
    if (!model) return one({.file = file, .error = model.error()});
    const auto chosen = maps_of(*model, material);
    if (!chosen) return one({.file = file, .error = chosen.error()});
    if (chosen->empty()) return one({.file = file});
    const std::vector<std::string> fields = fields_of(*model, model->maps), buffers = buffers_of(file, options);
    const Counts names = names_of_materials(*model);
    std::vector<std::shared_ptr<const ModelInput>> maps;
    for (std::size_t k = 0; k < fields.size(); ++k) {
        const ModelMap& map = model->maps[k];
        if (map.material != chosen->front().material && !material.empty()) continue;
        const ModelImage* const image = image_of(*model, map);
        ModelInput input{.file = file, .material = material_of(*model, map, names), .field = fields[k]};
        input.map = map;
        if (image != nullptr) input.image = image->file.empty() ? image->name : image->file;
        input.path = image != nullptr && !image->file.empty() ? image->file : input.name();
        input.beside = buffers;
        if (image != nullptr && !image->file.empty()) input.beside.push_back(image->file);
        input.last = last;
        maps.push_back(std::make_shared<const ModelInput>(std::move(input)));
    }
    return maps;
}

// The material that ModelChanges::adds_material adds, if no triangle has one. Returns whether it does.
bool add_material(Mesh& mesh) {
    const auto has_material = [](const MeshPart& part) { return part.material >= 0; };
    if (std::any_of(mesh.parts.begin(), mesh.parts.end(), has_material)) return false;
    for (MeshPart& part : mesh.parts) {
        if (!part.uvs.empty() && !part.normals.empty()) part.material = static_cast<int>(mesh.materials.size());
    }
    mesh.materials.emplace_back();
    return true;
}

}  // namespace

Result<std::shared_ptr<const Model>> LastModel::read(const std::string& path, Part part,
                                                     const MeshReadOptions& options) {
    const std::lock_guard lock(mutex_);
    if (model_ && path_ == path && (part_ == part || part_ == Part::all)) return model_;
    model_.reset();
    if (adds_material_) part = Part::all;
    auto model = part == Part::all ? read_model(path, options) : read_model_maps(path, options);
    if (!model) return model.error();
    has_added_ = adds_material_ && add_material(model->mesh);
    path_ = path;
    part_ = part;
    model_ = std::make_shared<const Model>(std::move(*model));
    return model_;
}

Result<std::shared_ptr<const Model>> ModelInput::read(LastModel::Part part, const ReadOptions& options) const {
    MeshReadOptions how;
    how.reader = options;
    auto model = last->read(file, part, how);
    const auto is_same = [&](const ModelMap& now) {
        return now.material == map->material && now.slot == map->slot && now.image == map->image;
    };
    if (model && map->image >= 0 && std::none_of((*model)->maps.begin(), (*model)->maps.end(), is_same))
        return Error{ErrorCode::io, file, "changed while it was read"};
    return model;
}

Result<void> ModelInput::open(ReadOptions& options) const {
    const auto model = read(LastModel::Part::maps, options);
    if (!model) return model.error();
    const ModelImage* const found = image_of(**model, *map);
    if (found == nullptr) return Error{ErrorCode::bad_data, name(), "its texture has no image"};
    if (found->error) return found->error->of(path);
    if (found->file.empty()) options.bytes = std::shared_ptr<const std::vector<std::byte>>(*model, &found->bytes);
    return {};
}

void ModelInput::report(Json& report) const {
    if (!map) return;
    report["material"] = material;
    report["material_number"] = map->material;
    report["slot"] = name_of(kNormalSlotNames, map->slot);
    report["image"] = image;
    report["uv_set"] = map->uv_set;
    report["scale"] = map->scale;
}

namespace {

// Whether the map would be on triangles of the part.
bool shows(const MeshPart& part, const ModelMap& map) {
    return part.can_have(map.material) && static_cast<std::size_t>(map.uv_set) < part.uvs.size() &&
           !part.normals.empty();
}

// A map is made for the UVs that its transform moves into the picture: quantised UVs need one. If it moves them out, so
// that the old map repeats, and the UVs as they are lie in the picture, the new one has no transform.
UvTransform placed(const Model& model, const ModelMap& map) {
    if (map.uv_transform == UvTransform{}) return {};
    const auto fit = [&](const UvTransform& transform) {
        constexpr float kSlack = 1e-3f;
        const auto is_inside = [](float x) { return x >= -kSlack && x <= 1.0f + kSlack; };
        for (const MeshPart& part : model.mesh.parts) {
            if (!shows(part, map)) continue;
            const auto moved = with_moved_uvs(part, map.uv_set, transform);
            if (!moved) return false;
            for (const Float2& uv : moved->uvs[static_cast<std::size_t>(map.uv_set)])
                if (!is_inside(uv.x) || !is_inside(uv.y)) return false;
        }
        return true;
    };
    return !fit(map.uv_transform) && fit({}) ? UvTransform{} : map.uv_transform;
}

}  // namespace

std::vector<std::shared_ptr<const ModelInput>> materials_of_model(const std::string& file, const std::string& material,
                                                                  const MeshReadOptions& options) {
    const auto one = [&](Error error) {
        return std::vector{std::make_shared<const ModelInput>(ModelInput{.file = file, .error = std::move(error)})};
    };
    const auto last = std::make_shared<LastModel>(material.empty());
    const auto model = last->read(file, LastModel::Part::all, options);
    if (!model) return one(model.error());
    const auto chosen = number_of_material(**model, material);
    if (!chosen) return one(chosen.error());
    std::vector<ModelMap> maps;
    for (std::size_t m = 0; m < (*model)->mesh.materials.size(); ++m) {
        if (*chosen && **chosen != static_cast<int>(m)) continue;
        ModelMap map;
        map.material = static_cast<int>(m);
        map.uv_set = (*model)->mesh.materials[m].uv_set;
        map.uv_transform = (*model)->mesh.materials[m].uv_transform;
        for (const ModelMap& known : (*model)->maps)
            if (known.material == map.material && known.slot == NormalSlot::normal) map = known;
        const auto& parts = (*model)->mesh.parts;
        if (std::none_of(parts.begin(), parts.end(), [&](const MeshPart& part) { return shows(part, map); })) continue;
        map.uv_transform = placed(**model, map);
        maps.push_back(map);
    }
    if (maps.empty()) {
        return one({ErrorCode::bad_option, file,
                    *chosen ? "no triangle with this material has UVs and normals"
                            : "no triangle has UVs and normals, which normal maps need"});
    }
    const std::vector<std::string> fields = fields_of(**model, maps);
    const std::vector<std::string> beside = files_beside_model(file, options);
    const Counts names = names_of_materials(**model);
    std::vector<std::shared_ptr<const ModelInput>> inputs;
    for (std::size_t k = 0; k < maps.size(); ++k) {
        ModelInput input{.file = file, .material = material_of(**model, maps[k], names), .field = fields[k]};
        input.map = maps[k];
        input.is_added = last->has_added();
        if (const ModelImage* const image = image_of(**model, maps[k]))
            input.image = image->file.empty() ? image->name : image->file;
        input.path = input.name();
        input.beside = beside;
        input.last = last;
        inputs.push_back(std::make_shared<const ModelInput>(std::move(input)));
    }
    return inputs;
}

MeshSelection ModelInput::selection(const Model& model) const {
    MeshSelection selection = selection_of(model, *map);
    selection.uv_set.reset();  // that of the material, so that tangents of the file count
    selection.in_scene = true;
    return selection;
}

std::vector<const MeshPart*> ModelInput::parts_without(const Model& model,
                                                       std::optional<TangentSource> tangents) const {
    std::vector<const MeshPart*> parts;
    bool have_all = true;
    for (const MeshPart& part : model.mesh.parts) {
        if (!shows(part, *map)) continue;
        parts.push_back(&part);
        have_all = have_all && !part.tangents.empty();
    }
    if (tangents.value_or(have_all ? TangentSource::file : TangentSource::mikktspace) == TangentSource::file) return {};
    return parts;
}

std::vector<std::string> files_beside_model(const std::string& file, const MeshReadOptions& options) {
    if (!is_model(file)) return {};
    std::vector<std::string> files = buffers_of(file, options);
    if (const auto model = read_model_maps(file, options)) {
        for (const ModelImage& image : model->images) files.push_back(image.file);
    }
    return files;
}

std::vector<Input> with_maps_of_models(std::vector<Input> inputs, const std::string& material,
                                       const MeshReadOptions& options) {
    const auto last = std::make_shared<LastModel>();
    std::vector<Input> all;
    for (Input& input : inputs) {
        if (input.tile != 0 || input.place || !is_model(input.name)) {
            all.push_back(std::move(input));
            continue;
        }
        for (auto& map : maps_in(input.name, material, options, last)) {
            Input one = input;
            one.model = std::move(map);
            all.push_back(std::move(one));
        }
    }
    return all;
}

}  // namespace tex::cli
