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

std::vector<std::string> fields_of(const Model& model) {
    Counts counts;
    std::vector<std::string> fields;
    for (const ModelMap& map : model.maps) {
        fields.push_back(field_of(model, map));
        ++counts[fields.back()];
    }
    std::vector<std::string> unique = fields;
    for (std::size_t k = 0; k < fields.size(); ++k) {
        if (counts[fields[k]] == 1) continue;
        do unique[k] += "_" + std::to_string(model.maps[k].material);
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
    const std::vector<std::string> fields = fields_of(*model), buffers = buffers_of(file, options);
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

}  // namespace

Result<std::shared_ptr<const Model>> LastModel::read(const std::string& path, Part part,
                                                     const MeshReadOptions& options) {
    const std::lock_guard lock(mutex_);
    if (model_ && path_ == path && (part_ == part || part_ == Part::all)) return model_;
    model_.reset();
    auto model = part == Part::all ? read_model(path, options) : read_model_maps(path, options);
    if (!model) return model.error();
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
    if (model && std::none_of((*model)->maps.begin(), (*model)->maps.end(), is_same))
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
