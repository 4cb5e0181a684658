// SPDX-License-Identifier: Apache-2.0
// Handles memory and threads: strips of rows run in parallel. rows/blend_rows.cpp samples and blends.

#include <tex/blend.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "rows/blend_rows.h"
#include "stream/placed_map.h"
#include "threads/guard.h"
#include "threads/parallel.h"

namespace tex {
namespace {

[[maybe_unused]] bool in_range(const Layer& layer) {
    const auto tiling = [](float t) { return t > 0.0f && t <= kMaxTiling; };
    const auto offset = [](float o) { return std::abs(o) <= kMaxTiling; };
    return !layer.detail.levels.empty() && std::abs(layer.scale) <= kMaxScale && tiling(layer.tiling_x) &&
           tiling(layer.tiling_y) && offset(layer.offset_x) && offset(layer.offset_y) &&
           std::isfinite(layer.rotation) && layer.strength >= 0.0f && layer.strength <= 1.0f;
}

Result<NormalMap> blend_layers(MipChain& base, std::vector<Layer>& layers, const BlendOptions& options,
                               const Execution& execution) {
    const Extent extent = options.extent == Extent{} ? base.levels.front().extent() : options.extent;
    PlacedMaps maps{{}, {}, options, extent};
    Result<PlacedMap> placed = place_chain(base, stretch(extent), options.wrap_x, options.wrap_y, execution);
    if (!placed) return placed.error();
    maps.base = *placed;
    for (Layer& layer : layers) {
        Result<PlacedMap> detail =
            place_chain(layer.detail, uv_map_of(layer, extent), layer.wrap_x, layer.wrap_y, execution);
        if (!detail) return detail.error();
        maps.layers.push_back({layer, *detail});
    }
    NormalMap result(extent);
    const int grain = std::max(1, (1 << 15) / extent.width);
    const auto blended = parallel_for(execution, extent.height, grain, [&](int begin, int end) {
        BlendRows rows(maps);
        for (int j = begin; j < end; ++j) rows.make(j, {result.x.row(j), result.y.row(j), result.z.row(j)});
    });
    if (!blended) return blended.error();
    return result;
}

}  // namespace

Result<NormalMap> blend(MipChain base, std::vector<Layer> layers, const BlendOptions& options,
                        const Execution& execution) {
    assert(!base.levels.empty() && std::abs(options.base_scale) <= kMaxScale);
    assert(std::all_of(layers.begin(), layers.end(), in_range));
    return guarded([&] { return blend_layers(base, layers, options, execution); });
}

}  // namespace tex
