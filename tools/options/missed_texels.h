// SPDX-License-Identifier: Apache-2.0
// missed_texels.h: pictures of the texels that rays have missed.

#pragma once

#include <tex/transfer.h>
#include <tex/types.h>

namespace tex::cli {

// Missed texels are red, those that were hit grey, and all others black. If a side of the map is longer than `side`,
// pixels stand for several texels, and show missed ones first, then hit ones. The planes are R, G and B.
[[nodiscard]] Image missed_picture(const Plane<TexelOrigin>& origin, int side);

// A picture with missed texels white and all others black.
[[nodiscard]] Image missed_mask(const Plane<TexelOrigin>& origin, int side);

}  // namespace tex::cli
