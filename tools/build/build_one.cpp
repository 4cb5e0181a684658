// SPDX-License-Identifier: Apache-2.0

#include <filesystem>
#include <new>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>

#include "build/build_run.h"
#include "cli/text.h"
#include "files/system_error.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

}  // namespace

Result<void> BuildRun::create_folders(const std::string& output) const {
    const fs::path folder = fs::path(output).parent_path();
    std::error_code error;
    if (!folder.empty()) fs::create_directories(folder, error);
    if (!error) return {};
    return Error{ErrorCode::io, folder.string(), "cannot create this folder: " + system_reason(error.value())};
}

Error BuildRun::with_remedy(const Error& error, const std::string& output) const {
    struct stat status {};
    const bool is_read_only = error.code == ErrorCode::io && stat(output.c_str(), &status) == 0 &&
                              (status.st_mode & (S_IWUSR | S_IWGRP | S_IWOTH)) == 0;
    if (!is_read_only) return error;
    return {error.code, error.file, error.reason + "; make it writable (chmod u+w, p4 edit) or remove it"};
}

Result<Made> BuildRun::make(const BuildTask& task, const std::vector<Stale>& stale, double& counted) {
    std::vector<WantedOutput> wanted;
    for (const Stale& one : stale) {
        wanted.push_back({one.index, contents_.path(task.outputs[one.index])});
        if (const auto created = create_folders(wanted.back().path); !created) return created.error();
    }
    const MakeSettings settings{running_, write_, [&](double fraction) {
                                    advance(counted, static_cast<double>(task.size), fraction);
                                    return !stopped();
                                }};
    Result<Made> made = make_texture(recipes_[task.recipe], contents_.path(task.input), wanted, settings, console_);
    if (!made) return with_remedy(made.error(), wanted.front().path);
    return made;
}

// Takes outputs from the cache, and off the list of those to make.
Result<void> BuildRun::fetch(const BuildTask& task, Judgement& judgement, Outcome& outcome) {
    if (!cache_.is_used()) return {};
    std::vector<Stale> left;
    for (Stale& stale : judgement.stale) {
        const std::string& output = task.outputs[stale.index];
        const std::string path = contents_.path(output);
        if (has_level(output)) {  // several files, which the cache does not hold
            left.push_back(std::move(stale));
            continue;
        }
        if (const auto created = create_folders(path); !created) return created;
        const Result<bool> found = cache_.fetch(key_of(stale.settings, judgement.inputs), path, write_);
        if (!found) return with_remedy(found.error(), path);
        if (!*found) {
            left.push_back(std::move(stale));
        } else if (auto recorded = record(task, stale, judgement.inputs, {path}, outcome); !recorded) {
            return recorded;
        }
    }
    judgement.stale = std::move(left);
    return {};
}

// Records an output that is in its place.
Result<void> BuildRun::record(const BuildTask& task, const Stale& made, const Digest& inputs,
                              const std::vector<std::string>& paths, Outcome& outcome) {
    std::vector<std::string> files;
    for (const std::string& path : paths) {
        const bool is_below = !options_.root.empty() && path.starts_with(options_.root + "/");
        files.push_back(is_below ? path.substr(options_.root.size() + 1) : path);
    }
    outcome.outputs.insert(outcome.outputs.end(), files.begin(), files.end());
    return judge_.record(task, made, inputs, files);
}

void BuildRun::list_stale(const BuildTask& task, const std::vector<Stale>& stale, Outcome& outcome) {
    ++totals_.made;
    outcome.report["status"] = "stale";
    for (const Stale& one : stale) {
        const std::string output = with_level(task.outputs[one.index], 0);
        outcome.outputs.push_back(output);
        outcome.text += fmt::format("{} -> {}: {}\n", printable(task.input), printable(output), one.why);
    }
}

// Makes what is stale, unless the cache has it.
Result<void> BuildRun::make_stale(const BuildTask& task, Judgement judgement, double& counted, Outcome& outcome) {
    if (Result<void> fetched = fetch(task, judgement, outcome); !fetched) return fetched;
    if (judgement.stale.empty()) {
        ++totals_.cached;
        outcome.report["status"] = "cached";
        return {};
    }
    const Result<Made> made = make(task, judgement.stale, counted);
    if (!made) return made.error();
    for (std::size_t k = 0; k < judgement.stale.size(); ++k) {
        const Stale& stale = judgement.stale[k];
        if (auto recorded = record(task, stale, judgement.inputs, made->files[k], outcome); !recorded) return recorded;
        if (!cache_.is_used() || has_level(task.outputs[stale.index])) continue;
        const auto stored = cache_.store(key_of(stale.settings, judgement.inputs), made->files[k].front());
        if (!stored) outcome.warnings.push_back("the cache does not take it: " + stored.error().message());
    }
    outcome.warnings.insert(outcome.warnings.end(), made->warnings.begin(), made->warnings.end());
    texels_ += made->report.extent.texels();
    outcome.report["status"] = "made";
    outcome.report["extent"] = {made->report.extent.width, made->report.extent.height};
    outcome.report["levels"] = made->report.levels;
    outcome.report["bytes"] = made->report.bytes;
    ++totals_.made;
    return {};
}

Result<void> BuildRun::bring_up_to_date(std::size_t index, Outcome& outcome) {
    const BuildTask& task = work_.tasks[index];
    const Recipe& recipe = recipes_[task.recipe];
    outcome.report["rule"] = recipe.number();
    if (!task.refusal.empty()) return Error{ErrorCode::bad_option, task.input, task.refusal};
    for (const std::size_t needed : task.needs) {
        const std::string name = printable(work_.tasks[needed].outputs.front());
        if (failed_[needed])
            return Error{ErrorCode::bad_data, task.input, fmt::format("needs {}, which could not be made", name)};
        if (!stale_[needed]) continue;
        stale_[index] = true;
        std::vector<Stale> all(task.outputs.size());
        for (std::size_t k = 0; k < all.size(); ++k) all[k] = {k, {}, fmt::format("{}, which it needs, is made", name)};
        list_stale(task, all, outcome);
        return {};
    }
    double counted = 0.0;
    constexpr int kMostAttempts = 3;
    for (int attempt = 1; attempt <= kMostAttempts; ++attempt) {
        const auto before = contents_.stamp(task.input);
        Result<Judgement> judged = judge_.judge(task, recipe);
        if (!judged) return judged.error();
        if (judged->stale.empty()) {
            ++totals_.current;
            outcome.report["status"] = "current";
            return {};
        }
        outcome.report["why"] = judged->stale.front().why;
        if (options_.dry_run) {
            stale_[index] = true;
            list_stale(task, judged->stale, outcome);
            return {};
        }
        // What is recorded now would be wrong if the input changes, so that is checked after the files are made, and
        // the record is forgotten.
        if (Result<void> made = make_stale(task, std::move(*judged), counted, outcome); !made) return made;
        if (contents_.stamp(task.input) == before) return {};
        for (const std::string& output : task.outputs) judge_.forget(output);
        outcome.outputs.clear();
    }
    return Error{ErrorCode::io, contents_.path(task.input), "changes while it is read"};
}

Outcome BuildRun::outcome_of(std::size_t index) {
    const BuildTask& task = work_.tasks[index];
    Outcome outcome;
    outcome.input = task.input;
    outcome.has_levels = true;  // a list of outputs
    try {
        if (const auto done = bring_up_to_date(index, outcome); !done) outcome.error = done.error();
    } catch (const std::bad_alloc&) {
        outcome.error = Error{ErrorCode::out_of_memory, {}, "out of memory"};
    } catch (const std::exception& exception) {
        outcome.error = Error{ErrorCode::io, {}, fmt::format("{}; {}", exception.what(), kBugReport)};
        outcome.is_bug = true;
    }
    if (outcome.error) {
        failed_[index] = true;
        ++totals_.failed;
    }
    ++finished_;
    return outcome;
}

}  // namespace tex::cli
