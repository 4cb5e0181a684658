// SPDX-License-Identifier: Apache-2.0
// build_run.h: one run of build(). builder.cpp does what concerns all textures, build_one.cpp what concerns one.

#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tasks/outcome.h"
#include "tasks/repeated_warnings.h"
#include "tree/builder.h"
#include "tree/cache.h"
#include "tree/judge.h"
#include "tree/placement.h"
#include "tree/queue.h"
#include "tree/state.h"
#include "tree/texture_maker.h"

namespace tex::cli {

// For textures, which are as large as they are.
inline constexpr std::size_t kNoLimit = static_cast<std::size_t>(-1);

// What happened to the textures.
struct BuildTotals {
    std::atomic<std::size_t> made{0}, cached{0}, current{0}, failed{0}, pruned{0};
};

// The last line of --json.
ExitCode print_json_summary(const BuildTotals& totals, std::size_t untried, std::size_t without_rule,
                            bool is_interrupted, Console& console);

class BuildRun {
public:
    BuildRun(const std::vector<Recipe>& recipes, const WorkList& work, const BuildOptions& options,
             const RunOptions& running, Console& console)
        : recipes_(recipes), work_(work), options_(options), running_(running), console_(console),
          contents_(options.root, state_.memos), judge_(state_, contents_, options.output_version),
          reporter_(console, work.tasks.size(), running.json, running.json ? Printed::at_once : Printed::in_order),
          files_(recipes, work.tasks, options.root, documents_of(options)), cache_(options.cache, memory_of(options)),
          failed_(work.tasks.size()), stale_(work.tasks.size()), results_(work.tasks.size()) {
        write_.sync = !options.no_sync;
        write_.follow_links = false;
        write_.reader = running.read;
    }

    ExitCode run();

private:
    [[nodiscard]] static RunDocuments documents_of(const BuildOptions& options);
    [[nodiscard]] static std::int64_t memory_of(const BuildOptions& options);
    Result<void> open_files();
    void read_state();
    void save_state(BuildState::Memos memos_of);
    void save_now_and_then();
    void run_tasks();
    std::int64_t share_details(std::int64_t memory);
    void give_up_rest();
    void work_on(TaskQueue& queue);
    Outcome outcome_of(std::size_t index);
    Result<void> fail_with(ExitCode cause, const BuildTask& task, const std::string& name, Outcome& outcome);
    Result<void> bring_up_to_date(std::size_t index, double& counted, Outcome& outcome);
    Result<bool> make_stale(const BuildTask& task, Judgement judgement,
                            const std::vector<std::optional<FileStamp>>& stamps, double& counted, Outcome& outcome);
    [[nodiscard]] std::vector<std::optional<FileStamp>> stamps_of(const BuildTask& task) const;
    Result<bool> are_unchanged(const BuildTask& task, const std::vector<std::optional<FileStamp>>& stamps,
                               const Digest& inputs);
    Result<void> fetch(const BuildTask& task, Judgement& judgement, Placement& placement, Outcome& outcome);
    [[nodiscard]] OutputFiles paths_of(const BuildTask& task, std::size_t output) const;
    [[nodiscard]] std::string name_of_path(const std::string& path) const;
    void record(const BuildTask& task, const Stale& made, const Inputs& inputs, const std::vector<std::string>& paths,
                const Placement& placement, std::vector<FileWarning> warnings, Outcome& outcome);
    void say_again(std::vector<FileWarning> warnings, Outcome& outcome);
    void record_parts(const BuildTask& task, const Placement& placement);
    void store(const BuildTask& task, const Stale& made, const Inputs& inputs, const std::vector<std::string>& paths,
               const Placement& placement, std::vector<FileWarning> warnings, Outcome& outcome);
    void list_stale(const BuildTask& task, const std::vector<Stale>& stale, Outcome& outcome);
    void list_current(const BuildTask& task, const std::vector<Stale>& stale, Outcome& outcome) const;
    Result<bool> refuses_input(const BuildTask& task, Outcome& outcome);
    Result<Made> make(const BuildTask& task, const std::vector<Stale>& stale, const WriteOptions& write,
                      double& counted, Outcome& outcome);
    [[nodiscard]] Error with_remedy(const Error& error, const std::string& output) const;
    void prune();
    [[nodiscard]] std::optional<std::pair<std::string, std::string>> place_by_rules(const std::string& input,
                                                                                    const std::string& file) const;
    bool remove_files(const OutputRecord& output, const FileTable<bool>& current, std::vector<std::string>& foreign);
    [[nodiscard]] std::string obsolete_words() const;
    [[nodiscard]] ExitCode write_depfile() const;
    [[nodiscard]] QueuedTask queued(const BuildTask& task) const;
    void advance(double& counted, double size, double fraction);
    [[nodiscard]] ExitCode print_summary(bool is_interrupted);
    [[nodiscard]] std::string progress_words() const;
    [[nodiscard]] bool stopped() const { return !console_.host().interruption().empty() || reporter_.is_abandoned(); }

    const std::vector<Recipe>& recipes_;
    const WorkList& work_;
    const BuildOptions& options_;
    const RunOptions& running_;
    Console& console_;
    WriteOptions write_;
    BuildState state_;
    Contents contents_;
    Judge judge_;
    Reporter reporter_;
    const TreeFiles files_;
    Cache cache_;
    std::vector<std::atomic<ExitCode>> failed_;  // how, or ExitCode::done
    std::vector<std::atomic<bool>> stale_;       // in a dry run
    std::vector<BuildResult> results_;
    std::shared_ptr<SharedMaps> shared_;      // of the recipes in shares_
    std::vector<bool> shares_;                // whether files of the recipe are read for several textures
    std::atomic<bool> is_full_{false};        // no space is left for outputs,
    std::atomic<bool> cache_is_full_{false};  // or for entries of the cache
    BuildTotals totals_;
    RepeatedWarnings repeated_;  // of outputs that stand
    bool lost_names_ = false;    // outputs were removed from the state
    std::atomic<std::size_t> finished_{0};
    std::atomic<double> done_bytes_{0.0};
    double all_bytes_ = 1.0;
    std::atomic<std::int64_t> texels_{0};
    std::mutex throwing_;
    std::mutex saving_;
    std::chrono::steady_clock::time_point next_save_ = std::chrono::steady_clock::now() + std::chrono::seconds(1);
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
    std::exception_ptr thrown_;
};

}  // namespace tex::cli
