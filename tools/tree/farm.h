// SPDX-License-Identifier: Apache-2.0
// farm.h: the options of build-normals that spread a build over the machines of a farm: a plan, shards of it, and what
// they report.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "tree/builder.h"
#include "tree/farm_plan.h"

namespace tex::cli {

class Farm {
public:
    void add(Command& command);

    [[nodiscard]] bool is_used() const { return !plan_path_.empty(); }
    [[nodiscard]] bool merges() const { return merges_; }
    // With --shard and --merge: reads the plan. Throws UsageError. Errors: io.
    [[nodiscard]] Result<void> read_plan();
    // The manifest and the root, unless the command line names others. Precondition: read_plan().
    [[nodiscard]] const std::optional<FarmPlan>& plan() const { return plan_; }
    // Throws a UsageError if the plan was made for another manifest or makes other bytes.
    void check_fits(const std::string& manifest, const std::string& text, const BuildOptions& options,
                    Console& console) const;

    // What is asked for. `work` is what the manifest makes; for a shard, what the plan holds. Each throws UsageError,
    // and writes nothing, if a file that is written is also read, or is written twice.
    [[nodiscard]] ExitCode write_plan(const FarmPlan& head, const std::vector<Recipe>& recipes, const WorkList& work,
                                      const BuildOptions& options, const RunOptions& running, Console& console) const;
    [[nodiscard]] ExitCode run_shard(const std::vector<Recipe>& recipes, BuildOptions options,
                                     const RunOptions& running, Console& console) const;
    [[nodiscard]] ExitCode merge(const std::vector<Recipe>& recipes, const std::vector<std::string>& reports,
                                 const BuildOptions& options, const RunOptions& running, Console& console) const;

private:
    void parse_shard(const std::string& text);
    void check_names(const std::vector<Recipe>& recipes, std::size_t index) const;
    [[nodiscard]] WorkList work_of_shard(const std::vector<Recipe>& recipes, const std::string& root,
                                         Console& console) const;

    std::string plan_path_;
    std::string report_;
    int shard_ = 0;  // from 1; 0: none
    int shards_ = 0;
    bool merges_ = false;
    std::optional<FarmPlan> plan_;
};

}  // namespace tex::cli
