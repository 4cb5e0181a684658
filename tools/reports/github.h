// SPDX-License-Identifier: Apache-2.0
// github.h: check reports as the workflow commands of GitHub Actions, which become annotations of the files.

#pragma once

#include <string>

#include <tex/check.h>

namespace tex::cli {

// One line for each finding: "::error file=maps/a.dds,title=N401 wrong-y::Green points ...".
// https://docs.github.com/en/actions/reference/workflows-and-actions/workflow-commands
[[nodiscard]] std::string github_text(const CheckReport& report, const Requirements& require);

}  // namespace tex::cli
