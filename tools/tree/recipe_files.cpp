// SPDX-License-Identifier: Apache-2.0
// The files that the options of a recipe name.

#include <algorithm>
#include <string>
#include <vector>

#include "tasks/other_parts.h"
#include "tree/recipe.h"

namespace tex::cli {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

void add_new(const std::string& name, std::vector<std::string>& names) {
    if (!contains(names, name)) names.push_back(name);
}

}  // namespace

std::vector<std::string> Recipe::files_of(const std::string& input) const {
    std::vector<std::string> files;
    const auto add = [&](const Converter& converter, bool is_first, const std::string& out) {
        const Task task = is_first ? first_task(converter, input, out) : converter.task_for(kBetween, out, input);
        for (const std::string& file : task.prerequisites()) add_new(below_root(file), files);
    };
    for (std::size_t k = 0; k < before_.size(); ++k) add(*before_[k].converter, k == 0, kBetween);
    for (const RecipeOutput& output : outputs_) add(*output.last.converter, before_.empty(), output.out);
    return files;
}

// What an input has and another has not is its own.
void Recipe::find_files() {
    const std::vector<std::string> others = files_of("other/name");
    for (const std::string& file : files_of("input")) {
        if (contains(others, file)) files_.push_back(file);
    }
}

std::vector<std::string> Recipe::own_files(const std::string& input, const std::string& path) const {
    std::vector<std::string> files = other_parts(input, path);
    for (const std::string& name : files_of(path)) {
        if (!contains(files_, name)) add_new(name, files);
    }
    return files;
}

}  // namespace tex::cli
