// SPDX-License-Identifier: Apache-2.0
// exr_texture.h: an EXR file as a texture of normals, as far as its header describes it.

#pragma once

#include <string>
#include <vector>

#include <ImfHeader.h>

#include <tex/result.h>
#include <tex/texture.h>

#include "formats/exr/exr_part.h"

namespace tex {

struct ExrTexture {
    std::vector<ExrChannel> channels;  // R, G, B (and A) if they are present, otherwise all channels
    Texture head;                      // the texture without its levels
    int levels = 1;                    // number of levels that follow the rule of level_extent()
};

// Errors: unsupported (more than four channels, and R, G or B is missing). May throw std::bad_alloc.
Result<ExrTexture> exr_texture_of(const std::string& path, const Imf::Header& header, Extent base);

}  // namespace tex
