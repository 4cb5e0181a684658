// SPDX-License-Identifier: Apache-2.0
// model_output.h: models that are written with other pictures in the slots of their normal maps.

#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tex/format.h>
#include <tex/mesh.h>
#include <tex/pipeline.h>

#include "tasks/job.h"
#include "tasks/model_input.h"
#include "tasks/task.h"

namespace tex::cli {

// Whether a name of an output, or a pattern of such names, is that of a model.
[[nodiscard]] bool names_model(const std::string& name);

// Whether pictures of models may have this encoding: x, y and z in R, G and B, of 8 or 16 bits, or UASTC.
[[nodiscard]] bool is_for_models(Encoding encoding);

// Where the occlusion of a material goes.
struct ModelOcclusion {
    PictureUse use = PictureUse::occlusion;
    int image = -1;  // PictureUse::orm: into the red of this image
};

// What is done to a model.
struct ModelOutput {
    // The maps that change, in groups that show the same image.
    std::vector<std::vector<std::shared_ptr<const ModelInput>>> images;
    bool is_lod = false;                         // materials get maps that are made for them, and parts tangents
    bool keeps_maps = false;                     // parts get tangents alone
    bool adds_material = false;                  // as ModelChanges
    std::vector<ModelOcclusion> occlusion = {};  // of the maps of `images`, or empty
    std::vector<ModelTangents> tangents = {};    // the parts that get tangents, without these
    std::optional<Error> error = {};             // why nothing can be written

    // A picture for each group, without its bytes, and then one for each of `occlusion`.
    [[nodiscard]] ModelChanges changes(Container container) const;
};

// The maps of a model, all or those of the material `material` if it is not empty. Errors: those of read_model();
// unsupported (no such map); bad_data (a texture without an image).
[[nodiscard]] Result<ModelOutput> maps_to_write(const std::string& input, const std::string& material,
                                                const MeshReadOptions& options);

// Sets the model of a task whose input and output are models, and the files beside them: those that the task reads, and
// those that it writes, which it returns. If the task may leave maps as they are (`may_keep`), that includes copies of
// their files. `material` is that of maps_to_write(). What is wrong with the model becomes its error.
std::vector<ModelFile> set_model_output(Task& task, const std::string& material, bool may_keep,
                                        const MeshReadOptions& options);
// Does so for a model whose materials get maps that are made for it, as materials_of_model() lists them.
// `tangents` are those of --tangents.
std::vector<ModelFile> set_lod_output(Task& task, const std::string& material, std::optional<TangentSource> tangents,
                                      bool occlusion, const MeshReadOptions& options);

// Does so for a model whose parts get other tangents, unless these are `file`, and whose maps are converted to them if
// `changes_maps` is set.
std::vector<ModelFile> set_converted_output(Task& task, const std::string& material, TangentSource tangents,
                                            bool changes_maps, const MeshReadOptions& options);

// The tangents that these maps are made for, of the parts that need others than their own. `tangents` are those of
// --tangents. Warns if the maps of a part need different ones.
[[nodiscard]] Result<std::vector<ModelTangents>> tangents_for(Job& job, const ModelChanges& changes,
                                                              std::optional<TangentSource> tangents);

// Makes the pictures of the model of a job, up to 0.95 of the job: `make` is called with a job for the map of each.
// What it returns is whether there is a picture; if not, that is left out. Pictures after those of the maps are left to
// it.
[[nodiscard]] Result<void> make_pictures(Job& job, ModelChanges& changes,
                                         const std::function<Result<bool>(Job& one, ModelPicture& picture)>& make);

// Writes the model of a job with these changes, and warns of what it lacks.
[[nodiscard]] Result<void> write_model_output(Job& job, const ModelChanges& changes);

}  // namespace tex::cli
