// SPDX-License-Identifier: Apache-2.0
// plan.h: decides which input becomes which output.

#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tex/file.h>

#include "options/files.h"
#include "options/output.h"
#include "tasks/task.h"
#include "tasks/udim.h"

namespace tex::cli {

// What becomes of models that get maps.
struct ModelLods {
    std::optional<TangentSource> tangents = {};  // as --tangents
    bool occlusion = false;                      // they get it, too
};

// What becomes of models with the same maps on other tangents.
struct ModelConversion {
    TangentSource tangents = TangentSource::file;  // file: parts keep theirs
    bool changes_maps = false;
};

// What a command specifies about its outputs.
struct OutputRules {
    std::optional<Container> batch = {};  // with --out-dir: "{stem}" and its extension; none: the input's extension
    Container standard_output = Container::dds;  // for "-o -"
    bool joins = false;                          // -o takes many inputs and makes one output from them
    std::vector<std::string> shared = {};        // Task::shared
    std::function<void(Task& task)> amend = {};  // adds the files that options name for this task; may be empty
    Encoding (*encoding)(Container container) = &default_encoding;  // without --format
    std::function<void(std::vector<Task>& tasks)> relate = {};      // called with all tasks of a command; may be empty
    std::optional<std::string> models = {};  // inputs may be models: the material whose maps are meant, or "" for all
    bool writes_models = false;              // such inputs can become models again: outputs that are called so
    bool keeps_maps = false;                 // of such models, some maps may stay as they are
    // Such outputs get maps for each of their materials. None: other pictures alone.
    std::optional<ModelLods> lods = {};
    // Such outputs get the tangents that this says, and their maps are converted or stay as they are.
    std::optional<ModelConversion> conversion = {};
    std::vector<std::string> not_for_models = {};  // options without a meaning for such outputs
    // Inputs are meshes, and each of their materials gets an output: this returns them as inputs. May be empty.
    std::function<std::vector<Input>(const Input& input)> materials = {};
    // Inputs are meshes, and outputs with <UDIM> in their names are made for each of the tiles that this returns. None:
    // the mesh has none, or cannot be read, of which its job complains. Empty: the inputs' names say the tiles.
    std::function<std::vector<int>(const std::string& input)> tiles = {};
    bool in_place = false;  // -o may name the input itself
};

// Completes a task that has its input and its output, which may contain kLevelMark; it may have a tile and places.
// Throws UsageError if the output's name does not show its file type, or if that cannot hold the format.
[[nodiscard]] Task complete(Task task, const OutputOptions& output, const OutputRules& rules);

// Pairs every input with its output. Throws UsageError if two inputs have the same output, if an output is an input
// (links are followed), or if a name does not show its file type. <UDIM> in the name of -o becomes the input's tile, or
// each tile of a mesh. Creates nothing.
[[nodiscard]] std::vector<Task> plan_outputs(std::vector<Input> inputs, const FileOptions& files,
                                             const OutputOptions& output, const OutputRules& rules);

// Creates --out-dir (but not its parents) and, below it or without it, the folders that {dir} requires.
[[nodiscard]] Result<void> create_folders(const FileOptions& files, const std::vector<Task>& tasks);

}  // namespace tex::cli
