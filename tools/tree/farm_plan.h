// SPDX-License-Identifier: Apache-2.0
// farm_plan.h: the textures of a manifest with their costs, in a file from which each machine of a farm takes its
// share.
//
// The first line describes the plan; each of the others is a texture, sorted by input. The plan depends on the manifest
// and the inputs alone: no time, no host.

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "options/run.h"
#include "tree/deal.h"
#include "tree/sha256.h"
#include "tree/work.h"

namespace tex::cli {

inline constexpr int kMostShards = 1 << 20;

struct FarmPlan {
    std::string path;      // of the plan, for messages
    std::string manifest;  // its path, as it was given when the plan was made
    std::string root;      // as --root gave it; empty: the folder of the manifest
    std::string tool;      // the version of the program
    int output_version = 1;
    Digest manifest_digest;
    Digest digest;  // of a plan that was read
    std::vector<BuildTask> tasks;
    std::vector<std::int64_t> costs;  // of each task: the texels of the input, once for each output

    [[nodiscard]] std::string text() const;
    // The tasks of each shard.
    [[nodiscard]] std::vector<std::vector<std::size_t>> dealt(int shards) const;
};

// Reads the extents of all inputs. Paths of tasks are relative to `folder`.
[[nodiscard]] std::vector<std::int64_t> costs_of(const std::vector<BuildTask>& tasks, const std::string& folder,
                                                 const RunOptions& running);

// Throws a UsageError: "PATH: line L: REASON".
[[nodiscard]] FarmPlan parse_farm_plan(const std::string& path, std::string_view text);

}  // namespace tex::cli
