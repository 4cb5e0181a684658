// SPDX-License-Identifier: Apache-2.0
// channel_order.h: finds whether x or y comes first in BC5, from the texels.

#pragma once

#include <optional>
#include <vector>

#include <tex/format.h>
#include <tex/types.h>

#include "checks/stored.h"

namespace tex::inline v1 {

// Slopes of a surface have no curl if x and y are in their places (see curl.h). What N308 says of maps, this says of
// BC5 files that leave the order open. Looks at parts of a map, at most 2^20 texels.
class ChannelOrder {
public:
    explicit ChannelOrder(Extent extent);

    // Takes row j of red and green, as unorm values. Rows come in any order, each once.
    void add_row(int j, const float* red, const float* green);
    // kSwizzleXy or kSwizzleYx; none if the rows do not show it clearly. Call it once, after the last row.
    [[nodiscard]] std::optional<Swizzle> shown();

private:
    const Extent extent_;
    std::vector<Rect> windows_;  // none: the map is too small to show anything
    std::vector<Slopes> slopes_;
};

// The order that the base level of a BC5 texture shows. Errors: as decode().
Result<std::optional<Swizzle>> shown_order(const Texture& texture, const Execution& execution);
std::optional<Swizzle> shown_order(const Image& base);

// Whether the layout is to be told from texels, and, if so, what guess_swizzle() finds. `base`: the decoded base level.
bool needs_texels_for_layout(const Texture& texture);
Swizzle layout_shown(const Texture& texture, const Image& base);

}  // namespace tex::inline v1
