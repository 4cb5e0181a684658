// SPDX-License-Identifier: Apache-2.0
// text_file.h: the small files that steer a command: lists, configurations, baselines.

#pragma once

#include <string>

#include <tex/result.h>

namespace tex::cli {

// The bytes of a file; "-" is standard input. Errors: io.
[[nodiscard]] Result<std::string> read_text_file(const std::string& path);

}  // namespace tex::cli
