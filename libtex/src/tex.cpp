// SPDX-License-Identifier: Apache-2.0

#include <tex/tex.h>

#include <vector>

#include "formats/exr/exr.h"
#include "formats/ktx2/compress_ktx2.h"
#include "formats/png/png.h"
#include "formats/png/png_texels.h"
#include "kernels/target.h"

namespace tex::inline v1 {

const char* version() { return TEX_VERSION; }

Runtime runtime() {
    Runtime runs{kernel_target_name(),
                 {{"highway", highway_version()},
                  {"libdeflate", inflater_version()},
                  {"libisal", png_inflater_version()},
                  {"libpng", png_version()},
                  {"libzstd", zstd_version()},
                  {"opencolorio", opencolorio_version()},
                  {"openexr", exr_version()}}};
    std::erase_if(runs.dependencies, [](const auto& library) { return library.second.empty(); });
    return runs;
}

}  // namespace tex::inline v1
