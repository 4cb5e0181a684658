// SPDX-License-Identifier: Apache-2.0

#include "stream/placed_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tex/mip.h>

namespace tex {

Result<PlacedMap> place_chain(MipChain& chain, const UvMap& map, Wrap wrap_x, Wrap wrap_y, const Execution& execution) {
    const Extent extent = chain.levels.front().extent();
    const double wanted = level_wanted(map, extent);
    const int levels = std::min(level_count(extent), static_cast<int>(std::ceil(wanted)) + 1);
    if (chain.levels.size() == 1 && levels > 1) {
        MipOptions options;
        options.levels = levels;
        options.wrap_x = wrap_x;
        options.wrap_y = wrap_y;
        const Execution silent{execution.threads, {}};
        Result<MipChain> built = build_mip_chain(std::move(chain.levels.front()), options, silent);
        if (!built) return built.error();
        chain = std::move(*built);
    }
    const double level = std::min(wanted, static_cast<double>(chain.levels.size() - 1));
    PlacedMap placed{&chain, {}, extent, map, wrap_x, wrap_y};
    placed.level = static_cast<std::size_t>(level);
    placed.mix = static_cast<float>(level - std::floor(level));
    return placed;
}

}  // namespace tex
