// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <iterator>
#include <new>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/file_status.h"
#include "cli/text.h"
#include "cli/text_file.h"
#include "files/path_names.h"
#include "files/system_error.h"
#include "tasks/folders.h"
#include "tasks/name_pattern.h"
#include "tree/build_run.h"
#include "tree/checked_file.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

// The output of `maker` that the recipe reads.
std::string needed_file(const BuildTask& maker, const std::vector<Recipe>& recipes, const Recipe& recipe) {
    const std::vector<std::string> made = files_of(maker, recipes[maker.recipe]);
    for (const std::string& file : recipe.files()) {
        std::string name = slashed(fs::path(file).lexically_normal());
        if (std::find(made.begin(), made.end(), name) != made.end()) return name;
    }
    return maker.outputs.front();
}

}  // namespace

Error BuildRun::with_remedy(const Error& error, const std::string& output) const {
    const auto status = status_of(output);
    const bool is_read_only = error.code == ErrorCode::io && status && !status->is_writable;
    if (!is_read_only || error.detail == ErrorDetail::no_space) return error;
    return {error.code, error.file, error.reason + "; make it writable (chmod u+w, p4 edit) or remove it"};
}

// Whether the check of inputs finds an error in the input.
Result<bool> BuildRun::refuses_input(const BuildTask& task, Outcome& outcome) {
    const Recipe& recipe = recipes_[task.recipe];
    if (!recipe.reads_normals()) return false;
    const Execution execution{running_.threads, [this](double) { return !stopped(); }};
    const auto findings = recipe.check().findings_of_input(contents_.path(task.input), running_.read, execution);
    if (!findings) return findings.error();
    for (const std::string& sentence : *findings) {
        console_.error(fmt::format("{} ({}): {}", printable(task.input), recipe.place_text(), sentence));
        outcome.report["findings"].push_back({{"input", task.input}, {"message", sentence}});
    }
    if (findings->empty()) return false;
    outcome.code = ExitCode::findings;
    return true;
}

Result<Made> BuildRun::make(const BuildTask& task, const std::vector<Stale>& stale, const WriteOptions& write,
                            double& counted, Outcome& outcome) {
    const Recipe& recipe = recipes_[task.recipe];
    const bool is_checked = recipe.check().is_given();
    std::deque<CheckedFile> waiting;
    const auto in_memory = [&waiting] { return waiting.emplace_back().path(); };
    std::vector<WantedOutput> wanted;
    for (const Stale& one : stale) {
        WantedOutput& output = wanted.emplace_back(WantedOutput{one.index, contents_.path(task.outputs[one.index])});
        for (const std::string& path : paths_of(task, one.index).all()) {
            if (const auto created = create_folders_of(path); !created) return created.error();
            if (is_checked) (path == output.path ? output.write_to : output.further[path]) = in_memory();
        }
    }
    MakeSettings settings{running_, write, [&](double fraction) {
                              advance(counted, static_cast<double>(task.size), fraction);
                              return !stopped();
                          }};
    if (shares_[task.recipe]) settings.shared = shared_;
    if (recipe.check().compares()) settings.source = in_memory();
    if (!std::all_of(waiting.begin(), waiting.end(), [](const CheckedFile& file) { return file.is_open(); }))
        return Error{ErrorCode::out_of_memory, {}, system_reason(errno)};
    settings.takes_any = !recipe.check().refuses_inputs();
    if (recipe.check().checks_inputs()) {
        const auto refused = refuses_input(task, outcome);
        if (!refused) return refused.error();
        if (*refused) return Made();
    }
    Result<Made> made = make_texture(recipe, contents_.path(task.input), wanted, settings, console_);
    if (!made) return with_remedy(made.error(), wanted.front().path);
    if (!is_checked) return made;
    for (std::size_t k = 0; k < wanted.size(); ++k) {
        const MadeTexture texture{wanted[k].write_to, settings.source, made->packs[k], task.outputs[wanted[k].index],
                                  contents_.path(task.input)};
        const Execution execution{running_.threads, [this](double) { return !stopped(); }};
        const auto findings = recipe.check().findings(texture, running_.read, execution);
        if (!findings) return findings.error();
        for (const std::string& sentence : *findings) {
            outcome.code = ExitCode::findings;
            console_.error(fmt::format("{}, made from {} ({}): {}", printable(texture.name), printable(task.input),
                                       recipe.place_text(), sentence));
            outcome.report["findings"].push_back({{"output", texture.name}, {"message", sentence}});
        }
    }
    if (outcome.code == ExitCode::findings) return made;
    for (const WantedOutput& output : wanted) {
        std::vector<std::pair<std::string, std::string>> files = {{output.path, output.write_to}};
        files.insert(files.end(), output.further.begin(), output.further.end());
        for (const auto& [path, complete] : files) {
            const auto bytes = read_text_file(complete, kNoLimit);
            if (!bytes) return bytes.error();
            if (const auto put = write_text_file(path, *bytes, write); !put) return with_remedy(put.error(), path);
        }
    }
    return made;
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

// Lists the outputs that stay as they are.
void BuildRun::list_current(const BuildTask& task, const std::vector<Stale>& stale, Outcome& outcome) const {
    Json names = Json::array();
    for (std::size_t k = 0; k < task.outputs.size(); ++k) {
        if (std::any_of(stale.begin(), stale.end(), [k](const Stale& one) { return one.index == k; })) continue;
        for (const std::string& path : paths_of(task, k).all()) names.push_back(name_of_path(path));
    }
    outcome.report.erase("up_to_date");  // of an attempt before
    if (!names.empty()) outcome.report["up_to_date"] = std::move(names);
}

// What stat() says about the files that the outputs are made from, except those that this or another builder makes.
std::vector<std::optional<FileStamp>> BuildRun::stamps_of(const BuildTask& task) const {
    const auto is_made = [&](const std::string& file) {
        const std::string name = slashed(fs::path(file).lexically_normal());
        return std::any_of(task.needs.begin(), task.needs.end(), [&](std::size_t needed) {
            const BuildTask& maker = work_.tasks[needed];
            const std::vector<std::string> outputs = files_of(maker, recipes_[maker.recipe]);
            return std::find(outputs.begin(), outputs.end(), name) != outputs.end();
        });
    };
    std::vector<std::optional<FileStamp>> stamps = {contents_.stamp(task.input)};
    for (const std::string& part : recipes_[task.recipe].own_files(task.input, contents_.path(task.input)))
        stamps.push_back(contents_.stamp(part));
    for (const std::string& file : recipes_[task.recipe].files()) {
        if (!is_made(file)) stamps.push_back(contents_.stamp(file));
    }
    return stamps;
}

// Whether no file was replaced since `stamps`. Another builder may have put the same bytes in the place of a file that
// both make, so the contents of those are compared with `inputs`.
Result<bool> BuildRun::are_unchanged(const BuildTask& task, const std::vector<std::optional<FileStamp>>& stamps,
                                     const Digest& inputs) {
    if (stamps_of(task) != stamps) return false;
    if (task.needs.empty()) return true;
    const Result<Judgement> now = judge_.judge(task, recipes_[task.recipe]);
    if (!now) return now.error();
    return now->inputs.digest == inputs;
}

// Makes what is stale, unless the cache has it. Returns false if something that it is made from was replaced meanwhile:
// then nothing was put in place, because the digests name the contents before.
Result<bool> BuildRun::make_stale(const BuildTask& task, Judgement judgement,
                                  const std::vector<std::optional<FileStamp>>& stamps, double& counted,
                                  Outcome& outcome) {
    const auto is_unchanged = [&] { return are_unchanged(task, stamps, judgement.inputs.digest); };
    std::set<std::string> files;
    for (std::size_t k = 0; k < task.outputs.size(); ++k) {
        for (std::string& file : paths_of(task, k).all()) files.insert(std::move(file));
    }
    Placement fetched(files_, files, is_unchanged);
    const Result<void> done = fetch(task, judgement, fetched, outcome);
    if (fetched.met_change()) return false;
    if (!done) {
        record_parts(task, fetched);
        return done.error();
    }
    if (judgement.stale.empty()) {
        ++totals_.cached;
        outcome.report["status"] = "cached";
        say_again(std::move(judgement.warnings), outcome);
        return true;
    }
    Placement placement(files_, std::move(files), is_unchanged);
    const Result<Made> made = make(task, judgement.stale, placement.watched(write_), counted, outcome);
    if (placement.met_change()) return false;
    if (!made) {
        record_parts(task, placement);
        return made.error();
    }
    if (outcome.code == ExitCode::findings) {
        Result<bool> unchanged = is_unchanged();
        if (!unchanged || !*unchanged) return unchanged;
    }
    outcome.warnings.insert(outcome.warnings.end(), made->warnings.begin(), made->warnings.end());
    outcome.remarks.insert(outcome.remarks.end(), made->remarks.begin(), made->remarks.end());
    outcome.text += made->text;
    if (!made->bumpiness.is_null()) outcome.report["bumpiness"] = made->bumpiness;
    if (outcome.code == ExitCode::findings) {
        outcome.report["status"] = "refused";
        return true;
    }
    std::vector<FileWarning> warnings = made->warnings;
    std::copy_if(made->remarks.begin(), made->remarks.end(), std::back_inserter(warnings),
                 [](const FileWarning& remark) { return remark.is_counted; });
    std::erase_if(judgement.warnings, [&](FileWarning standing) {
        standing.file = contents_.path(standing.file);
        return std::find(warnings.begin(), warnings.end(), standing) != warnings.end();
    });
    say_again(std::move(judgement.warnings), outcome);
    for (std::size_t k = 0; k < judgement.stale.size(); ++k) {
        const Stale& stale = judgement.stale[k];
        record(task, stale, judgement.inputs, made->files[k], placement, warnings, outcome);
        if (cache_.is_used()) store(task, stale, judgement.inputs, made->files[k], placement, warnings, outcome);
    }
    texels_ += made->report.extent.texels();
    outcome.report["status"] = "made";
    outcome.report["extent"] = {made->report.extent.width, made->report.extent.height};
    outcome.report["levels"] = made->report.levels;
    outcome.report["bytes"] = made->report.bytes;
    ++totals_.made;
    return true;
}

// A texture that needs `name` fails in the same way as that did.
Result<void> BuildRun::fail_with(ExitCode cause, const BuildTask& task, const std::string& name, Outcome& outcome) {
    const std::string reason = fmt::format("needs {}, which could not be made", name);
    if (cause != ExitCode::findings)
        return Error{cause == ExitCode::io ? ErrorCode::io : ErrorCode::bad_data, task.input, reason};
    outcome.code = cause;
    outcome.report["status"] = "refused";
    outcome.report["findings"].push_back({{"output", task.outputs.front()}, {"message", reason}});
    console_.error(fmt::format("{}: {}", task.input, reason));
    return {};
}

Result<void> BuildRun::bring_up_to_date(std::size_t index, double& counted, Outcome& outcome) {
    const BuildTask& task = work_.tasks[index];
    const Recipe& recipe = recipes_[task.recipe];
    outcome.report["rule"] = recipe.number();
    if (!task.refusal.empty()) return Error{ErrorCode::bad_option, task.input, task.refusal};
    for (const std::size_t needed : task.needs) {
        const std::string name = printable(needed_file(work_.tasks[needed], recipes_, recipe));
        if (const ExitCode cause = failed_[needed]; cause != ExitCode::done)
            return fail_with(cause, task, name, outcome);
        if (!stale_[needed]) continue;
        stale_[index] = true;
        std::vector<Stale> all(task.outputs.size());
        for (std::size_t k = 0; k < all.size(); ++k) all[k] = {k, {}, fmt::format("{}, which it needs, is made", name)};
        list_stale(task, all, outcome);
        return {};
    }
    constexpr int kMostAttempts = 3;
    for (int attempt = 1; attempt <= kMostAttempts; ++attempt) {
        const auto stamps = stamps_of(task);
        Result<Judgement> judged = judge_.judge(task, recipe);
        if (!judged) return judged.error();
        if (running_.json) list_current(task, judged->stale, outcome);
        if (judged->stale.empty()) {
            ++totals_.current;
            outcome.report["status"] = "current";
            say_again(std::move(judged->warnings), outcome);
            return {};
        }
        const Stale& first = judged->stale.front();
        outcome.report["why"] = first.why;
        if (!first.changes.empty()) outcome.report["changes"] = json_of(first.changes);
        if (options_.dry_run) {
            stale_[index] = true;
            list_stale(task, judged->stale, outcome);
            return {};
        }
        const Result<bool> made = make_stale(task, std::move(*judged), stamps, counted, outcome);
        if (!made) return made.error();
        if (*made) return {};
        outcome.code = ExitCode::done;
        outcome.report.erase("findings");
        outcome.outputs.clear();
        outcome.warnings.clear();
        outcome.remarks.clear();
        outcome.text.clear();
    }
    return Error{ErrorCode::io, contents_.path(task.input),
                 "this file, or one that its rule reads, changes while it is read"};
}

Outcome BuildRun::outcome_of(std::size_t index) {
    const BuildTask& task = work_.tasks[index];
    Outcome outcome;
    outcome.input = outcome.name = task.input;
    outcome.has_levels = true;  // a list of outputs
    double counted = 0.0;       // the part of this file that the progress includes
    const auto start = std::chrono::steady_clock::now();
    try {
        if (const auto done = bring_up_to_date(index, counted, outcome); !done) outcome.error = done.error();
    } catch (const std::bad_alloc&) {
        outcome.error = Error{ErrorCode::out_of_memory, {}, "out of memory"};
    } catch (const std::exception& exception) {
        outcome.error = Error{ErrorCode::io, {}, fmt::format("{}; {}", exception.what(), kBugReport)};
        outcome.is_bug = true;
    }
    if (outcome.error || outcome.code == ExitCode::findings) {
        failed_[index] = outcome.error ? std::max(outcome.code, exit_code(outcome.error->code)) : outcome.code;
        ++totals_.failed;
    }
    outcome.seconds = std::chrono::duration<float>(std::chrono::steady_clock::now() - start).count();
    done_bytes_ += (1.0 - counted) * static_cast<double>(task.size);
    ++finished_;
    return outcome;
}

}  // namespace tex::cli
