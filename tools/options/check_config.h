// SPDX-License-Identifier: Apache-2.0
// check_config.h: a project's requirements for its textures, in a TOML file.
//
//     require = ["format=dxt5nm", "mips=full", "y=up"]
//     enable  = ["not-power-of-two"]
//     disable = ["N208"]
//     fail-on = "warning"
//
//     [severity]
//     not-unit-length = "error"
//
// Options of the command line add to the file and override it.

#pragma once

#include <optional>
#include <string>

#include <tex/check.h>

namespace tex::cli {

struct CheckConfig {
    CheckOptions options;
    std::optional<Severity> fail_on;
};

// Throws UsageError if the file names something that does not exist; the message has the line if it is known. Errors:
// io.
[[nodiscard]] Result<CheckConfig> read_check_config(const std::string& path);

// The same from memory. `path` appears in messages.
[[nodiscard]] CheckConfig parse_check_config(const std::string& path, const std::string& text);

}  // namespace tex::cli
