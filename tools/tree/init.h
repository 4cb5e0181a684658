// SPDX-License-Identifier: Apache-2.0
// init.h: build-normals --init: a manifest and a baseline for a tree that has none.

#pragma once

#include <string>

#include "cli/console.h"
#include "cli/exit_code.h"
#include "options/run.h"

namespace tex::cli {

// Reads every picture below `root` (empty: the working directory), writes `manifest` with rules that agree with what
// the pictures hold, and beside it a baseline for check-normals with today's findings about normal maps. Neither file
// may exist, and neither is written if no rule would be for any picture. Prints what was found.
[[nodiscard]] ExitCode init_tree(const std::string& root, const std::string& manifest, const RunOptions& running,
                                 Console& console);

}  // namespace tex::cli
