// SPDX-License-Identifier: Apache-2.0
// explain.h: what a manifest says about one file.

#pragma once

#include <string>
#include <vector>

#include "tree/recipe.h"
#include "tree/work.h"

namespace tex::cli {

// The rule for `file`, an input or an output relative to the root: every setting as the run uses it, where it comes
// from, and the command lines that do the same; and the rules that read it for other textures. Throws UsageError if no
// rule makes or reads
// it.
[[nodiscard]] std::string explanation_of(const std::string& file, const std::vector<Recipe>& recipes,
                                         const WorkList& work, Console& console);

}  // namespace tex::cli
