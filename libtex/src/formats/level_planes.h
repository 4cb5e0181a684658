// SPDX-License-Identifier: Apache-2.0
// level_planes.h: decodes a level of a texture into planes, on several threads.

#pragma once

#include <functional>

#include <tex/format.h>
#include <tex/types.h>

namespace tex::inline v1 {

// What must be decoded. A plane that need not be decoded has one row in memory, which all of its rows share (stride 0).
// It must not be written to.
struct PlaneNeeds {
    unsigned channels = 0xF;  // bit c is set if channel c is needed; the other planes are 0
    // Whether one of the rows first to first + count - 1 is needed; null if all are. Other rows may be unset.
    std::function<bool(int first, int count)> rows;
    // Whether R, G and B of BC2 and BC3 share one row if they have one value in all texels, as R and B of DXT5nm do.
    bool share_constants = false;
};

// The values are those of decode() in pack.h. Errors: out_of_memory, cancelled.
Result<Image> decode_planes(const Texture& texture, const Level& level, const PlaneNeeds& needs,
                            const Execution& execution);

}  // namespace tex::inline v1
