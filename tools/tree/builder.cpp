// SPDX-License-Identifier: Apache-2.0

#include "tree/builder.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <thread>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tex/file.h>

#include "cli/file_status.h"
#include "cli/json.h"
#include "cli/text.h"
#include "cli/text_file.h"
#include "files/system_error.h"
#include "options/files.h"
#include "tasks/depfile.h"
#include "tasks/folders.h"
#include "tasks/name_pattern.h"
#include "tree/build_run.h"
#include "tree/removal.h"

namespace tex::cli {
// What this run reads and writes besides textures.
RunDocuments BuildRun::documents_of(const BuildOptions& options) {
    RunDocuments documents = options.documents;
    documents.read.push_back({"the manifest", options.manifest});
    documents.written.push_back({"the state of the build", options.state_file});
    if (!options.shard_state.empty()) documents.written.push_back({"the state of the shard", options.shard_state});
    if (!options.depfile.empty()) documents.written.push_back({"--depfile", options.depfile});
    return documents;
}

std::int64_t BuildRun::memory_of(const BuildOptions& options) {
    return options.memory > 0 ? options.memory : physical_memory() / 2;
}

// Checks that the files which this run replaces are its own.
Result<void> BuildRun::open_files() {
    const std::string& state = options_.is_shard ? options_.shard_state : options_.state_file;
    if (auto checked = check_is_state(state); !checked) return checked;
    if (auto opened = cache_.open(options_.dry_run); !opened) return opened;
    return options_.shard_state.empty() ? Result<void>() : create_folders_of(options_.shard_state);
}

void BuildRun::read_state() {
    if (const auto text = read_text_file(options_.state_file, kMostOfRecord)) state_ = BuildState::parse(*text);
    if (options_.shard_state.empty()) return;
    // What an earlier try of this shard has made.
    if (const auto text = read_text_file(options_.shard_state, kMostOfRecord)) {
        BuildState earlier = BuildState::parse(*text);
        for (auto& [name, record] : earlier.outputs) state_.outputs[name] = std::move(record);
        for (const auto& [name, memo] : earlier.memos) state_.memos[name] = memo;
    }
}

void BuildRun::save_state(BuildState::Memos memos_of) {
    const std::string& file = options_.is_shard ? options_.shard_state : options_.state_file;
    if (file.empty() || options_.dry_run || (!judge_.has_changed() && !contents_.has_changed() && !lost_names_)) return;
    if (options_.is_part) memos_of = BuildState::Memos::all;
    WriteOptions write;
    write.sync = false;  // the state may be lost
    write.follow_links = false;
    std::string text;
    {
        const auto outputs = judge_.hold();
        const auto memos = contents_.hold();
        text = state_.text(memos_of);
    }
    if (const auto saved = write_text_file(file, text, write); !saved)
        console_.warning(fmt::format("{}; the next run will make everything again", saved.error().message()));
}

// Saves the state during a long run, so that less is lost if it is killed. This takes a fiftieth of the time at most.
void BuildRun::save_now_and_then() {
    using std::chrono::steady_clock;
    const std::unique_lock lock(saving_, std::try_to_lock);
    const auto begun = steady_clock::now();
    if (!lock || begun < next_save_) return;
    save_state(BuildState::Memos::all);
    const auto ended = steady_clock::now();
    next_save_ = ended + std::max<steady_clock::duration>(std::chrono::seconds(1), 50 * (ended - begun));
}

// An estimate: streams take little, pictures that the reader process decodes are held whole, and so are detail maps.
QueuedTask BuildRun::queued(const BuildTask& task) const {
    constexpr std::int64_t kStream = std::int64_t{24} << 20;
    const auto container = container_of(task.input);
    const bool streams = container && (can_hold_levels(*container) || *container == *container_of("a.png"));
    std::int64_t memory = kStream + (streams ? 0 : 8 * task.size);
    for (const std::string& file : recipes_[task.recipe].files()) {
        if (const auto stamp = contents_.stamp(file)) memory += 8 * stamp->size;
    }
    return {task.size, memory, task.needs};
}

std::string BuildRun::progress_words() const {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
    const double done = done_bytes_ / all_bytes_;
    std::string words = fmt::format("{} of {}", finished_.load(), work_.tasks.size());
    if (texels_ > 0 && seconds > 0.0)
        words += fmt::format(", {:.0f} Mtexel/s", static_cast<double>(texels_) / seconds / 1e6);
    if (done > 0.01 && seconds > 1.0) words += fmt::format(", {:.0f} s left", seconds * (1.0 - done) / done);
    return words;
}

// Adds the progress of one file of `size` bytes, from `counted` to `fraction`, to the total.
void BuildRun::advance(double& counted, double size, double fraction) {
    const double done = done_bytes_ += (fraction - counted) * size;
    counted = fraction;
    if (running_.shows_progress(console_.host())) console_.draw_progress(done / all_bytes_, progress_words());
}

void BuildRun::work_on(TaskQueue& queue) {
    try {
        while (const auto index = queue.take()) {
            Outcome outcome = outcome_of(*index);
            queue.finish(*index);
            if (outcome.error && outcome.error->detail == ErrorDetail::no_space) {
                outcome.is_silent = is_full_.exchange(true);  // the first one speaks for all
                queue.stop();
            }
            results_[*index] = {outcome.error ? "failed" : outcome.report.value("status", std::string()),
                                outcome.error ? std::optional(outcome.error->of(outcome.input)) : std::nullopt,
                                outcome.seconds};
            save_now_and_then();
            reporter_.finish(*index, std::move(outcome));
            if (stopped()) queue.stop();
        }
    } catch (...) {
        const std::lock_guard lock(throwing_);
        if (!thrown_) thrown_ = std::current_exception();
        queue.stop();
    }
}

// Detail maps that several textures blend are kept for all of them, in a part of the memory. Returns the rest.
std::int64_t BuildRun::share_details(std::int64_t memory) {
    std::map<std::string, int> readers;
    for (const BuildTask& task : work_.tasks) {
        for (const std::string& file : recipes_[task.recipe].files()) ++readers[file];
    }
    bool shares = false;
    for (const Recipe& recipe : recipes_) {
        const std::vector<std::string>& files = recipe.files();
        const auto is_shared = [&](const std::string& file) { return readers[file] > 1; };
        shares_.push_back(std::any_of(files.begin(), files.end(), is_shared));
        shares = shares || shares_.back();
    }
    if (!shares) return memory;
    shared_ = share_maps(memory / 4);
    return memory - memory / 4;
}

// The disk is full. Notes that the textures which were not tried have failed for the same reason.
void BuildRun::give_up_rest() {
    for (std::size_t k = 0; k < work_.tasks.size(); ++k) {
        if (!results_[k].status.empty()) continue;
        failed_[k] = ExitCode::io;
        results_[k] = {"failed", Error{ErrorCode::io, work_.tasks[k].input, "was not tried: the disk is full",
                                       ErrorDetail::no_space}};
    }
    console_.error(fmt::format("no space is left, so the run stops here; {} of {} files are done",
                               totals_.made + totals_.current + totals_.cached, work_.tasks.size()));
}

void BuildRun::run_tasks() {
    std::vector<QueuedTask> tasks;
    all_bytes_ = 1.0;
    for (const BuildTask& task : work_.tasks) {
        tasks.push_back(queued(task));
        all_bytes_ += static_cast<double>(task.size);
    }
    TaskQueue queue(std::move(tasks), share_details(memory_of(options_)));
    const int threads = running_.threads > 0 ? running_.threads : tbb::info::default_concurrency();
    const std::size_t workers = std::min({static_cast<std::size_t>(threads), kMostFilesAtOnce, work_.tasks.size()});
    // The workers are threads of their own: a worker of TBB that waits for a task could be the one that the task needs.
    std::vector<std::thread> others;
    try {
        for (std::size_t k = 1; k < workers; ++k) others.emplace_back([&] { work_on(queue); });
    } catch (const std::system_error&) {
        // Fewer threads do the work, too.
    }
    work_on(queue);
    for (std::thread& other : others) other.join();
    console_.clear_progress();
    if (thrown_) std::rethrow_exception(thrown_);
}

// Removes the outputs that no rule makes any more.
void BuildRun::prune() {
    std::vector<std::string> wanted;
    // Files that are outputs under any name: a folder may have become a link to one.
    FileTable<bool> current;
    for (const BuildTask& task : work_.tasks) {
        wanted.insert(wanted.end(), task.outputs.begin(), task.outputs.end());
        for (const std::string& output : task.outputs) current.add_place(contents_.path(with_level(output, 0)), true);
    }
    std::sort(wanted.begin(), wanted.end());
    const auto is_wanted = [&](const auto& record) {
        return std::binary_search(wanted.begin(), wanted.end(), record.first);
    };
    for (const auto& record : state_.outputs) {
        if (!is_wanted(record)) continue;
        for (const auto& [file, digest] : record.second.files) current.add_place(contents_.path(file), true);
    }
    std::vector<std::string> foreign;
    for (auto record = state_.outputs.begin(); record != state_.outputs.end();) {
        const bool is_gone = !is_wanted(*record) && remove_files(record->second, current, foreign);
        lost_names_ = lost_names_ || is_gone;
        record = is_gone ? state_.outputs.erase(record) : std::next(record);
    }
    if (foreign.empty()) return;
    console_.warning(fmt::format(
        "{} of an earlier run {} kept, such as {}: no rule of this manifest gives an output such a name, so "
        "that --prune cannot know it is one; delete what you do not need",
        foreign.size() == 1 ? "1 file" : fmt::format("{} files", foreign.size()), foreign.size() == 1 ? "is" : "are",
        printable(foreign.front())));
}

// The folder of a file that a rule can make of this input, and its name there. Nothing if no rule can: whoever hands
// over a folder could write a state that names any file.
std::optional<std::pair<std::string, std::string>> BuildRun::place_by_rules(const std::string& input,
                                                                            const std::string& file) const {
    for (const Recipe& recipe : recipes_) {
        if (auto name = recipe.name_below_out_dir(input, file))
            return std::pair(path_from(options_.root, recipe.rule().out_dir), std::move(*name));
    }
    return std::nullopt;
}

// Removes the files of an output. Adds those that no rule can have made to `foreign`. Returns false if the state must
// go on to know them.
bool BuildRun::remove_files(const OutputRecord& output, const FileTable<bool>& current,
                            std::vector<std::string>& foreign) {
    bool is_gone = true, removes = false;
    Json obsolete = Json::array();
    for (const auto& [file, digest] : output.files) {
        const std::string path = contents_.path(file);
        if (!status_of_link(path) || current.find(path) != nullptr) continue;
        const auto place = place_by_rules(output.input, file);
        if (!place) {
            foreign.push_back(file);
            is_gone = false;
            continue;
        }
        if (files_.is_read(path)) {
            console_.warning(fmt::format("{} is not removed: this run reads it", path));
            continue;
        }
        switch (remove_output(place->first, place->second, digest, options_.dry_run)) {
            case Removal::missing: break;
            case Removal::changed:
                console_.warning(fmt::format("{} is not removed: something else has changed it", path));
                break;
            case Removal::failed:
                console_.warning(fmt::format("{}: cannot be removed: {}", path, system_reason(errno)));
                is_gone = false;
                break;
            case Removal::removed:
                removes = true;
                if (!options_.dry_run) break;
                if (!running_.json) std::ignore = console_.print(fmt::format("remove {}\n", printable(file)));
                obsolete.push_back(file);
                is_gone = false;
        }
    }
    if (removes) ++totals_.pruned;
    if (running_.json && !obsolete.empty())
        std::ignore = console_.print(to_report_line({{"output", std::move(obsolete)}, {"status", "obsolete"}}));
    return is_gone;
}

// Writes which files the outputs that are up to date were made from.
ExitCode BuildRun::write_depfile() const {
    if (options_.depfile.empty() || options_.dry_run || options_.is_part) return ExitCode::done;
    std::vector<Dependency> dependencies;
    for (std::size_t k = 0; k < work_.tasks.size(); ++k) {
        const BuildTask& task = work_.tasks[k];
        Dependency& dependency = dependencies.emplace_back();
        for (const std::string& output : task.outputs) {
            const auto record = state_.outputs.find(output);
            if (failed_[k] != ExitCode::done || record == state_.outputs.end()) continue;
            for (const auto& [file, digest] : record->second.files) dependency.outputs.push_back(contents_.path(file));
        }
        dependency.inputs = {contents_.path(task.input), options_.manifest};
        for (const std::string& part : recipes_[task.recipe].own_files(task.input, contents_.path(task.input)))
            dependency.inputs.push_back(contents_.path(part));
        for (const std::string& file : recipes_[task.recipe].files()) dependency.inputs.push_back(contents_.path(file));
    }
    const auto text = depfile_text(dependencies);
    const auto written = text ? write_document(options_.depfile, *text) : Result<void>(text.error());
    if (written) return ExitCode::done;
    console_.error(written.error().message());
    return exit_code(written.error().code);
}

ExitCode BuildRun::run() {
    std::optional<tbb::global_control> limit;
    if (running_.threads > 1)
        limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(running_.threads));
    if (const auto opened = open_files(); !opened) {
        console_.error(opened.error().message());
        return exit_code(opened.error().code);
    }
    Host& host = console_.host();
    host.begin();
    read_state();
    run_tasks();
    if (options_.dry_run && !running_.json) {
        for (const std::string& picture : work_.other_pictures)
            std::ignore = console_.print(printable(picture) + ": has no rule\n");
    }
    if (is_full_) reporter_.report_waiting();
    ExitCode code = reporter_.exit_code();
    for (const std::string& folder : work_.unreadable) {
        console_.error(folder);
        code = std::max(code, ExitCode::io);
    }
    const std::string_view by = host.interruption();
    if (is_full_ && by.empty()) give_up_rest();
    if (by.empty() && options_.prune && !options_.is_part && work_.unreadable.empty()) prune();
    save_state(BuildState::Memos::used);
    if (by.empty()) code = std::max(code, write_depfile());
    if (cache_.is_used() && options_.cache_size > 0 && !options_.dry_run) cache_.shrink(options_.cache_size, console_);
    if (!by.empty()) {
        console_.error(
            fmt::format("interrupted by {}; {} of {} files are done", by, finished_.load(), work_.tasks.size()));
        if (running_.json) std::ignore = print_summary(true);
        host.end_interrupted();
        return ExitCode::io;
    }
    if (options_.finished && !options_.dry_run) code = std::max(code, options_.finished(results_, state_));
    std::set<const Converter*> finished;  // outputs share programs
    const auto finish = [&](const ReadyCommand& command) {
        if (finished.insert(command.converter).second) command.converter->finish_steps(console_);
    };
    for (const Recipe& recipe : recipes_) {
        for (const ReadyCommand& command : recipe.before()) finish(command);
        for (const RecipeOutput& output : recipe.outputs()) finish(output.last);
    }
    repeated_.print(console_);
    return std::max(code, print_summary(false));
}

ExitCode print_json_summary(const BuildTotals& totals, std::size_t untried, std::size_t without_rule,
                            bool is_interrupted, Console& console) {
    return console.print(to_report_line({{"made", totals.made.load()},
                                         {"current", totals.current.load()},
                                         {"cached", totals.cached.load()},
                                         {"failed", totals.failed.load()},
                                         {"untried", untried},
                                         {"removed", totals.pruned.load()},
                                         {"without_rule", without_rule},
                                         {"interrupted", is_interrupted}}));
}

// Prints what happened to the textures: a line of JSON with --json, a line for people without.
ExitCode BuildRun::print_summary(bool is_interrupted) {
    if (running_.json)
        return print_json_summary(totals_, work_.tasks.size() - finished_.load(),
                                  work_.without_rule.size() + work_.other_pictures.size(), is_interrupted, console_);
    if (running_.quiet) return ExitCode::done;
    std::string summary = fmt::format("{} {}, {} up to date", totals_.made.load(),
                                      options_.dry_run ? "to make" : "made", totals_.current.load());
    if (cache_.is_used()) summary += fmt::format(", {} from the cache", totals_.cached.load());
    if (cache_.damaged() > 0) {
        summary +=
            fmt::format(" ({} damaged {} repaired)", cache_.damaged(), cache_.damaged() == 1 ? "entry" : "entries");
    }
    if (totals_.failed > 0) summary += fmt::format(", {} failed", totals_.failed.load());
    if (is_full_) summary += fmt::format(", {} not tried", work_.tasks.size() - finished_.load());
    if (totals_.pruned > 0)
        summary += fmt::format(", {} {}", totals_.pruned.load(), options_.dry_run ? "to remove" : "removed");
    const bool knows_all = !options_.prune && !options_.is_part && work_.unreadable.empty();
    if (knows_all) summary += obsolete_words();
    if (const std::size_t count = work_.other_pictures.size(); count > 0) {
        summary += fmt::format("; {} other picture{} no rule{}", count, count == 1 ? " has" : "s have",
                               options_.dry_run ? "" : " (--dry-run lists them)");
    }
    return console_.print(summary + "\n");
}

ExitCode build(const std::vector<Recipe>& recipes, const WorkList& work, const BuildOptions& options,
               const RunOptions& running, Console& console) {
    return BuildRun(recipes, work, options, running, console).run();
}

}  // namespace tex::cli
