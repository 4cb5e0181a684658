// SPDX-License-Identifier: Apache-2.0
// fixes.h: what to do about a finding.

#pragma once

#include <string>

#include <tex/check.h>

namespace tex::cli {

struct Fix {
    std::string text;  // a command or a sentence; empty if there is neither
    bool is_command = false;
    std::string advice = {};  // beside a command: what it depends on, and the command to take otherwise; may be empty
};

// The command that fixes the finding in this file and keeps everything else: the container, the bits of each sample,
// the levels. Findings that one command can fix together get that same command. If no command can do it, a sentence.
[[nodiscard]] Fix fix_of(const Finding& finding, const CheckReport& report, const Requirements& require);

}  // namespace tex::cli
