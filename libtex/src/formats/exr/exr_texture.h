// SPDX-License-Identifier: Apache-2.0
// exr_texture.h: an EXR as a texture of normals, as far as its header tells.

#pragma once

#include <string>
#include <vector>

#include <ImfHeader.h>

#include <tex/result.h>
#include <tex/texture.h>

#include "formats/exr/exr_part.h"

namespace tex {

struct ExrTexture {
    std::vector<ExrChannel> channels;  // colour where there is colour, else everything
    Texture head;                      // all but its levels
    int levels = 1;                    // that follow the rule of level_extent()
};

// Errors: unsupported (more than four channels, and not R, G and B among them). May throw std::bad_alloc.
Result<ExrTexture> exr_texture_of(const std::string& path, const Imf::Header& header, Extent base);

}  // namespace tex
