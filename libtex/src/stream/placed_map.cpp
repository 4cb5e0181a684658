// SPDX-License-Identifier: Apache-2.0

#include "stream/placed_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tex/mip.h>

namespace tex::inline v1 {

int levels_needed(const MipChain& chain, const UvMap& map) {
    const Extent extent = chain.levels.front().extent();
    if (chain.levels.size() > 1) return 1;
    return std::min(level_count(extent), static_cast<int>(std::ceil(level_wanted(map, extent))) + 1);
}

PlacedMap placed_on(const MipChain& chain, const UvMap& map, Wrap wrap_x, Wrap wrap_y) {
    const Extent extent = chain.levels.front().extent();
    const double level = std::min(level_wanted(map, extent), static_cast<double>(chain.levels.size() - 1));
    PlacedMap placed{&chain, {}, extent, map, wrap_x, wrap_y};
    placed.level = static_cast<std::size_t>(level);
    placed.mix = static_cast<float>(level - std::floor(level));
    return placed;
}

Result<PlacedMap> place_chain(MipChain& chain, const UvMap& map, Wrap wrap_x, Wrap wrap_y, const Execution& execution) {
    if (const int levels = levels_needed(chain, map); levels > 1) {
        MipOptions options;
        options.levels = levels;
        options.wrap_x = wrap_x;
        options.wrap_y = wrap_y;
        const Execution silent = execution.quiet();
        Result<MipChain> built = build_mip_chain(std::move(chain.levels.front()), options, silent);
        if (!built) return built.error();
        chain = std::move(*built);
    }
    return placed_on(chain, map, wrap_x, wrap_y);
}

}  // namespace tex::inline v1
