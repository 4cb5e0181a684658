// SPDX-License-Identifier: Apache-2.0
// Handles memory and threads: strips of rows run in parallel. rows/blend_rows.cpp samples and blends.

#include <tex/blend.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fields/blend_fields.h"
#include "fields/field_check.h"
#include "rows/blend_rows.h"
#include "rows/extra_rows.h"
#include "rows/usable.h"
#include "stream/placed_map.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

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
    const ExtraSet beside = extras_of(base.levels.front());
    add_planes(result, beside);
    const int grain = std::max(1, (1 << 15) / extent.width);
    const auto blended = parallel_for(execution, extent.height, grain, [&](int begin, int end) {
        BlendRows rows(maps);
        for (int j = begin; j < end; ++j) {
            rows.make(j, {result.x.row(j), result.y.row(j), result.z.row(j)});
            for (const Extra extra : kExtras) {
                if (beside[extra]) rows.make_extra(extra, nullptr, result[extra].row(j));
            }
        }
    });
    if (!blended) return blended.error();
    return result;
}

}  // namespace

Result<void> validate(const BlendOptions& options) {
    if (auto valid = check_fields(options); !valid) return valid;
    return options.extent == Extent{} ? Result<void>() : check_usable(options.extent, "extent");
}

Result<void> validate(const Layer& layer) { return check_fields(layer); }

Result<NormalMap> blend(MipChain base, std::vector<Layer> layers, const BlendOptions& options,
                        const Execution& execution) {
    return no_throw(execution, [&]() -> Result<NormalMap> {
        if (auto usable = check_usable(base); !usable) return usable.error();
        if (auto valid = validate(options); !valid) return valid.error();
        for (const Layer& layer : layers) {
            if (auto usable = check_usable(layer.detail); !usable) return usable.error();
            if (auto valid = validate(layer); !valid) return valid.error();
        }
        return blend_layers(base, layers, options, execution);
    });
}

}  // namespace tex::inline v1
