// SPDX-License-Identifier: Apache-2.0

#include "color/ocio.h"

namespace tex::inline v1 {
namespace {

Error no_ocio(const std::string& file) {
    return {ErrorCode::unsupported, file,
            "needs OpenColorIO; this libtex was built without it (TEX_OCIO=OFF) and knows sRGB and linear alone"};
}

}  // namespace

const char* ocio_version() { return ""; }

Result<ConvertRow> by_config(const std::string& file, const std::string&) { return no_ocio(file); }

Result<std::vector<std::string>> files_of_config(const std::string& file, const std::string&) { return no_ocio(file); }

}  // namespace tex::inline v1
