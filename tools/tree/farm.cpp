// SPDX-License-Identifier: Apache-2.0

#include "tree/farm.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <system_error>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "cli/file_status.h"
#include "cli/text.h"
#include "cli/text_file.h"
#include "cli/usage_error.h"
#include "cli/value.h"
#include "files/system_error.h"
#include "tree/merge.h"
#include "tree/shard_report.h"
#include "tree/state.h"

namespace tex::cli {

void Farm::add(Command& command) {
    command.usage("[MANIFEST] --plan FILE");
    command.usage("--plan FILE --shard I/N [--report FILE]");
    command.usage("--plan FILE --merge REPORT...");
    command.group("Farm");
    command.output_file(plan_path_, "--plan", "write what is to be made, with its costs, for the shards of a farm");
    command.option("--shard", "I/N", "make the I-th of N shares of the plan (I from 1)",
                   [this](const std::string& text) { parse_shard(text); });
    command.output_file(report_, "--report", "write what the shard has made, when it has ended");
    command.flag(merges_, "--merge",
                 "check the reports of all shards and their outputs; print the shards to send again");
    command.example("build-normals --plan plan.jsonl", "Writes a plan for a farm.");
    command.example("build-normals --plan plan.jsonl --shard 3/64 --report r3.jsonl", "Makes the third of 64 shares.");
    command.example("build-normals --plan plan.jsonl --merge r*.jsonl", "Prints the shards to send again, if any.");
    command.check([this, &command] {
        for (const char* const option : {"--shard", "--merge"}) {
            if (command.given(option) && plan_path_.empty()) throw UsageError(fmt::format("{} needs --plan", option));
        }
        if (!report_.empty() && shard_ == 0) throw UsageError("--report needs --shard");
        if (shard_ != 0 && merges_) throw UsageError("--shard and --merge exclude each other");
        if (merges_ && command.inputs().empty()) throw UsageError("--merge needs the reports of the shards");
        const bool is_plain = shard_ == 0;  // a shard may be a dry run
        for (const char* const option : {"--explain", "--prune", "--dry-run"}) {
            if (!plan_path_.empty() && command.given(option) && (is_plain || std::string_view(option) != "--dry-run"))
                throw UsageError(fmt::format("{} and --plan exclude each other", option));
        }
    });
}

void Farm::parse_shard(const std::string& text) {
    const auto [shard, shards] = cut(text, '/');
    if (shards.empty()) throw UsageError("write it as I/N, such as 3/64");
    shards_ = parse_int(shards, 1, kMostShards);
    shard_ = parse_int(shard, 1, shards_);
}

Result<void> Farm::read_plan() {
    if (plan_path_.empty() || (shard_ == 0 && !merges_)) return {};
    const auto text = read_text_file(plan_path_, kMostOfRecord);
    if (!text) return text.error();
    plan_ = parse_farm_plan(plan_path_, *text);
    return {};
}

void Farm::check_fits(const std::string& manifest, const std::string& text, const BuildOptions& options,
                      Console& console) const {
    if (!plan_) return;
    if (plan_->manifest_digest != digest_of(text)) {
        throw UsageError(fmt::format("{} was made for another text of {}; make the plan again", plan_->path, manifest));
    }
    if (plan_->output_version != options.output_version) {
        throw UsageError(fmt::format("{} is for outputs of version {}, but this program makes version {}", plan_->path,
                                     plan_->output_version, options.output_version));
    }
    if (plan_->tool != TEX_VERSION) {
        console.warning(fmt::format("{} was made by version {}, and this is version {}", plan_->path,
                                    printable(plan_->tool), TEX_VERSION));
    }
}

ExitCode Farm::write_plan(const FarmPlan& head, const std::vector<Recipe>& recipes, const WorkList& work,
                          const BuildOptions& options, const RunOptions& running, Console& console) const {
    const TreeFiles checked(recipes, work.tasks, options.root,
                            {{{"the manifest", options.manifest}},
                             {{"the state of the build", options.state_file}, {"--plan", plan_path_}}});
    if (!work.unreadable.empty()) {
        for (const std::string& folder : work.unreadable) console.error(folder);
        return ExitCode::io;
    }
    FarmPlan plan = head;
    plan.tool = TEX_VERSION;
    plan.output_version = options.output_version;
    plan.tasks = work.tasks;
    plan.costs = costs_of(plan.tasks, options.root, running);
    ExitCode code = ExitCode::done;
    for (const BuildTask& task : plan.tasks) {
        if (task.refusal.empty()) continue;
        console.error(fmt::format("{}: {}", printable(task.input), task.refusal));
        code = ExitCode::data;
    }
    if (plan_path_ == "-") return std::max(code, console.print(plan.text()));
    if (const auto written = write_document(plan_path_, plan.text()); !written) {
        console.error(written.error().message());
        return exit_code(written.error().code);
    }
    if (running.json || running.quiet) return code;
    const auto texels = std::accumulate(plan.costs.begin(), plan.costs.end(), std::int64_t{0});
    return std::max(code, console.print(fmt::format("{} textures, {:.1f} Mtexel\n", plan.tasks.size(),
                                                    static_cast<double>(texels) / 1e6)));
}

// The names of outputs come from the manifest, because the plan may come from anywhere. Throws UsageError if those of
// the texture `index` of the plan are others.
void Farm::check_names(const std::vector<Recipe>& recipes, std::size_t index) const {
    const BuildTask& task = plan_->tasks[index];
    const auto misfit = [&] {
        return UsageError(fmt::format("{}: line {}: the manifest makes other outputs of {}; make the plan again",
                                      plan_->path, index + 2, printable(task.input)));
    };
    if (task.recipe >= recipes.size() || !recipes[task.recipe].takes(task.input)) throw misfit();
    std::vector<std::string> outputs;
    for (std::size_t n = 0; n < recipes[task.recipe].outputs().size() && task.refusal.empty(); ++n)
        outputs.push_back(recipes[task.recipe].output_name(task.input, n));
    if (task.refusal.empty() && outputs != task.outputs) throw misfit();
}

WorkList Farm::work_of_shard(const std::vector<Recipe>& recipes, const std::string& root, Console& console) const {
    const std::vector<std::size_t> mine = plan_->dealt(shards_)[static_cast<std::size_t>(shard_) - 1];
    std::unordered_map<std::size_t, std::size_t> place;  // in the shard, of tasks of the plan
    for (std::size_t k = 0; k < mine.size(); ++k) place.emplace(mine[k], k);
    WorkList work;
    std::string changed;
    std::size_t count = 0;
    for (const std::size_t k : mine) {
        check_names(recipes, k);
        BuildTask task = plan_->tasks[k];
        for (std::size_t& needed : task.needs) needed = place.at(needed);
        const auto stamp = FileStamp::of(root.empty() ? task.input : root + "/" + task.input);
        if (stamp && stamp->size != task.size && ++count == 1) changed = printable(task.input);
        if (stamp) task.size = stamp->size;
        work.tasks.push_back(std::move(task));
    }
    if (count > 0) {
        console.warning(
            fmt::format("{} inputs have changed since {} was made, such as {}; the outputs are made of what "
                        "they hold now",
                        count, plan_->path, changed));
    }
    return work;
}

ExitCode Farm::run_shard(const std::vector<Recipe>& recipes, BuildOptions options, const RunOptions& running,
                         Console& console) const {
    const WorkList work = work_of_shard(recipes, options.root, console);
    options.is_shard = true;
    options.documents.read.push_back({"the file of --plan", plan_path_});
    if (report_.empty()) return build(recipes, work, options, running, console);
    options.documents.written.push_back({"--report", report_});
    options.shard_state = state_beside(report_);
    options.finished = [&](const std::vector<BuildResult>& results, const BuildState& state) {
        const std::string text = shard_report_text(*plan_, shard_, shards_, work, results, state);
        if (const auto written = write_document(report_, text); !written) {
            console.error(written.error().message());
            return exit_code(written.error().code);
        }
        if (check_is_state(options.shard_state)) std::ignore = remove_file(options.shard_state);
        return ExitCode::done;
    };
    return build(recipes, work, options, running, console);
}

ExitCode Farm::merge(const std::vector<Recipe>& recipes, const std::vector<std::string>& reports,
                     const BuildOptions& options, const RunOptions& running, Console& console) const {
    RunDocuments documents{{{"the manifest", options.manifest}, {"the file of --plan", plan_path_}},
                           {{"the state of the build", options.state_file}}};
    for (const std::string& report : reports) documents.read.push_back({"the report of a shard", report});
    const TreeFiles checked({}, {}, {}, documents);
    if (const auto is_state = check_is_state(options.state_file); !is_state) {
        console.error(is_state.error().message());
        return exit_code(is_state.error().code);
    }
    for (std::size_t k = 0; k < plan_->tasks.size(); ++k) check_names(recipes, k);
    return merge_reports(*plan_, recipes, reports, options, running, console);
}

}  // namespace tex::cli
