// SPDX-License-Identifier: Apache-2.0

#include "tree/work.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <unordered_map>

#include <fmt/format.h>
#include <tex/file.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "files/path_names.h"
#include "tasks/file_table.h"
#include "tasks/name_pattern.h"
#include "tree/beside.h"
#include "tree/infer_rules.h"
#include "tree/state.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSame = "the same output";

std::string in_lower_case(std::string text) {
    for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return text;
}

// Textures are made from something, and have names like its own.
bool is_source(const std::string& path) {
    const auto container = container_of(path);
    return is_picture(path) && !(container && can_hold_blocks(*container));
}
bool may_need_rule(const std::string& path) {
    return named_as(path) != NamedAs::other && (is_height_file(path) || is_source(path));
}

// The folders of outputs, each with "/" at its end.
std::vector<std::string> output_folders(const std::vector<Recipe>& recipes) {
    std::vector<std::string> folders;
    for (const Recipe& recipe : recipes) {
        const std::string folder = slashed(fs::path(recipe.rule().out_dir).lexically_normal());
        if (!folder.empty() && folder != ".") folders.push_back(folder.ends_with('/') ? folder : folder + "/");
    }
    std::erase_if(folders, [&](const std::string& folder) {
        return std::any_of(recipes.begin(), recipes.end(), [&](const Recipe& recipe) {
            return std::any_of(recipe.match().begin(), recipe.match().end(),
                               [&](const Glob& glob) { return glob.text().starts_with(folder); });
        });
    });
    return folders;
}

class Lister {
public:
    Lister(const std::vector<Recipe>& recipes, const std::string& root, const FolderVisitor& entered)
        : recipes_(recipes), root_(root), entered_(entered) {}

    WorkList list() {
        find_inputs();
        find_collisions();
        find_needs();
        find_without_rule();
        return std::move(work_);
    }

private:
    void find_inputs();
    bool is_left_alone(const Recipe& recipe, const std::string& input);
    void find_collisions();
    std::vector<std::string> files_of(std::size_t index, std::size_t output);
    void refuse(std::size_t index, std::size_t earlier, const char* what, const std::string& output);
    void find_needs();
    void find_without_rule();
    void check_cycle(std::size_t recipe, std::vector<std::size_t>& open);

    const std::vector<Recipe>& recipes_;
    const std::string& root_;
    const FolderVisitor& entered_;
    WorkList work_;
    std::vector<std::string> passed_over_;  // pictures with such names that no pattern matches
    FilesBeside beside_{root_};
    std::unordered_map<std::string, std::size_t> makers_;  // the task that makes an output
    std::vector<std::set<std::size_t>> needed_;            // the recipes that each recipe needs
    std::set<std::size_t> checked_;                        // recipes that need no cycle
};

// Whether a file beside the input does, which no rule makes, as the rule's unless says. Outputs that lie there would
// end what makes them.
bool Lister::is_left_alone(const Recipe& recipe, const std::string& input) {
    std::vector<std::string> made;
    for (const Recipe& other : recipes_) {
        if (recipe.rule().unless.empty() || !other.takes(input)) continue;
        for (std::size_t k = 0; k < other.outputs().size(); ++k) {
            try {
                const OutputFiles files = other.files_of(input, k);
                made.insert(made.end(), files.files.begin(), files.files.end());
            } catch (const UsageError&) {  // refused later
            }
        }
    }
    return std::any_of(recipe.rule().unless.begin(), recipe.rule().unless.end(),
                       [&](const std::string& pattern) { return beside_.has(pattern, input, made); });
}

void Lister::find_inputs() {
    const std::vector<std::string> folders = output_folders(recipes_);
    FileSearch search;
    for (const Recipe& recipe : recipes_) {
        for (const Glob& glob : recipe.match()) search.globs.push_back(&glob);
    }
    search.skip = [&](const std::string& folder) {
        return std::find(folders.begin(), folders.end(), folder) != folders.end();
    };
    search.entered = entered_;
    search.passed_over = [&](const std::string& path) {
        if (may_need_rule(path))
            passed_over_.push_back(path);
        else if (is_source(path))
            work_.other_pictures.push_back(path);
    };
    search.unreadable = [&](const std::string& folder, const std::string& reason) {
        work_.unreadable.push_back(folder + ": " + reason);
    };
    for (FoundFile& file : find_files(root_, search)) {
        const auto recipe = std::find_if(recipes_.begin(), recipes_.end(), [&](const Recipe& candidate) {
            return candidate.takes(file.path) && !is_left_alone(candidate, file.path);
        });
        if (recipe == recipes_.end()) continue;
        BuildTask task;
        task.recipe = static_cast<std::size_t>(recipe - recipes_.begin());
        task.size = file.size;
        for (std::size_t k = 0; k < recipe->outputs().size(); ++k) {
            try {
                task.outputs.push_back(recipe->output_name(file.path, k));
            } catch (const UsageError& error) {
                task.refusal = error.what();
            }
        }
        task.input = std::move(file.path);
        work_.tasks.push_back(std::move(task));
    }
}

// Outputs are compared by their places, whatever links lead there, and without the case of letters, which some file
// systems ignore.
void Lister::find_collisions() {
    FileTable<std::size_t> places;
    std::unordered_map<std::string, std::size_t> folded;
    for (std::size_t k = 0; k < work_.tasks.size(); ++k) {
        for (std::size_t n = 0; n < work_.tasks[k].outputs.size(); ++n) {
            const std::string& output = work_.tasks[k].outputs[n];
            const bool has_name = makers_.emplace(output, k).second;
            const auto [same, is_new] = folded.emplace(in_lower_case(output), k);
            if (!is_new)
                refuse(k, same->second, has_name ? "outputs that differ only in the case of letters," : kSame, output);
            for (const std::string& file : files_of(k, n)) {
                const bool is_beside = file != output && !has_level(output);
                if (is_beside) makers_.emplace(file, k);
                const std::size_t* const other = places.add_place(path_from(root_, file), k);
                if (other != nullptr && is_new) refuse(k, *other, kSame, file);
                if (other != nullptr || !is_beside) continue;
                const auto [alike, is_other] = folded.emplace(in_lower_case(file), k);
                if (!is_other) refuse(k, alike->second, "outputs that differ only in the case of letters,", file);
            }
        }
    }
}

// The files of an output that may exist.
std::vector<std::string> Lister::files_of(std::size_t index, std::size_t output) {
    BuildTask& task = work_.tasks[index];
    try {
        return recipes_[task.recipe].files_of(task.input, output).all();
    } catch (const UsageError& error) {
        task.refusal = error.what();
        return with_all_levels(task.outputs[output]);
    }
}

// Refuses two tasks of one rule that make the file `output`; two rules must not. `what` says what they have in common.
void Lister::refuse(std::size_t index, std::size_t earlier, const char* what, const std::string& output) {
    BuildTask& task = work_.tasks[index];
    BuildTask& other = work_.tasks[earlier];
    const Recipe& recipe = recipes_[task.recipe];
    const std::string both = fmt::format("{} and {}", printable(other.input), printable(task.input));
    if (earlier == index) {
        recipe.fail(fmt::format("two outputs of {} are one file, {}; give each a name", printable(task.input),
                                printable(output)));
    }
    if (other.recipe != task.recipe) {
        recipe.fail(fmt::format("{} have the same output {}, by the rules {} and {}", both, printable(output),
                                recipes_[other.recipe].number(), recipe.number()));
    }
    const std::string refusal = fmt::format("{} have {} {}; rename or exclude one", both, what, printable(output));
    for (BuildTask* const one : {&task, &other}) {
        if (one->refusal.empty()) one->refusal = refusal;
    }
}

void Lister::find_needs() {
    needed_.resize(recipes_.size());
    std::vector<std::vector<std::size_t>> needs(recipes_.size());
    for (std::size_t k = 0; k < recipes_.size(); ++k) {
        for (const std::string& file : recipes_[k].files()) {
            const auto maker = makers_.find(slashed(fs::path(file).lexically_normal()));
            if (maker == makers_.end()) continue;
            needs[k].push_back(maker->second);
            needed_[k].insert(work_.tasks[maker->second].recipe);
        }
    }
    for (std::size_t k = 0; k < recipes_.size(); ++k) {
        std::vector<std::size_t> open;
        check_cycle(k, open);
    }
    for (BuildTask& task : work_.tasks) task.needs = needs[task.recipe];
}

void Lister::find_without_rule() {
    std::set<std::string> materials;  // that have a normal map, or heights that become one
    for (const BuildTask& task : work_.tasks) materials.insert(name_beginning(task.input));
    for (const std::string& path : passed_over_) {
        if (named_as(path) == NamedAs::normals) materials.insert(name_beginning(path));
    }
    const auto is_known = [&](const std::string& path) {
        return makers_.contains(path) || std::any_of(recipes_.begin(), recipes_.end(), [&](const Recipe& recipe) {
                   const std::vector<std::string>& files = recipe.files();
                   return recipe.excludes(path) || std::any_of(files.begin(), files.end(), [&](const auto& file) {
                              return slashed(fs::path(file).lexically_normal()) == path;
                          });
               });
    };
    for (const std::string& path : passed_over_) {
        const bool is_answered = named_as(path) == NamedAs::heights && materials.contains(name_beginning(path));
        if (!is_answered && !is_known(path)) work_.without_rule.push_back(path);
    }
    std::sort(work_.without_rule.begin(), work_.without_rule.end());
    std::set<std::string> folders, read;  // with inputs, and beside them
    for (const BuildTask& task : work_.tasks) {
        folders.insert(slashed(fs::path(task.input).parent_path()));
        for (const std::string& part : recipes_[task.recipe].own_files(task.input, path_from(root_, task.input)))
            read.insert(slashed(fs::path(part).lexically_normal()));
    }
    std::erase_if(work_.other_pictures, [&](const std::string& path) {
        const bool is_beside = folders.contains(slashed(fs::path(path).parent_path()));
        return !is_beside || read.contains(path) || is_known(path);
    });
    std::sort(work_.other_pictures.begin(), work_.other_pictures.end());
}

void Lister::check_cycle(std::size_t recipe, std::vector<std::size_t>& open) {
    if (std::find(open.begin(), open.end(), recipe) != open.end()) {
        std::string path;
        for (const std::size_t step : open) path += fmt::format("{} needs ", recipes_[step].number());
        recipes_[recipe].fail(
            fmt::format("rules need each other's outputs: rule {}{}", path, recipes_[recipe].number()));
    }
    if (checked_.contains(recipe)) return;
    open.push_back(recipe);
    for (const std::size_t needed : needed_[recipe]) check_cycle(needed, open);
    open.pop_back();
    checked_.insert(recipe);
}

}  // namespace

WorkList list_work(const std::vector<Recipe>& recipes, const std::string& root, const FolderVisitor& entered) {
    return Lister(recipes, root, entered).list();
}

WorkList part_of(const WorkList& work, std::set<std::size_t> part) {
    for (std::size_t before = 0; before != part.size();) {
        before = part.size();
        for (std::size_t k = 0; k < work.tasks.size(); ++k) {
            const std::vector<std::size_t>& needs = work.tasks[k].needs;
            const auto is_in = [&](std::size_t needed) { return part.contains(needed); };
            if (std::any_of(needs.begin(), needs.end(), is_in)) part.insert(k);
        }
    }
    std::vector<std::size_t> open(part.begin(), part.end());
    while (!open.empty()) {
        const std::size_t task = open.back();
        open.pop_back();
        for (const std::size_t needed : work.tasks[task].needs) {
            if (part.insert(needed).second) open.push_back(needed);
        }
    }
    std::unordered_map<std::size_t, std::size_t> place;
    for (const std::size_t task : part) place.emplace(task, place.size());
    WorkList list;
    for (const std::size_t task : part) {
        BuildTask& copy = list.tasks.emplace_back(work.tasks[task]);
        for (std::size_t& needed : copy.needs) needed = place.at(needed);
    }
    return list;
}

}  // namespace tex::cli
