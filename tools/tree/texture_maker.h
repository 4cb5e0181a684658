// SPDX-License-Identifier: Apache-2.0
// texture_maker.h: makes outputs of one input by a recipe: all steps and all outputs in one reading.

#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <tex/pipeline.h>

#include "cli/json.h"
#include "options/run.h"
#include "tree/recipe.h"

namespace tex::cli {

// How a texture is made, besides its recipe.
struct MakeSettings {
    const RunOptions& running;
    WriteOptions write;
    std::function<bool(double fraction)> advance;  // returns false if the work must stop
    std::string source = {};                       // if not empty, the normals before packing go here, as EXR
    std::shared_ptr<SharedMaps> shared = {};       // as Job::shared_maps
    bool takes_any = false;                        // inputs that are not what the commands take are not refused
};

// What was made.
struct Made {
    StepsReport report;
    std::vector<std::vector<std::string>> files;  // of each output that was asked for
    std::vector<PackOptions> packs;               // the same, if they are textures
    std::vector<FileWarning> warnings, remarks;   // as in Job
    std::string text;                             // that the commands print
    Json bumpiness;                               // with which heights were baked, as bake-normals reports it
};

// One output to make: its place in the recipe, and the path of its file (with kLevelMark if each level has its own).
struct WantedOutput {
    std::size_t index;
    std::string path;
    std::string write_to = {};                        // if not empty, the bytes go here instead,
    std::map<std::string, std::string> further = {};  // and those of files of options that write to these places
};

// Makes `wanted` from the file `input`. The folders exist. Errors: those of the commands.
[[nodiscard]] Result<Made> make_texture(const Recipe& recipe, const std::string& input,
                                        const std::vector<WantedOutput>& wanted, const MakeSettings& settings,
                                        Console& console);

}  // namespace tex::cli
