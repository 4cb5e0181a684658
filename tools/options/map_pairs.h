// SPDX-License-Identifier: Apache-2.0
// map_pairs.h: the pairs of maps that compare-normals compares: two files, or the maps of models by their materials.

#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <tex/file.h>
#include <tex/types.h>

#include "tasks/model_input.h"

namespace tex::cli {

// A map that is a file, or in a model.
struct ComparedMap {
    std::string file;
    std::shared_ptr<const ModelInput> model = {};

    // What messages call it, and what `options` read after open() has added the model to them.
    [[nodiscard]] const std::string& path() const { return model ? model->path : file; }
    [[nodiscard]] std::string name() const { return model ? model->name() : file; }
    // Errors: those of ModelInput::open().
    [[nodiscard]] Result<ReadOptions> open(ReadOptions options) const;
};

struct MapPair {
    ComparedMap maps[2];
    std::string material = {};  // as --material takes it, of A or, if that is no model, of B; empty: neither is one

    [[nodiscard]] std::vector<std::string> names() const { return {maps[0].name(), maps[1].name()}; }
};

// The pairs of the files `names`, which are two. Of models, maps of materials with the same name are a pair, and so are
// the only maps of both; `material` names one, or is empty. `warn` gets a file and a sentence for each map without a
// partner. Errors: a model cannot be read, or has no map; one of several maps must be named; bad_option (no two maps
// are a pair).
[[nodiscard]] Result<std::vector<MapPair>> map_pairs(
    const std::vector<std::string>& names, const std::string& material, const ReadOptions& read,
    const std::function<void(const std::string& file, const std::string& sentence)>& warn);

}  // namespace tex::cli
