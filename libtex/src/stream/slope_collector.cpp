// SPDX-License-Identifier: Apache-2.0

#include "stream/slope_collector.h"

#include <algorithm>

namespace tex::inline v1 {

void SlopeCollector::add(const NormalMap& map, int begin, int end) {
    SlopeBounds bounds = kNone;
    std::int64_t steep = 0;
    for (int j = begin; j < end; ++j) {
        if (least_z_ > 0.0f) steep += count_below(map.z.row(j), least_z_, map.extent().width);
        if (ranges_) widen_slope_bounds(map.x.row(j), map.y.row(j), map.z.row(j), map.extent().width, bounds);
    }
    // The least and the greatest values do not depend on the order of the threads.
    const std::lock_guard lock(mutex_);
    steep_texels_ += steep;
    all_ = {std::min(all_.min_x, bounds.min_x), std::max(all_.max_x, bounds.max_x), std::min(all_.min_y, bounds.min_y),
            std::max(all_.max_y, bounds.max_y)};
}

SlopeRange SlopeCollector::range() const {
    if (all_.min_x > all_.max_x) return {};
    return {all_.min_x, all_.max_x, all_.min_y, all_.max_y};
}

}  // namespace tex::inline v1
