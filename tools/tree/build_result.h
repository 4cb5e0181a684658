// SPDX-License-Identifier: Apache-2.0
// build_result.h: what became of one texture in a run of build().

#pragma once

#include <optional>
#include <string>

#include <tex/types.h>

namespace tex::cli {

struct BuildResult {
    std::string status;  // as in the JSON report, or "failed"; empty: the run has not come to it
    std::optional<Error> error;
    float seconds = 0.0f;
};

}  // namespace tex::cli
