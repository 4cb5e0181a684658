// SPDX-License-Identifier: Apache-2.0
// map_tile.h: where a tile of a web map lies, which its path alone says.

#pragma once

#include <optional>
#include <string_view>

#include <tex/types.h>

#include "formats/stored_samples.h"

namespace tex::inline v1 {

// The grid of a tile called Z/X/Y.png, or WebP: column X and row Y of the 2^Z x 2^Z squares into which Web Mercator
// (EPSG:3857) divides the world, row 0 in the north. Servers that count rows from the south (TMS) mirror the latitude,
// which leaves the size of a texel as it is. Nothing if the path is not one, or the picture not as tiles are: square,
// with a power of two of texels.
[[nodiscard]] std::optional<GridPlace> map_tile_place(std::string_view path, Extent extent);

}  // namespace tex::inline v1
