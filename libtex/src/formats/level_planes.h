// SPDX-License-Identifier: Apache-2.0
// level_planes.h: decodes a level of a texture into planes, on several threads.

#pragma once

#include <functional>

#include <tex/execution.h>
#include <tex/image.h>
#include <tex/result.h>
#include <tex/texture.h>

namespace tex {

// What to leave out. Planes that are left out exist, but have one row in memory, which is that of all rows of texels
// (stride 0), so they must not be written to.
struct PlaneNeeds {
    unsigned channels = 0xF;  // bit c is set if channel c is needed; the others are left out, and are 0
    // Whether one of the rows first to first + count - 1 is needed; null if all are. Other rows may be unset.
    std::function<bool(int first, int count)> rows;
    // Leaves out the colours of BC2 and BC3 that have one value in all texels, such as R and B of DXT5nm. The value of
    // the plane is right.
    bool share_constants = false;
};

// The values are those of decode() in unpack.h. Errors: out_of_memory, cancelled.
Result<Image> decode_planes(const Texture& texture, const Level& level, const PlaneNeeds& needs,
                            const Execution& execution);

}  // namespace tex
