// SPDX-License-Identifier: Apache-2.0

#include <tex/blend.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fields/blend_fields.h"
#include "fields/field_check.h"
#include "kernels/scale.h"
#include "rows/usable.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

Result<void> scale_rows(NormalMap& map, float scale, ScaleMode mode, const Execution& execution, ProgressSpan span) {
    const Extent extent = map.extent();
    const int grain = std::max(1, (1 << 16) / extent.width);
    return parallel_for(
        execution, extent.height, grain,
        [&](int begin, int end) {
            for (int j = begin; j < end; ++j) {
                const NormalRow row{map.x.row(j), map.y.row(j), map.z.row(j)};
                scale_row(row, scale, mode, extent.width, row);
            }
        },
        span);
}

Result<void> check_scale(float scale, ScaleMode mode) { return check_fields(Scaling{scale, mode}); }

}  // namespace

Result<NormalMap> scale(NormalMap map, float scale, ScaleMode mode, const Execution& execution) {
    return no_throw(execution, [&]() -> Result<NormalMap> {
        if (auto usable = check_usable(map); !usable) return usable.error();
        if (auto valid = check_scale(scale, mode); !valid) return valid.error();
        if (const auto scaled = scale_rows(map, scale, mode, execution, {}); !scaled) return scaled.error();
        return std::move(map);
    });
}

Result<MipChain> scale(MipChain chain, float scale, ScaleMode mode, const Execution& execution) {
    return no_throw(execution, [&]() -> Result<MipChain> {
        if (auto usable = check_usable(chain); !usable) return usable.error();
        if (auto valid = check_scale(scale, mode); !valid) return valid.error();
        double texels = 0.0;
        for (const NormalMap& level : chain.levels) texels += static_cast<double>(level.extent().texels());
        double done = 0.0;
        for (NormalMap& level : chain.levels) {
            const double next = std::min(1.0, done + static_cast<double>(level.extent().texels()) / texels);
            if (const auto scaled = scale_rows(level, scale, mode, execution, {done, next}); !scaled)
                return scaled.error();
            done = next;
        }
        return std::move(chain);
    });
}

}  // namespace tex::inline v1
