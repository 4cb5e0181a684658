// SPDX-License-Identifier: Apache-2.0
// help.h: the description of a command, made from its table.

#pragma once

#include <string>

#include "cli/command.h"

namespace tex::cli {

// --help: usage, options by group with their defaults, examples, exit status; 80 columns.
[[nodiscard]] std::string help_text(const Command& command);

// -h: one screen, at most 24 lines of 80 columns. The eight options that most people use, and three examples.
[[nodiscard]] std::string brief_help_text(const Command& command);

// --list-options: a line for each option that the help shows, with names, value, default and words separated by tabs.
// The test that compares the man pages with the options reads it.
[[nodiscard]] std::string option_list(const Command& command);

}  // namespace tex::cli
