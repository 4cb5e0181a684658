// SPDX-License-Identifier: Apache-2.0
// model_output.h: models that are written with other pictures in the slots of their normal maps.

#pragma once

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

// What is done to a model.
struct ModelOutput {
    // The maps that change, in groups that show the same image.
    std::vector<std::vector<std::shared_ptr<const ModelInput>>> images;
    bool is_lod = false;                       // materials get maps that are made for them, and parts tangents
    std::vector<ModelTangents> tangents = {};  // the parts that get tangents, without these
    std::optional<Error> error = {};           // why nothing can be written

    // A picture for each group, without its bytes.
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
                                      const MeshReadOptions& options);

// The tangents that these maps of an LOD are made for, of the parts that need others than their own. `tangents` are
// those of --tangents.
[[nodiscard]] Result<std::vector<ModelTangents>> tangents_for(const Job& job, const ModelChanges& changes,
                                                              std::optional<TangentSource> tangents);

// Writes the model of a job with these changes, and warns of what it lacks.
[[nodiscard]] Result<void> write_model_output(Job& job, const ModelChanges& changes);

}  // namespace tex::cli
