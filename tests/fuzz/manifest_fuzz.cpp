// SPDX-License-Identifier: Apache-2.0
// A manifest of any text is read or refused with a usage error of one line. Its patterns match any path without harm.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "cli/glob.h"
#include "cli/usage_error.h"
#include "tree/manifest.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        const tex::cli::Manifest manifest =
            tex::cli::parse_manifest("n.toml", text, {"bake", "blend", "mip", "pack", "preview", "scale", "unpack"});
        if (manifest.rules.empty()) std::abort();
        for (const tex::cli::RuleSettings& rule : manifest.rules) {
            if (rule.match.empty() || rule.steps.empty() || rule.outputs.empty()) std::abort();
            for (const std::string& pattern : rule.match) {
                const tex::cli::Glob glob(pattern);
                static_cast<void>(glob.reaches("art/wall/"));
                // A file that matches is reached.
                if (glob.matches("art/wall/a_h.png") && !glob.reaches("art/wall/")) std::abort();
                static_cast<void>(glob.matches(pattern));
            }
        }
    } catch (const tex::cli::UsageError& error) {
        const std::string message = error.what();
        if (!message.starts_with("n.toml: ") || message.find('\n') != std::string::npos) std::abort();
    }
    return 0;
}
