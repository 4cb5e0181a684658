// SPDX-License-Identifier: Apache-2.0

#include "batch/batch.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <exception>
#include <new>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include "batch/model_plan.h"
#include "batch/up_to_date.h"
#include "cli/file_status.h"
#include "cli/text_file.h"
#include "cli/usage_error.h"
#include "tasks/depfile.h"
#include "tasks/model_output.h"
#include "tasks/name_pattern.h"
#include "tasks/outcome.h"
#include "threads/fork_join.h"

namespace tex::cli {
namespace {

using Process = std::function<Result<void>(Job& job)>;

class Runner {
public:
    Runner(const std::vector<Task>& tasks, Console& console, const WriteOptions& write, const RunOptions& running,
           bool update, std::size_t most_at_once, Process process)
        : tasks_(tasks), console_(console), write_(write), running_(running), update_(update),
          most_at_once_(most_at_once), process_(std::move(process)), reporter_(console, tasks.size(), running.json),
          shows_progress_(running.shows_progress(console.host())) {}

    // Every worker takes the next file that no worker has taken yet, so files are started in the order of the inputs.
    void run() {
        const int threads = running_.threads > 0 ? running_.threads : tbb::info::default_concurrency();
        // TBB allows fewer threads if another run in this process has a smaller --threads.
        const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
        const std::size_t most = std::min({tasks_.size(), most_at_once_, allowed});
        const int workers = std::min(threads, static_cast<int>(most));
        const auto work = [this](int) {
            for (std::size_t k = next_++; k < tasks_.size() && !stopped() && !is_full_; k = next_++)
                reporter_.finish(k, outcome_of(tasks_[k]));
        };
        if (workers <= 1) {
            work(0);
        } else {
            try {
                fork_join(workers, workers, work);
            } catch (const std::runtime_error&) {  // thrown by TBB: outcome_of() lets no exception through
                throw std::system_error(EAGAIN, std::generic_category(), "the system refuses threads");
            }
        }
        console_.clear_progress();
    }

    [[nodiscard]] const Reporter& reporter() const { return reporter_; }
    [[nodiscard]] bool is_full() const { return is_full_; }

private:
    [[nodiscard]] bool stopped() const { return !console_.host().interruption().empty() || reporter_.is_abandoned(); }

    // Adds the progress of one file, from `counted` to `fraction`, to the total.
    void advance(const Task& task, double& counted, double fraction, const std::string& words) {
        const double done = done_ += fraction - counted;
        counted = fraction;
        console_.draw_progress(done / static_cast<double>(tasks_.size()),
                               tasks_.size() > 1 ? fmt::format("{} of {} files", finished_.load(), tasks_.size())
                               : words.empty()   ? task.input
                                                 : fmt::format("{}, {}", words, task.input));
    }

    Outcome outcome_of(const Task& planned) {
        std::optional<Task> renamed;
        if (planned.output == "-") renamed.emplace(planned).output = console_.host().out_name();
        const Task& task = renamed ? *renamed : planned;
        double counted = 0.0;  // the part of this file that done_ includes
        Job job(task, console_, running_.read, write_, running_.threads,
                [&](double fraction, const std::string& words) {
                    if (shows_progress_) advance(task, counted, fraction, words);
                    return !stopped();
                });
        Outcome outcome;
        const Clock::time_point start = Clock::now();
        try {
            if (const auto result = update_ ? update(job) : make(job); !result) outcome.error = result.error();
        } catch (const std::bad_alloc&) {
            outcome.error = Error{ErrorCode::out_of_memory, {}, "out of memory"};
        } catch (const std::exception& exception) {
            outcome.error = Error{ErrorCode::io, {}, fmt::format("{}; {}", exception.what(), kBugReport)};
            outcome.is_bug = true;
        }
        outcome.input = task.input;
        outcome.name = task.name();
        outcome.report = std::move(job.report);
        outcome.text = job.text();
        outcome.code = job.code();
        outcome.warnings = job.warnings();
        outcome.remarks = job.remarks();
        outcome.seconds = seconds_since(start);
        outcome.outputs = job.outputs();
        outcome.prerequisites = task.prerequisites();
        outcome.has_levels = has_level(task.output);
        outcome.is_joint = !task.joined.empty();
        // The library cannot tell a full disk from a reader that closed the pipe. It is not an error if a reader closes
        // the pipe because it has read enough.
        outcome.is_silent = outcome.error && planned.output == "-" && console_.host().out_is_abandoned();
        if (outcome.error && outcome.error->detail == ErrorDetail::no_space && is_full_.exchange(true))
            outcome.is_silent = true;
        done_ += 1.0 - counted;
        ++finished_;
        return outcome;
    }

    [[nodiscard]] Result<void> make(Job& job) {
        if (job.task.model && job.task.joined.empty()) {
            if (job.task.model->error) return *job.task.model->error;
            if (!job.task.model->map) return without_maps(job);
            job.task.model->report(job.report);
        }
        if (job.task.model_output && job.task.model_output->error) return *job.task.model_output->error;
        if (would_clobber(job.task)) return Error{ErrorCode::io, job.task.output, "exists, and --no-clobber is given"};
        return process_(job);
    }

    // Among many models, some may have no map.
    [[nodiscard]] Result<void> without_maps(Job& job) const {
        constexpr const char* kNoMaps = "no material uses a normal map";
        if (tasks_.size() == 1) return Error{ErrorCode::unsupported, job.task.input, kNoMaps};
        job.warn(kNoMaps);
        return {};
    }

    // Runs the job unless the outputs are up to date. They are not if an input changes meanwhile.
    [[nodiscard]] Result<void> update(Job& job) {
        const std::optional<std::int64_t> change = latest_change(job.task);
        if (change && is_up_to_date(job.task, *change)) {
            job.report["status"] = "current";
            for (std::string& output : job.task.outputs()) job.wrote(std::move(output));
            return {};
        }
        Result<void> made = make(job);
        job.report["status"] = "made";
        if (made && change && latest_change(job.task) != change) make_outdated(job.task, *change);
        return made;
    }

    // Checked before the work is done. The library checks again when it writes.
    [[nodiscard]] bool would_clobber(const Task& task) const {
        if (!write_.no_clobber) return false;
        const auto status = status_of(with_level(task.output, 0));
        return status && status->is_regular();
    }

    const std::vector<Task>& tasks_;
    Console& console_;
    const WriteOptions& write_;
    const RunOptions& running_;
    const bool update_;
    const std::size_t most_at_once_;
    Process process_;
    Reporter reporter_;
    bool shows_progress_;
    std::atomic<std::size_t> next_{0};
    std::atomic<std::size_t> finished_{0};
    std::atomic<double> done_{0.0};
    std::atomic<bool> is_full_{false};  // an output found no space; all others would fail in the same way
};

ExitCode code_of(const Result<void>& result, Console& console) {
    if (result) return ExitCode::done;
    console.error(result.error().message());
    return exit_code(result.error().code);
}

}  // namespace

Result<std::vector<Task>> Batch::plan() const {
    const auto inputs = files.list_inputs(command);
    if (!inputs) return inputs.error();
    std::vector<Task> tasks;
    for (const Input& input : *inputs) {
        tasks.push_back({input.name, ""});
        tasks.back().tile = input.tile;
        tasks.back().in_folder = !input.folder.empty();
        tasks.back().pattern = input.pattern;
    }
    return tasks;
}

void Converter::note_pictures(Job& job, const std::string& what) {
    const bool is_asked = !files.output.empty() || !files.name.empty() || output.container || output.format;
    if (is_asked || !output.engines.empty()) return;
    const std::string extension = std::filesystem::path(job.task.input).extension().string();
    const std::string_view kept = name_of(kContainerNames, job.task.container);
    repeated_.add(job, job.task.input,
                  fmt::format("{}; --name '{{stem}}{}' writes the model itself (--container {} silences this "
                              "warning)",
                              what, extension, kept));
}

void Converter::note_output(Job& job, const OutputFacts& facts, const std::string& about) {
    const std::string& file = about.empty() ? job.task.map_path() : about;
    const Extent block = format_info(encoding_info(facts.encoding).format).block;
    const bool has_blocks = can_hold_blocks(job.task.container) && block.texels() > 1;
    // A texture that was made with one level is meant to have one.
    const std::optional<Container> from = container_of(job.task.map_path());
    const bool is_from_picture = !from || !can_hold_blocks(*from);
    const MipChainOptions* const chain = mip_chain();
    if (chain != nullptr) {
        if (is_from_picture && has_blocks && facts.levels == 1 && chain->keeps_unasked(job.task) &&
            level_count(facts.extent) > 1) {
            repeated_.add(job, file,
                          "one level is written, as in the input, and flickers from afar; --mips all builds the "
                          "smaller ones (--mips keep silences this warning)");
        }
        const int side = std::max(facts.extent.width, facts.extent.height);
        if (facts.is_reduced && side < chain->mip.max_side) {
            repeated_.add(
                job, file,
                fmt::format("--max-size {} gives {}x{}: it only halves, and the next larger level is above it",
                            chain->mip.max_side, facts.extent.width, facts.extent.height));
        }
    }
    if (job.task.model && rules().writes_models) note_pictures(job, "its normal maps are written as pictures");
    // Blocks of ASTC may reach beyond the border. check-normals finds the same (N106).
    const bool needs_whole_blocks =
        has_blocks && block == Extent{4, 4} && !name_of(kEncodingNames, facts.encoding).starts_with("astc");
    if (needs_whole_blocks && (facts.extent.width % block.width != 0 || facts.extent.height % block.height != 0)) {
        repeated_.add(job, file,
                      "a side of the base level is no multiple of 4, which block formats need in Direct3D, and in most "
                      "engines");
    }
}

ExitCode Batch::work(Console& console) {
    if (running.quiet) console.be_quiet();
    if (files.output == "-" && files.writes() && console.host().out_is_terminal())
        throw UsageError("-o -: standard output is a terminal");
    const auto tasks = plan();
    if (!tasks) return code_of(tasks.error(), console);
    if (const auto checked = check(*tasks); !checked) return code_of(checked, console);
    if (files.writes()) {
        if (const auto created = create_folders(files, *tasks); !created) return code_of(created, console);
    }
    return run_tasks(*tasks, console);
}

ExitCode Batch::run_tasks(const std::vector<Task>& tasks, Console& console) {
    std::optional<tbb::global_control> limit;
    if (running.threads > 1)
        limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(running.threads));
    Host& host = console.host();
    host.begin();
    WriteOptions write;
    write.sync = !files.no_sync;
    write.no_clobber = files.no_clobber;
    write.reader = running.read;
    Runner runner(tasks, console, write, running, files.update, most_at_once(tasks),
                  [this](Job& job) { return process(job); });
    runner.run();
    const Reporter& reporter = runner.reporter();
    if (const std::string_view by = host.interruption(); !by.empty()) {
        console.error(fmt::format("interrupted by {}; {} of {} files are done", by, reporter.done(), tasks.size()));
        host.end_interrupted();
        return ExitCode::io;
    }
    if (runner.is_full() && tasks.size() > 1) {
        console.error(fmt::format("no space is left, so the run stops here; {} of {} files are done", reporter.done(),
                                  tasks.size()));
    }
    ExitCode code = std::max(finish(console), reporter.exit_code());
    repeated_.print(console);
    if (!files.depfile.empty()) {
        write.no_clobber = false;  // every run rewrites its depfile
        const auto text = depfile_text(reporter.dependencies());
        const auto written = text ? write_document(files.depfile, *text, write) : Result<void>(text.error());
        code = std::max(code, code_of(written, console));
    }
    return code;
}

OutputOptions Converter::output_for_task() const {
    if (output.engines.size() > 1) throw UsageError("--for", "an output is for one engine");
    return output.of(output.engines_or_none().front());
}

const OutputRules& Converter::known_rules() const {
    std::call_once(rules_are_known_, [this] { known_rules_ = rules(); });
    return known_rules_;
}

Task Converter::task_for(Task task) const {
    const OutputRules& known = known_rules();
    if (!known.writes_models || !writes_models(files)) return complete(std::move(task), output_for_task(), known);
    MeshReadOptions how;
    how.reader = running.read;
    return complete_model(std::move(task), files, output, known, command, how);
}

Result<void> Converter::process_task(Job& job) {
    if (job.task.model_output && job.task.model_output->error) return *job.task.model_output->error;
    return process(job);
}

bool Converter::makes_tiles() const { return static_cast<bool>(known_rules().tiles); }

std::vector<int> Converter::tiles_of(const std::string& input) const { return known_rules().tiles(input); }

Task Converter::task_for_tile(const std::string& input, const std::string& output_name,
                              const std::string& pattern) const {
    Task task = task_for(input, output_name);
    const auto tiles = grid_files(pattern);
    if (!tiles) return task;
    std::vector<Task> all(tiles->size());
    for (std::size_t k = 0; k < all.size(); ++k) {
        all[k].input = (*tiles)[k].name;
        all[k].pattern = pattern;
        all[k].place = (*tiles)[k].place;
    }
    known_rules().relate(all);
    const auto place = place_in_grid(pattern, input);
    for (Task& other : all) {
        if (!place || other.place->x != place->x || other.place->y != place->y) continue;
        task.place = other.place;
        task.around = std::move(other.around);
        task.own.insert(task.own.end(), other.own.begin(), other.own.end());
    }
    return task;
}

Result<std::vector<Task>> Converter::plan() const {
    auto inputs = files.list_inputs(command);
    if (!inputs) return inputs.error();
    const OutputRules own = rules();
    if (own.models) {
        MeshReadOptions how;
        how.reader = running.read;
        if (own.writes_models && writes_models(files))
            return plan_models(std::move(*inputs), files, output, own, command, how);
        if (!own.lods) *inputs = with_maps_of_models(std::move(*inputs), *own.models, how);
    }
    return plan_outputs(std::move(*inputs), files, output, own);
}

}  // namespace tex::cli
