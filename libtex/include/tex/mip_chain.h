// SPDX-License-Identifier: Apache-2.0
// mip_chain.h: a normal map and its smaller levels.

#pragma once

#include <algorithm>
#include <vector>

#include <tex/normal_map.h>

#pragma GCC visibility push(default)
namespace tex {

// levels[0] is the base level. Level k + 1 has max(1, floor(w / 2)) by max(1, floor(h / 2)) texels, as OpenGL, Vulkan
// and Direct3D require. A chain is complete if its last level is 1x1; it need not be complete.
struct MipChain {
    std::vector<NormalMap> levels;
};

// The extent of level `level` (0 is the base level) of a texture of extent `base`.
[[nodiscard]] constexpr Extent level_extent(Extent base, int level) {
    for (int k = 0; k < level && (base.width > 1 || base.height > 1); ++k) {
        base = {std::max(1, base.width / 2), std::max(1, base.height / 2)};
    }
    return base;
}

// The number of levels of a complete chain: 1 + floor(log2(max(w, h))); 1 for 1x1, 13 for 4096x4096.
[[nodiscard]] constexpr int level_count(Extent base) {
    int count = 1;
    for (int n = std::max(base.width, base.height); n > 1; n /= 2) ++count;
    return count;
}

}  // namespace tex
#pragma GCC visibility pop
