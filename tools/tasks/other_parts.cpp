// SPDX-License-Identifier: Apache-2.0

#include "tasks/other_parts.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>

#include "cli/text.h"
#include "files/path_names.h"

namespace tex::cli {

std::vector<std::string> other_parts(const std::string& name, const std::string& path) {
    namespace fs = std::filesystem;
    constexpr const char* kExtensions[] = {".bil", ".bip", ".bsq", ".flt"};
    const std::string extension = lower_case(slashed(fs::path(name).extension()));
    if (std::find(std::begin(kExtensions), std::end(kExtensions), extension) == std::end(kExtensions)) return {};
    for (const char* header : {".hdr", ".HDR"}) {  // as the reader looks for it
        std::error_code error;
        if (fs::exists(fs::path(path).replace_extension(header), error))
            return {slashed(fs::path(name).replace_extension(header))};
    }
    return {};
}

}  // namespace tex::cli
