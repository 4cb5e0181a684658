// SPDX-License-Identifier: Apache-2.0
// merge.h: checks what the shards of a farm have made, and finds the shards to send again.

#pragma once

#include <string>
#include <vector>

#include "tree/builder.h"
#include "tree/farm_plan.h"
#include "tree/recipe.h"

namespace tex::cli {

// Reads the reports, compares them with the recipes, with each other and with the outputs on disk, and records in the
// state file what is complete. Prints the numbers of the shards to send again ("3,7") on standard output, or, with
// `json`, a line for each texture that is not made and one for all. Returns ExitCode::done if everything is made;
// otherwise findings, or data if sending shards again is not enough. Throws UsageError if the reports are of different
// numbers of shards.
[[nodiscard]] ExitCode merge_reports(const FarmPlan& plan, const std::vector<Recipe>& recipes,
                                     const std::vector<std::string>& reports, const BuildOptions& options,
                                     const RunOptions& running, Console& console);

}  // namespace tex::cli
