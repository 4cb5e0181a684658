// SPDX-License-Identifier: Apache-2.0
// watch.h: keeps a tree of textures up to date while people work on it.

#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <tex/types.h>

#include "tree/builder.h"
#include "tree/manifest.h"
#include "tree/recipe.h"
#include "tree/work.h"

namespace tex::cli {

// A manifest and what it makes. The recipes refer to the manifest, so a tree stays where it is.
struct BuildTree {
    std::string text;  // of the manifest
    Manifest manifest;
    ProgramPool pool;
    std::vector<Recipe> recipes;
    WorkList work;
};

// Reads the manifest and lists the work. Calls its argument with each folder before it reads that. Throws UsageError.
using LoadTree = std::function<Result<std::unique_ptr<BuildTree>>(const FolderVisitor& entered)>;

// Builds, and builds again what is saved, until the host interrupts the run. `options` are read after each call of
// `load`, which may set them. A manifest with a mistake is reported, and read again when it is saved.
[[nodiscard]] ExitCode watch(const std::string& manifest, const LoadTree& load, const BuildOptions& options,
                             const RunOptions& running, Console& console);

}  // namespace tex::cli
