// SPDX-License-Identifier: Apache-2.0
// build_record.cpp: the files of one texture, what the state and the cache know of them, and what is said of them.

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/file_status.h"
#include "cli/text.h"
#include "cli/text_file.h"
#include "tasks/folders.h"
#include "tasks/name_pattern.h"
#include "tree/build_run.h"

namespace tex::cli {
namespace {

// In the cache, the files that warnings are about.
constexpr const char* kInput = "input";
constexpr const char* kOutput = "output";

}  // namespace

// The files of an output as paths.
OutputFiles BuildRun::paths_of(const BuildTask& task, std::size_t output) const {
    OutputFiles files = recipes_[task.recipe].files_of(task.input, output);
    for (std::string& file : files.levels) file = contents_.path(file);
    for (std::string& file : files.files) file = contents_.path(file);
    return files;
}

std::string BuildRun::name_of_path(const std::string& path) const {
    const bool is_below = !options_.root.empty() && path.starts_with(options_.root + "/");
    return is_below ? path.substr(options_.root.size() + 1) : path;
}

// Records an output that is in its place.
void BuildRun::record(const BuildTask& task, const Stale& made, const Inputs& inputs,
                      const std::vector<std::string>& paths, const Placement& placement,
                      std::vector<FileWarning> warnings, Outcome& outcome) {
    PlacedFiles files;
    for (const std::string& path : paths) {
        const auto placed = placement.placed().find(path);
        if (placed != placement.placed().end()) files.emplace_back(name_of_path(path), placed->second);
    }
    for (const auto& [name, file] : files) outcome.outputs.push_back(name);
    if (options_.lists_made) {
        outcome.text +=
            fmt::format("{} -> {}\n", printable(task.input), printable(with_level(name_of_path(paths.front()), 0)));
    }
    for (FileWarning& warning : warnings) warning.file = name_of_path(warning.file);
    judge_.record(task, made, inputs, files, std::move(warnings));
}

// Says what making outputs called for that stand: somebody else, or a run long ago, may have made them.
void BuildRun::say_again(std::vector<FileWarning> warnings, Outcome& outcome) {
    for (FileWarning& warning : warnings) {
        warning.file = contents_.path(warning.file);
        if (warning.is_counted) repeated_.add(warning.file, warning.message);
    }
    const auto ends = std::stable_partition(warnings.begin(), warnings.end(),
                                            [](const FileWarning& warning) { return !warning.is_counted; });
    add_new({std::make_move_iterator(ends), std::make_move_iterator(warnings.end())}, outcome.remarks);
    warnings.erase(ends, warnings.end());
    add_new(std::move(warnings), outcome.warnings);
}

// Records what has taken its place although the whole failed, so that it can be found and replaced.
void BuildRun::record_parts(const BuildTask& task, const Placement& placement) {
    for (std::size_t k = 0; k < task.outputs.size(); ++k) {
        PlacedFiles files;
        for (const std::string& path : paths_of(task, k).all()) {
            const auto placed = placement.placed().find(path);
            if (placed != placement.placed().end()) files.emplace_back(name_of_path(path), placed->second);
        }
        if (!files.empty()) judge_.record_part(task, task.outputs[k], files);
    }
}

// Takes outputs from the cache, and off the list of those to make.
Result<void> BuildRun::fetch(const BuildTask& task, Judgement& judgement, Placement& placement, Outcome& outcome) {
    if (!cache_.is_used()) return {};
    std::vector<Stale> left;
    for (Stale& stale : judgement.stale) {
        const OutputFiles files = paths_of(task, stale.index);
        for (const std::string& path : files.all()) {
            if (auto created = create_folders_of(path); !created) return created;
        }
        const auto found =
            cache_.fetch(key_of(stale.settings, judgement.inputs.digest), files, placement.watched(write_));
        if (!found) return with_remedy(found.error(), contents_.path(task.outputs[stale.index]));
        if (found->empty()) {
            left.push_back(std::move(stale));
        } else {
            std::vector<FileWarning> warnings = cache_.warnings(key_of(stale.settings, judgement.inputs.digest));
            for (FileWarning& warning : warnings)
                warning.file = contents_.path(warning.file == kOutput ? task.outputs[stale.index] : task.input);
            record(task, stale, judgement.inputs, *found, placement, warnings, outcome);
            add_new(std::move(warnings), judgement.warnings);
        }
    }
    judgement.stale = std::move(left);
    return {};
}

// Puts an output into the cache, unless another program has replaced it.
void BuildRun::store(const BuildTask& task, const Stale& made, const Inputs& inputs,
                     const std::vector<std::string>& paths, const Placement& placement,
                     std::vector<FileWarning> warnings, Outcome& outcome) {
    if (cache_is_full_) return;
    std::vector<std::string> contents;
    for (const std::string& path : paths) {
        auto bytes = read_text_file(path, kNoLimit);
        const auto placed = placement.placed().find(path);
        if (!bytes || placed == placement.placed().end() || digest_of(*bytes) != placed->second.digest) return;
        contents.push_back(std::move(*bytes));
    }
    // Another tree may have other names.
    const std::string input = contents_.path(task.input), output = contents_.path(task.outputs[made.index]);
    std::erase_if(warnings,
                  [&](const FileWarning& warning) { return warning.file != input && warning.file != output; });
    for (FileWarning& warning : warnings) warning.file = warning.file == input ? kInput : kOutput;
    const auto stored =
        cache_.store(key_of(made.settings, inputs.digest), paths_of(task, made.index), contents, warnings);
    if (stored || (stored.error().detail == ErrorDetail::no_space && cache_is_full_.exchange(true))) return;
    outcome.warnings.push_back({task.input, "the cache does not take it: " + stored.error().message() +
                                                (cache_is_full_ ? "; nothing else is put there" : "")});
}

// For the summary: outputs of earlier runs that are still there, and that no rule makes any more, since their inputs
// are gone or renamed (prune() removes them), or since rules have changed.
std::string BuildRun::obsolete_words() const {
    std::set<std::string> wanted;
    for (const BuildTask& task : work_.tasks) wanted.insert(task.outputs.begin(), task.outputs.end());
    std::size_t removable = 0, kept = 0;
    std::string first_kept;
    for (const auto& [output, record] : state_.outputs) {
        if (wanted.contains(output)) continue;
        std::vector<std::string> there;
        for (const auto& [file, digest] : record.files) {
            if (status_of_link(contents_.path(file))) there.push_back(file);
        }
        if (there.empty()) continue;
        const std::string& input = record.input;
        const auto foreign = std::find_if(there.begin(), there.end(),
                                          [&](const std::string& file) { return !place_by_rules(input, file); });
        if (foreign == there.end()) {
            ++removable;
        } else if (kept++ == 0) {
            first_kept = *foreign;
        }
    }
    std::string words;
    const auto add = [&words](std::size_t count, const std::string& what) {
        if (count == 0) return;
        words += fmt::format("; {} output{} of earlier runs {} no longer made ({})", count, count == 1 ? "" : "s",
                             count == 1 ? "is" : "are", what);
    };
    add(removable, fmt::format("--prune removes {}", removable == 1 ? "it" : "them"));
    add(kept, fmt::format("{}{}: no rule gives an output such a name now, so delete what you do not need",
                          kept == 1 ? "" : "such as ", printable(first_kept)));
    return words;
}

}  // namespace tex::cli
