// SPDX-License-Identifier: Apache-2.0
// gltf_names.h: the files beside a model that is written: which ones, and what they are called.

#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <tex/types.h>

#include "mesh/json.h"

namespace tex::inline v1 {

// Where the output is, as seen from the input.
struct ModelPlace {
    bool is_same_folder = false;
    std::string name;        // of the output, without its folder
    bool is_binary = false;  // the output is GLB
    // Whether there is no file at a relative path from the input. Empty: what cannot be loaded is not there.
    std::function<bool(const std::string& path)> is_missing = {};
};

// The URI of a relative path.
std::string uri_of_path(std::string_view path);

class GltfNames {
public:
    // Finds every file that the document names, in whatever member "uri".
    GltfNames(JsonValue root, ModelPlace place);

    // One place of the document no longer names this file.
    void forget(const std::string& path);
    // A name for what takes the place of the file `path`, with another extension (".png"). To be called after all
    // forget().
    std::string name_for(const std::string& path, std::string_view extension);

    // The files that are still named.
    [[nodiscard]] std::vector<std::string> kept() const;
    // URIs that name no file in the folder of the model.
    [[nodiscard]] const std::vector<std::string>& outside() const { return outside_; }

    // Whether a name has an extension that models use: what a stranger's model names is written beside the output.
    static bool is_usual(std::string_view path);

private:
    ModelPlace place_;
    std::map<std::string, int> named_;  // how often
    std::set<std::string> given_;       // by name_for()
    std::vector<std::string> outside_;
};

}  // namespace tex::inline v1
