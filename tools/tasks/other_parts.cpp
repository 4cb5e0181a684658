// SPDX-License-Identifier: Apache-2.0

#include "tasks/other_parts.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>

#include "files/path_names.h"

namespace tex::cli {

std::vector<std::string> other_parts(const std::string& name, const std::string& path) {
    namespace fs = std::filesystem;
    constexpr const char* kExtensions[] = {".bil", ".bip", ".bsq", ".flt"};
    std::string extension = slashed(fs::path(name).extension());
    for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
    if (std::find(std::begin(kExtensions), std::end(kExtensions), extension) == std::end(kExtensions)) return {};
    for (const char* header : {".hdr", ".HDR"}) {  // as the reader looks for it
        std::error_code error;
        if (fs::exists(fs::path(path).replace_extension(header), error))
            return {slashed(fs::path(name).replace_extension(header))};
    }
    return {};
}

}  // namespace tex::cli
