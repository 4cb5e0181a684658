// SPDX-License-Identifier: Apache-2.0
// The files that a recipe reads and writes.

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "files/path_names.h"
#include "tasks/other_parts.h"
#include "tasks/udim.h"
#include "tree/recipe.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::vector<std::string> OutputFiles::all() const {
    std::vector<std::string> names = levels.empty() ? std::vector<std::string>() : with_all_levels(levels);
    names.insert(names.end(), files.begin(), files.end());
    return names;
}

std::string Recipe::below_root(const std::string& file) const {
    const bool is_below = !root_.empty() && file.starts_with(root_ + "/");
    return is_below ? file.substr(root_.size() + 1) : file;
}

// A name that a pattern gives, relative to the root. Throws UsageError if it leads out of it.
std::string Recipe::below_out_dir(const std::string& name) const {
    const fs::path whole = (fs::path(rule_.out_dir) / fs::path(name).relative_path()).lexically_normal();
    if (!whole.is_absolute() && *whole.begin() == "..") {
        throw UsageError(
            fmt::format("the output {} leads out of the folder of the manifest", printable(slashed(whole))));
    }
    return slashed(whole);
}

// An output that leads out of the root whatever its input is called is a mistake in the manifest.
void Recipe::check_folder(const NamePattern& name, const std::string& out, const TextPosition& place) const {
    const fs::path whole = (fs::path(rule_.out_dir) / fs::path(out).relative_path()).lexically_normal();
    if (!name.uses("dir") && *whole.begin() == "..") {
        fail_at(manifest_.path, place,
                fmt::format("name: {} leads out of the folder of the manifest", printable(slashed(whole))));
    }
}

// Throws UsageError if a file that options write leads out of the root, whatever the input is called.
void Recipe::check_writes(const ReadyCommand& command) const {
    for (const auto& [option, pattern] : command.writes) {
        const std::string name = pattern.expand({".", "name", ".png", {}});
        const fs::path whole = (fs::path(rule_.out_dir) / fs::path(name).relative_path()).lexically_normal();
        if (!pattern.uses("dir") && *whole.begin() == "..") {
            throw UsageError(option,
                             fmt::format("{} leads out of the folder of the manifest", printable(slashed(whole))));
        }
    }
}

// The files that options of all steps name for an input.
std::vector<std::string> Recipe::prerequisites_of(const std::string& path) const {
    std::vector<std::string> files;
    const auto add = [&](const Task& task) {
        for (const std::string& file : task.prerequisites()) {
            std::string name = below_root(file);
            if (!contains(files, name)) files.push_back(std::move(name));
        }
    };
    for (std::size_t k = 0; k < before_.size(); ++k) {
        const Converter& converter = *before_[k].converter;
        add(k == 0 ? first_task(converter, path, kBetween) : converter.task_for(kBetween, kBetween, path));
    }
    for (const RecipeOutput& output : outputs_) {
        const Converter& converter = *output.last.converter;
        if (!before_.empty()) {
            add(converter.task_for(kBetween, output.out, path));
            continue;
        }
        for (const int tile : tiles_of(output.last, path, output.out)) {
            Task task{path, output.out};
            task.tile = tile;
            add(tile == 0 ? first_task(converter, path, output.out) : converter.task_for(std::move(task)));
        }
    }
    return files;
}

// What an input has and another has not is its own.
void Recipe::find_files() {
    const std::vector<std::string> others = prerequisites_of("other/name");
    for (std::string& file : prerequisites_of("input")) {
        if (contains(others, file)) files_.push_back(std::move(file));
    }
}

std::vector<std::string> Recipe::own_files(const std::string& input, const std::string& path) const {
    std::vector<std::string> files = other_parts(input, path);
    for (std::string& name : prerequisites_of(path)) {
        if (!contains(files_, name) && !contains(files, name)) files.push_back(std::move(name));
    }
    return files;
}

// The tiles that an output is made for; 0 alone if it has none, or if the mesh cannot be read.
std::vector<int> Recipe::tiles_of(const ReadyCommand& command, const std::string& path, const std::string& to) const {
    if (!has_tile(to) || !command.converter->makes_tiles()) return {0};
    std::vector<int> tiles = command.converter->tiles_of(path);
    return tiles.empty() ? std::vector<int>{0} : tiles;
}

std::string Recipe::output_name(const std::string& input, std::size_t index) const {
    const RecipeOutput& output = outputs_[index];
    NameFields fields = name_fields(input);
    const OutputOptions options = output.last.converter->output_for_task();
    options.fill(fields);
    if (!options.format && output.name.uses("format")) {
        const Task task = output.last.converter->task_for(input, output.name.expand(fields));
        fields.format = name_of(kEncodingNames, default_encoding(task.container));
    }
    return below_out_dir(output.name.expand(fields));
}

std::vector<Task> Recipe::tasks_of(const std::string& path, std::size_t index, const std::string& to) const {
    const ReadyCommand& command = outputs_[index].last;
    std::map<std::string, std::string> places;
    for (const auto& [option, pattern] : command.writes)
        places.emplace(option, path_to(below_out_dir(pattern.expand(name_fields(below_root(path))))));
    std::vector<Task> tasks;
    for (const int tile : tiles_of(command, path, to)) {
        Task task{path, with_tile(to, tile)};
        task.tile = tile;
        task.places = places;
        tasks.push_back(command.converter->task_for(std::move(task)));
    }
    return tasks;
}

OutputFiles Recipe::files_of(const std::string& input, std::size_t index) const {
    const std::string name = output_name(input, index);
    OutputFiles files;
    const ReadyCommand& command = outputs_[index].last;
    if (command.writes.empty() && !(has_tile(name) && command.converter->makes_tiles())) {
        (has_level(name) ? files.levels : files.files.emplace_back()) = name;
        return files;
    }
    for (const Task& task : tasks_of(path_to(input), index, path_to(name))) {
        (has_level(task.output) ? files.levels : files.files.emplace_back()) = below_root(task.output);
        for (const std::string& more : task.more_outputs) files.files.push_back(below_root(more));
    }
    return files;
}

}  // namespace tex::cli
