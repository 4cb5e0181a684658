// SPDX-License-Identifier: Apache-2.0
// sarif.h: check reports as SARIF 2.1.0 (OASIS 2020), which GitHub and others turn into annotations.

#pragma once

#include <string>
#include <vector>

#include "reports/junit.h"

namespace tex::cli {

// One run of check-normals. The rules' metadata come from rules(). Files that could not be opened become notifications
// of the invocation. No time, host or absolute path is added.
[[nodiscard]] std::string sarif_text(const std::vector<JudgedReport>& reports);

}  // namespace tex::cli
