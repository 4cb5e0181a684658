// SPDX-License-Identifier: Apache-2.0

#include <tex/tex.h>

#include "formats/exr/exr.h"
#include "formats/png/png.h"
#include "kernels/target.h"

namespace tex {

const char* version() { return TEX_VERSION; }

Runtime runtime() {
    return {kernel_target_name(),
            {{"highway", highway_version()},
             {"libdeflate", inflater_version()},
             {"libpng", png_version()},
             {"opencolorio", opencolorio_version()},
             {"openexr", exr_version()}}};
}

}  // namespace tex
