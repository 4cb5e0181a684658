// SPDX-License-Identifier: Apache-2.0
// filled_map.h: a map whose background takes the normals of the charts beside it, as bakers do with "infinite padding".
// That reaches over all rows, so the map is read to its end: see filled() in map_source.h.

#pragma once

#include <tex/file.h>
#include <tex/types.h>

#include "formats/texture_rows.h"

namespace tex::inline v1 {

// The channels of the base level, as decode() makes them. Where find_background() finds background, or texels mixed
// with it, x, y and z become those of the nearest other texel. A map without background stays as it is, and gets a
// remark. Errors: those of decode() and find_background().
Result<Image> decode_filled(Texture& texture, const Swizzle& swizzle, const SourceOptions& options,
                            const Execution& execution);

}  // namespace tex::inline v1
