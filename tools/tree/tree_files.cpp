// SPDX-License-Identifier: Apache-2.0

#include "tree/tree_files.h"

#include <filesystem>
#include <unordered_set>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/text_file.h"
#include "cli/usage_error.h"
#include "files/path_names.h"
#include "tree/state.h"

namespace tex::cli {
namespace {

std::string normal_name(const std::string& file) { return slashed(std::filesystem::path(file).lexically_normal()); }

}  // namespace

std::vector<std::string> files_of(const BuildTask& task, const Recipe& recipe) {
    std::vector<std::string> files;
    for (std::size_t k = 0; k < task.outputs.size() && task.refusal.empty(); ++k) {
        for (std::string& file : recipe.files_of(task.input, k).all()) files.push_back(std::move(file));
    }
    return files;
}

TreeFiles::TreeFiles(const std::vector<Recipe>& recipes, const std::vector<BuildTask>& tasks, const std::string& root,
                     const RunDocuments& documents) {
    for (const auto& [what, path] : documents.read) read_.add(path, what);
    add_inputs(recipes, tasks, root);
    add_outputs(recipes, tasks, root);
    add_documents(documents);
}

void TreeFiles::add_inputs(const std::vector<Recipe>& recipes, const std::vector<BuildTask>& tasks,
                           const std::string& root) {
    std::unordered_set<std::string> made;
    for (const BuildTask& task : tasks) {
        const std::string path = path_from(root, task.input);
        read_.add(path, "the input " + printable(task.input));
        for (const std::string& part : recipes[task.recipe].own_files(task.input, path))
            read_.add(path_from(root, part),
                      fmt::format("{}, which belongs to {}", printable(part), printable(task.input)));
        for (const std::string& file : files_of(task, recipes[task.recipe])) made.insert(file);
    }
    for (const Recipe& recipe : recipes) {
        for (const std::string& file : recipe.files()) {
            if (made.contains(normal_name(file))) continue;
            read_.add(path_from(root, file), fmt::format("{}, which rule {} reads", printable(file), recipe.number()));
        }
    }
}

void TreeFiles::add_outputs(const std::vector<Recipe>& recipes, const std::vector<BuildTask>& tasks,
                            const std::string& root) {
    for (const BuildTask& task : tasks) {
        if (!task.refusal.empty()) continue;
        for (const std::string& file : files_of(task, recipes[task.recipe])) {
            const std::string path = path_from(root, file);
            if (const std::string* const known = read_.find(path)) {
                recipes[task.recipe].fail(
                    fmt::format("the output {} of {} is {}", printable(file), printable(task.input), *known));
            }
            written_.add_place(path, "an output of " + printable(task.input));
        }
    }
}

void TreeFiles::add_documents(const RunDocuments& documents) {
    for (const auto& [option, path] : documents.written) {
        if (path.empty() || is_special_file(path)) continue;
        const std::string* known = read_.find(path);
        if (known == nullptr) known = written_.find(path);
        if (known != nullptr) throw UsageError(fmt::format("{}: {} is {}", option, printable(path), *known));
        written_.add(path, "the file of " + option);
    }
}

Result<void> TreeFiles::may_replace(const std::string& path) const {
    const std::string* const known = read_.find(path);
    if (known == nullptr) return {};
    return Error{ErrorCode::io, path, fmt::format("is now {}; nothing is replaced", *known)};
}

}  // namespace tex::cli
