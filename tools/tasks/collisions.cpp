// SPDX-License-Identifier: Apache-2.0

#include "tasks/collisions.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/text_file.h"
#include "cli/usage_error.h"
#include "tasks/engines.h"
#include "tasks/file_table.h"
#include "tasks/folders.h"
#include "tasks/name_pattern.h"
#include "tasks/task.h"

namespace tex::cli {
namespace {

std::vector<std::string> files_of(const Task& task) {
    std::vector<std::string> files;
    for (const std::string& output : task.outputs()) {
        std::vector<std::string> names = with_all_levels(output);
        std::move(names.begin(), names.end(), std::back_inserter(files));
    }
    return files;
}

}  // namespace

void check_collisions(const std::vector<Task>& tasks, const std::string& depfile, const std::vector<NamedFile>& lists,
                      bool in_place) {
    FileTable<std::string> inputs;
    for (const NamedFile& list : lists) inputs.add(list.path, "the file of " + list.option);
    for (const Task& task : tasks) {
        inputs.add(task.input, "the input " + printable(task.input));
        for (const std::string& input : task.prerequisites()) inputs.add(input, "the input " + printable(input));
    }
    const auto check_not_an_input = [&](const std::string& path) {
        const std::string* const input = path != "-" && is_special_file(path) ? nullptr : inputs.find(path);
        if (input == nullptr) return;
        throw UsageError(fmt::format("the output {} is {}; choose another name or folder", printable(path), *input));
    };

    FileTable<const Task*> outputs;
    for (const Task& task : tasks) {
        for (const std::string& path : files_of(task)) {
            if (!in_place || !is_same_name(path, task.input)) check_not_an_input(path);
            if (is_special_file(path)) continue;
            const Task* const* const known = outputs.add(path, &task);
            if (known == nullptr) continue;
            const Task* const other = *known;
            if (other == &task) {
                throw UsageError(
                    fmt::format("two outputs of {} are one file, {}", printable(task.name()), printable(path)));
            }
            if (other->engine == task.engine && is_same_name(other->name(), task.name()))
                throw UsageError(fmt::format("the input {} is given twice", printable(task.name())));
            if (other->engine != task.engine && other->name() == task.name()) {
                throw UsageError(
                    fmt::format("{} for {} and for {} have the same output {}; {{engine}} in --name separates "
                                "them",
                                printable(task.name()), other->engine->name, task.engine->name, printable(path)));
            }
            const bool is_one_model = task.model && other->input == task.input;
            throw UsageError(fmt::format("{} and {} have the same output {}{}", printable(other->name()),
                                         printable(task.name()), printable(path),
                                         is_one_model ? "; {material} in --name separates them" : ""));
        }
    }
    if (depfile.empty()) return;
    check_not_an_input(depfile);
    if (outputs.find(depfile) != nullptr)
        throw UsageError("--depfile", fmt::format("{} is an output", printable(depfile)));
}

void check_document(const NamedFile& document, const std::vector<std::string>& inputs,
                    const std::vector<NamedFile>& others) {
    const auto& [option, path] = document;
    if (path.empty() || path == "-") throw UsageError(fmt::format("{} needs the name of a file", option));
    if (is_folder(path)) throw UsageError(fmt::format("{} {}: is a folder", option, printable(path)));
    if (is_special_file(path)) return;
    FileTable<std::string> known;
    for (const std::string& input : inputs) known.add(input, "is the input " + printable(input));
    for (const NamedFile& other : others) known.add(other.path, "is the file of " + other.option);
    if (const std::string* const what = known.find(path))
        throw UsageError(option, fmt::format("{} {}", printable(path), *what));
}

void check_read_twice(const std::string& option, const std::vector<std::string>& inputs) {
    if (std::find(inputs.begin(), inputs.end(), "-") == inputs.end()) return;
    throw UsageError(fmt::format("{} reads its inputs twice, which standard input does not allow", option));
}

}  // namespace tex::cli
