// SPDX-License-Identifier: Apache-2.0

#include "tasks/other_parts.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "cli/text.h"
#include "files/path_names.h"

namespace tex::cli {

namespace {

// A kind of input, and the files beside it, each under the names by which the reader looks for it: the first one that
// is there counts.
struct Beside {
    std::vector<std::string_view> inputs;
    std::vector<std::vector<const char*>> parts;
};

const std::vector<Beside>& rows() {
    static const std::vector<Beside> kRows = {
        {{".bil", ".bip", ".bsq", ".flt"}, {{".hdr", ".HDR"}, {".prj", ".PRJ"}}},
        {{".asc"}, {{".prj", ".PRJ"}}},
        {{".tif"}, {{".tfw", ".TFW", ".wld"}, {".prj", ".PRJ"}}},
        {{".tiff"}, {{".tfw", ".tifw", ".wld"}, {".prj", ".PRJ"}}},
        {{".png"}, {{".pgw", ".PGW", ".wld"}, {".prj", ".PRJ"}}},
    };
    return kRows;
}

}  // namespace

std::vector<std::string> other_parts(const std::string& name, const std::string& path) {
    namespace fs = std::filesystem;
    const std::string extension = lower_case(slashed(fs::path(name).extension()));
    std::vector<std::string> found;
    for (const Beside& row : rows()) {
        if (std::find(row.inputs.begin(), row.inputs.end(), extension) == row.inputs.end()) continue;
        for (const std::vector<const char*>& names : row.parts) {
            const auto there = std::find_if(names.begin(), names.end(), [&](const char* part) {
                std::error_code error;
                return fs::exists(fs::path(path).replace_extension(part), error);
            });
            if (there != names.end()) found.push_back(slashed(fs::path(name).replace_extension(*there)));
        }
    }
    return found;
}

}  // namespace tex::cli
