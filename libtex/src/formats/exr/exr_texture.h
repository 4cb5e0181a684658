// SPDX-License-Identifier: Apache-2.0
// exr_texture.h: an EXR file as a texture of normals, as far as its header describes it.

#pragma once

#include <string>
#include <vector>

#include <ImfHeader.h>

#include <tex/format.h>
#include <tex/types.h>

#include "formats/exr/exr_part.h"

namespace tex::inline v1 {

struct ExrTexture {
    std::vector<ExrChannel> channels;  // in the order of the texture
    Texture head;                      // the texture without its levels
    int levels = 1;                    // number of levels that follow the rule of level_extent()
};

// The channels are those of normal_channels() (rows/channel_names.h) among `all`, channels of the part. Errors:
// unsupported (several channels, and their names do not say what they hold). May throw std::bad_alloc.
Result<ExrTexture> exr_texture_of(const std::string& path, const Imf::Header& header, Extent base,
                                  const std::vector<ExrChannel>& all);

}  // namespace tex::inline v1
