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
//     [[rule]]                         # adds to the above for the files that it matches; the first rule that does wins
//     match   = "ui/**"
//     exclude = "ui/old/**"
//     disable = ["N307"]
//
// Options of the command line add to the file and override it.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tex/check.h>

#include "cli/glob.h"

namespace tex::cli {

// add_requirement() with common_word() for the value: "y=OpenGL". Errors: bad_option.
[[nodiscard]] Result<void> add_common_requirement(Requirements& requirements, const std::string& text);

struct CheckSettings {
    CheckOptions options;
    std::optional<Severity> fail_on;
};

// What is demanded of the files that match.
struct CheckRule {
    std::vector<Glob> match, exclude;  // of paths relative to the folder of the configuration
    CheckSettings settings;            // with those of the top level
    int line = 0;                      // in the configuration

    [[nodiscard]] bool takes(const std::string& path) const;
};

struct CheckConfig {
    CheckSettings settings;  // of files that no rule matches
    std::vector<CheckRule> rules;
};

// Throws UsageError if the file names something that does not exist; the message has the place. Errors:
// io.
[[nodiscard]] Result<CheckConfig> read_check_config(const std::string& path);

// Parses a configuration in memory. `path` appears in messages.
[[nodiscard]] CheckConfig parse_check_config(const std::string& path, const std::string& text);

}  // namespace tex::cli
