// SPDX-License-Identifier: Apache-2.0
// builder.h: brings the outputs of a manifest up to date.

#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "options/run.h"
#include "tree/build_result.h"
#include "tree/recipe.h"
#include "tree/state.h"
#include "tree/tree_files.h"
#include "tree/work.h"

namespace tex::cli {

struct BuildOptions {
    std::string root;      // empty: the working directory
    std::string manifest;  // its file
    std::string state_file;
    bool is_shard = false;        // state_file is read and not written, because other shards share it,
    std::string shard_state;      // but this file is, until the shard ends, so that it can go on; empty: none
    std::string depfile;          // empty: none
    RunDocuments documents;       // what else is read and written
    int output_version = 1;       // part of every key
    std::int64_t memory = 0;      // bytes that all files together may take; 0: half of the machine's
    std::string cache;            // a folder; empty: none
    std::int64_t cache_size = 0;  // bytes; 0: no limit
    bool dry_run = false;
    bool prune = false;
    bool no_sync = false;
    bool is_part = false;  // the work is a part of the tree: nothing is pruned, and what is known about the rest stays
    bool lists_made = false;  // prints a line for each output that is made
    // Called at the end of a run that was not interrupted, with a result for each task.
    std::function<ExitCode(const std::vector<BuildResult>& results, const BuildState& state)> finished = {};
};

// The version of the bytes that this program makes. It changes when an output changes with the same settings.
inline constexpr int kOutputVersion = 2;

// Makes what is not up to date. Prints a summary; with --json, also a line for each texture as soon as it is done.
// Throws UsageError, and writes nothing, if a file that is written is also read, or is written twice.
[[nodiscard]] ExitCode build(const std::vector<Recipe>& recipes, const WorkList& work, const BuildOptions& options,
                             const RunOptions& running, Console& console);

}  // namespace tex::cli
