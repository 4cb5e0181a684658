// SPDX-License-Identifier: Apache-2.0
// completion.h: completion scripts for bash, zsh and fish, from a command's table.

#pragma once

#include <string>

#include "cli/command.h"

namespace tex::cli {

// The script for `shell`: bash, zsh or fish.
[[nodiscard]] std::string completion_script(const Command& command, const std::string& shell);

}  // namespace tex::cli
