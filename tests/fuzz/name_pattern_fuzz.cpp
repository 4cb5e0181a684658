// SPDX-License-Identifier: Apache-2.0
// A pattern of names, of any text, is taken or refused with a usage error; the fields of any path go in whole.
//
// Input: the pattern, a zero byte, a path.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "cli/usage_error.h"
#include "tasks/name_pattern.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    const std::size_t end = text.find('\0');
    const std::string path = end == std::string::npos ? "maps/bricks.png" : text.substr(end + 1);
    tex::cli::NameFields fields = tex::cli::name_fields(path.substr(0, path.find('\0')));
    fields.format = "dxt5nm";
    try {
        const tex::cli::NamePattern pattern(text.substr(0, end));
        const std::string name = pattern.expand(fields);
        if (tex::cli::has_level(name) != pattern.uses("level")) std::abort();
        const bool drops = text.find("{stem:-") != std::string::npos;
        if (pattern.uses("stem") && !drops && name.find(fields.stem) == std::string::npos) std::abort();
        if (tex::cli::has_level(tex::cli::with_level(name, 3))) std::abort();
    } catch (const tex::cli::UsageError& error) {
        if (std::string(error.what()).find('\n') != std::string::npos) std::abort();  // one line, whatever was quoted
    }
    return 0;
}
