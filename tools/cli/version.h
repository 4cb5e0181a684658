// SPDX-License-Identifier: Apache-2.0
// version.h: what --version says.

#pragma once

#include <string>

#include "cli/command.h"

namespace tex::cli {

// "bake-normals 0.1.0".
[[nodiscard]] std::string version_text(const Command& command);

// One JSON object: versions of the command, of the libtex that runs and of what they are made of, compiler,
// build type.
[[nodiscard]] std::string version_json(const Command& command);

}  // namespace tex::cli
