// SPDX-License-Identifier: Apache-2.0
// task.h: one output of a command, and the files that it is made from.

#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tex/file.h>

#include "tasks/grid.h"
#include "tasks/model_input.h"

namespace tex::cli {

struct Engine;
struct ModelOutput;

// Where the files of options that write go, such as that of --height-out, if not the command line decides about names.
struct FurtherPlaces {
    std::string input;  // after which patterns name them
    // The path for the name that an option's pattern gives; both contain kLevelMark if each level has its own file.
    // Throws UsageError.
    std::function<std::string(const std::string& option, const std::string& name)> path_for;
};

// The names of outputs contain kLevelMark (name_pattern.h) if each level has its own file.
struct Task {
    std::string input;
    std::string output;  // empty if the command writes no output for each input
    Container container = Container::dds;
    std::vector<std::string> joined = {};               // the inputs after the first one that go into the same output
    std::vector<std::string> shared = {};               // files that options name and every output depends on
    std::vector<std::string> own = {};                  // files that options name and only this output depends on
    std::string origin = {};                            // of a later step: the input of the first one; else empty
    std::vector<std::string> more_outputs = {};         // outputs besides the first one
    std::shared_ptr<const FurtherPlaces> further = {};  // null: FileOptions::place() decides
    const Engine* engine = nullptr;                     // what the output is for, if --for says it
    int tile = 0;                                       // the UDIM tile (udim.h), or 0
    bool in_folder = false;                             // the input was found in a folder of the command line
    std::string pattern = {};                           // the input's name with the mark, if that says the tile
    std::optional<TilePosition> place = {};             // of the input, if it is a tile of a terrain (grid.h)
    // The tiles around it, row by row, with an empty name for its own and for those that do not exist.
    std::vector<std::string> around = {};
    std::shared_ptr<const ModelInput> model = {};  // the input is this map of a model, and not the file itself
    std::vector<std::shared_ptr<const ModelInput>> joined_models = {};  // the same for each of `joined`
    // Input and output are models (model_output.h); `container` is that of the pictures that change, and more_outputs
    // are files beside the output.
    std::shared_ptr<const ModelOutput> model_output = {};

    // The input after which patterns name files.
    [[nodiscard]] const std::string& named() const { return origin.empty() ? input : origin; }
    // The input as messages call it.
    [[nodiscard]] std::string name() const {
        if (model) return model->name();
        return is_tile_of_mesh() ? input + " (tile " + std::to_string(tile) + ")" : input;
    }
    // The input is a mesh, and the output is for its triangles in one tile.
    [[nodiscard]] bool is_tile_of_mesh() const { return tile != 0 && pattern.empty(); }
    // The file of the normal map.
    [[nodiscard]] const std::string& map_path() const { return model && model->map ? model->path : input; }

    // The inputs, without the files that options name.
    [[nodiscard]] std::vector<std::string> inputs() const {
        std::vector<std::string> all = {input};
        all.insert(all.end(), joined.begin(), joined.end());
        return all;
    }
    // Every file that is read, except the first input.
    [[nodiscard]] std::vector<std::string> prerequisites() const {
        std::vector<std::string> all = joined;
        all.insert(all.end(), shared.begin(), shared.end());
        all.insert(all.end(), own.begin(), own.end());
        return all;
    }
    [[nodiscard]] std::vector<std::string> outputs() const {
        std::vector<std::string> all = {output};
        all.insert(all.end(), more_outputs.begin(), more_outputs.end());
        return all;
    }
};

}  // namespace tex::cli
