// SPDX-License-Identifier: Apache-2.0
// The files that a recipe reads and writes.

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "batch/repack.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "files/path_names.h"
#include "tasks/name_pattern.h"
#include "tasks/other_parts.h"
#include "tasks/udim.h"
#include "tree/recipe.h"
#include "tree/state.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

// The number that stands in a name for the mark of its pattern; 0 if the pattern has none. Nothing if the name is not
// of the pattern.
std::optional<int> number_in(const std::string& name, const std::string& pattern) {
    const std::size_t level = pattern.find(kLevelMark), tile = pattern.find(kTileMark);
    const std::size_t mark = std::min(level, tile);
    if (mark == std::string::npos) return name == pattern ? std::optional(0) : std::nullopt;
    constexpr int kMostDigits = 4;
    int number = 0;
    for (std::size_t k = mark; k < name.size() && k < mark + kMostDigits && name[k] >= '0' && name[k] <= '9'; ++k) {
        number = 10 * number + (name[k] - '0');
        const std::string tried = mark == level ? with_level(pattern, number) : with_tile(pattern, number);
        if (tried == name) return number;
    }
    return std::nullopt;
}

// Whether a name is relative and leads neither up nor in circles.
bool is_plain(const std::string& name) {
    const fs::path path(name);
    return !name.empty() && !path.has_root_path() && *path.begin() != ".." && path.lexically_normal() == path;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::vector<std::string> OutputFiles::all() const {
    std::vector<std::string> names;
    for (const std::string& name : levels) {
        for (std::string& file : with_all_levels(name)) names.push_back(std::move(file));
    }
    names.insert(names.end(), files.begin(), files.end());
    return names;
}

bool Recipe::reads_normals() const {
    const Converter* const first = (before_.empty() ? outputs_.front().last : before_.front()).converter;
    return dynamic_cast<const NormalsConverter*>(first) != nullptr;
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

// To try whether the options that write fit. The names are errors of the manifest if they are wrong whatever the input
// is called.
std::shared_ptr<const FurtherPlaces> Recipe::trial_places(const Command& command) const {
    FurtherPlaces places;
    places.input = "name.png";
    places.path_for = [this, &command](const std::string& option, const std::string& name) {
        const fs::path whole = (fs::path(rule_.out_dir) / fs::path(name).relative_path()).lexically_normal();
        const auto is_its_row = [&](const Option& row) { return row.name() == option; };
        const auto row = std::find_if(command.options().begin(), command.options().end(), is_its_row);
        if (!NamePattern(row->given.back()).uses("dir") && *whole.begin() == "..") {
            throw UsageError(option,
                             fmt::format("{} leads out of the folder of the manifest", printable(slashed(whole))));
        }
        if (check_->is_given() && has_level(name)) throw UsageError(option, "check needs all levels in one file");
        return slashed(whole);
    };
    return std::make_shared<const FurtherPlaces>(std::move(places));
}

// The files of options that write are below out-dir. Each is added to `names`, unless that is null.
std::shared_ptr<const FurtherPlaces> Recipe::further_places(const std::string& input,
                                                            std::map<std::string, std::string>* names) const {
    FurtherPlaces places;
    places.input = input;
    places.path_for = [this, names](const std::string& option, const std::string& name) {
        const std::string file = below_out_dir(name);
        if (names != nullptr) (*names)[option] = file;
        return path_to(file);
    };
    return std::make_shared<const FurtherPlaces>(std::move(places));
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
        options.check_knows_format();
        const Task task = output.last.converter->task_for(input, output.name.expand(fields));
        fields.format = name_of(kEncodingNames, default_encoding(task.container));
    }
    return below_out_dir(output.name.expand(fields));
}

std::string Recipe::path_to(const std::string& name) const { return path_from(root_, name); }

Task Recipe::task_of(const std::string& path, std::size_t index, const std::string& to, int tile,
                     std::map<std::string, std::string>* further) const {
    const ReadyCommand& command = outputs_[index].last;
    Task task{before_.empty() ? path : kBetween, with_tile(to, tile)};
    if (!before_.empty()) task.origin = path;
    task.tile = tile;
    if (!command.writes.empty()) task.further = further_places(below_root(path), further);
    return command.converter->task_for(std::move(task));
}

std::vector<Task> Recipe::tasks_of(const std::string& path, std::size_t index, const std::string& to,
                                   std::map<std::string, std::string>* further) const {
    std::vector<Task> tasks;
    for (const int tile : tiles_of(outputs_[index].last, path, to))
        tasks.push_back(task_of(path, index, to, tile, further));
    return tasks;
}

OutputFiles Recipe::files_of(const std::string& input, std::size_t index,
                             std::map<std::string, std::string>* further) const {
    const std::string name = output_name(input, index);
    OutputFiles files;
    const ReadyCommand& command = outputs_[index].last;
    if (command.writes.empty() && !(has_tile(name) && command.converter->makes_tiles())) {
        files.add(name);
        return files;
    }
    for (const Task& task : tasks_of(path_to(input), index, path_to(name), further)) {
        for (const std::string& file : task.outputs()) files.add(below_root(file));
    }
    return files;
}

// The names of an output's files with {level} and <UDIM> in them: without a look at a mesh.
OutputFiles Recipe::marked_files_of(const std::string& input, std::size_t index) const {
    OutputFiles files;
    const std::string name = output_name(input, index);
    if (outputs_[index].last.writes.empty()) {
        files.add(name);
        return files;
    }
    for (const std::string& file : task_of(path_to(input), index, path_to(name), 0, nullptr).outputs())
        files.add(below_root(file));
    return files;
}

bool Recipe::are_files_of(const std::string& input, std::size_t index, const std::vector<std::string>& names) const {
    const OutputFiles marked = marked_files_of(input, index);
    std::size_t known = 0;
    const auto numbers_of = [&](const std::string& pattern) {
        std::set<int> numbers;
        for (const std::string& name : names) {
            if (const std::optional<int> number = number_in(name, pattern)) numbers.insert(*number);
        }
        known += numbers.size();
        return numbers;
    };
    for (const std::string& pattern : marked.levels) {
        const std::set<int> levels = numbers_of(pattern);
        if (levels.empty() || *levels.rbegin() + 1 != static_cast<int>(levels.size())) return false;
    }
    for (const std::string& pattern : marked.files) {
        if (numbers_of(pattern).empty()) return false;
    }
    return known == names.size();
}

std::optional<std::string> Recipe::name_below_out_dir(const std::string& input, const std::string& file) const {
    if (!is_plain(input) || !matches(input)) return std::nullopt;
    std::string folder = slashed(fs::path(rule_.out_dir).lexically_normal());
    if (folder == ".") folder.clear();
    if (!folder.empty() && !folder.ends_with('/')) folder += '/';
    if (!file.starts_with(folder)) return std::nullopt;
    std::string name = file.substr(folder.size());
    if (!is_plain(name)) return std::nullopt;
    for (std::size_t k = 0; k < outputs_.size(); ++k) {
        try {
            const OutputFiles marked = marked_files_of(input, k);
            const auto is_file = [&](const std::string& pattern) { return number_in(file, pattern).has_value(); };
            if (std::any_of(marked.levels.begin(), marked.levels.end(), is_file) ||
                std::any_of(marked.files.begin(), marked.files.end(), is_file))
                return name;
        } catch (const UsageError&) {
            // This output of this input leads out of the root, or has no name.
        }
    }
    return std::nullopt;
}

}  // namespace tex::cli
