// SPDX-License-Identifier: Apache-2.0
// version.h: the text that --version prints.

#pragma once

#include <string>

#include "cli/command.h"

namespace tex::cli {

// "bake-normals 1.0.0".
[[nodiscard]] std::string version_text(const Command& command);

// One JSON object: the versions of the command, of the libtex that it runs with and of the libraries that they are
// built from, the compiler, the build type.
[[nodiscard]] std::string version_json(const Command& command);

}  // namespace tex::cli
