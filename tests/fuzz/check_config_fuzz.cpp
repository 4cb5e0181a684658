// SPDX-License-Identifier: Apache-2.0
// The settings of check-normals, of any text, are read or refused with a usage error of one line.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "cli/usage_error.h"
#include "options/check_config.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const tex::cli::CheckConfig config =
            tex::cli::parse_check_config("checks.toml", {reinterpret_cast<const char*>(data), size});
        for (const auto& [rule, severity] : config.settings.options.severity) {
            if (tex::find_rule(rule) == nullptr) std::abort();
        }
    } catch (const tex::cli::UsageError& error) {
        const std::string text = error.what();
        if (!text.starts_with("checks.toml: ") || text.find('\n') != std::string::npos) std::abort();
    }
    return 0;
}
