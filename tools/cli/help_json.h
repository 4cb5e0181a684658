// SPDX-License-Identifier: Apache-2.0
// help_json.h: the description of a command as data, made from its table.

#pragma once

#include <string>

#include "cli/command.h"

namespace tex::cli {

// --help --json: one line, as normal-maps(7) describes it. Calls Option::take of options, so the command's targets mean
// nothing afterwards.
[[nodiscard]] std::string help_json(const Command& command);

}  // namespace tex::cli
