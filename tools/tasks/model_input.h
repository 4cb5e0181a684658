// SPDX-License-Identifier: Apache-2.0
// model_input.h: the normal maps of glTF models as inputs: each map that a material uses becomes a task of its own.

#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <tex/mesh.h>

#include "cli/json.h"
#include "tasks/udim.h"

namespace tex::cli {

// The model that was read last. Jobs share it, and the maps of a model follow each other, so that memory holds one
// model, or, for a while, one for each thread.
class LastModel {
public:
    enum class Part { maps, all };  // `maps`: without geometry

    LastModel() = default;
    // `adds_material`: if no triangle has a material, those with UVs and normals have another one, after those of the
    // model (ModelChanges::adds_material). Such a model is read with its geometry.
    explicit LastModel(bool adds_material) : adds_material_(adds_material) {}

    // Any thread may call this. Errors: those of read_model().
    [[nodiscard]] Result<std::shared_ptr<const Model>> read(const std::string& path, Part part,
                                                            const MeshReadOptions& options);
    // Whether the model that was read has got another material.
    [[nodiscard]] bool has_added() const { return has_added_; }

private:
    const bool adds_material_ = false;
    bool has_added_ = false;
    std::mutex mutex_;
    std::string path_;
    Part part_ = Part::maps;
    std::shared_ptr<const Model> model_;
};

// A normal map in a model, or why there is none.
struct ModelInput {
    std::string file;           // the model
    std::string material = {};  // as --material takes it: its name, or its number if it has none of its own
    std::string field = {};     // {material} in names of outputs: no two maps of a model have the same
    std::string image = {};     // as the model calls it, or the path of its file
    std::string path = {};      // of its file; name(), if it is inside of the model
    std::optional<ModelMap> map = {};
    bool is_added = false;                 // the material is not in the model (ModelChanges::adds_material)
    std::optional<Error> error = {};       // the model cannot be read
    std::vector<std::string> beside = {};  // other files that the map depends on
    std::shared_ptr<LastModel> last = {};

    // What messages call the map: "helmet.glb: Leather".
    [[nodiscard]] std::string name() const { return map ? file + ": " + field : file; }
    // Reads the model. Precondition: there is a map. Errors: those of read_model().
    [[nodiscard]] Result<std::shared_ptr<const Model>> read(LastModel::Part part, const ReadOptions& options) const;
    // Makes `options` read the image of the map as the file `path`. Precondition and errors: as read(); why the model
    // has no bytes for it.
    [[nodiscard]] Result<void> open(ReadOptions& options) const;
    // The triangles that a new map of the material is made for, where the scene places them.
    [[nodiscard]] MeshSelection selection(const Model& model) const;
    // Such triangles whose tangents are made, and are not those of the file.
    [[nodiscard]] std::vector<const MeshPart*> parts_without(const Model& model,
                                                             std::optional<TangentSource> tangents) const;
    // What --json says about the map.
    void report(Json& report) const;
};

// The files that a model names: its buffers and images. None if the file is no model, or cannot be read as one.
[[nodiscard]] std::vector<std::string> files_beside_model(const std::string& file, const MeshReadOptions& options);

// The materials of a model that are on triangles with UVs and normals, all or the one that is named, each with the
// normal map that it has or could get: without one, ModelMap::image is -1. If no triangle has a material, the only one
// is that which ModelChanges::adds_material adds. The transform is that of a new map. If there
// is none, the only element says why.
[[nodiscard]] std::vector<std::shared_ptr<const ModelInput>> materials_of_model(const std::string& file,
                                                                                const std::string& material,
                                                                                const MeshReadOptions& options);

// The inputs, with each model replaced by its maps: all, or those of the material `material` if it is not empty. A
// model without maps, or one that cannot be read, remains one input. Warnings and errors come from its job.
[[nodiscard]] std::vector<Input> with_maps_of_models(std::vector<Input> inputs, const std::string& material,
                                                     const MeshReadOptions& options);

}  // namespace tex::cli
