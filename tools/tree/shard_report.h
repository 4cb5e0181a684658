// SPDX-License-Identifier: Apache-2.0
// shard_report.h: what one shard of a farm has made, for --merge.

#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tree/build_result.h"
#include "tree/farm_plan.h"
#include "tree/state.h"

namespace tex::cli {

// One texture in a report.
struct ShardRecord {
    std::string input;
    bool is_made = false;
    bool may_succeed = false;  // it was not made, for want of a disk, memory ...; another try may make it
    std::string reason;        // why it was not made
    std::vector<std::pair<std::string, OutputRecord>> outputs;  // by name, as in BuildState
};

struct ShardReport {
    Digest plan;
    int shard = 1;  // from 1 to `shards`
    int shards = 1;
    std::vector<ShardRecord> records;
};

// The report of the shard `shard` of `shards`, for the textures of `work` that have a result.
[[nodiscard]] std::string shard_report_text(const FarmPlan& plan, int shard, int shards, const WorkList& work,
                                            const std::vector<BuildResult>& results, const BuildState& state);

// Throws a UsageError: "PATH: line L: REASON".
[[nodiscard]] ShardReport parse_shard_report(const std::string& path, std::string_view text);

}  // namespace tex::cli
