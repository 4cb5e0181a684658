// SPDX-License-Identifier: Apache-2.0

#include "rows/border_slope.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tex::inline v1 {
namespace {

constexpr float kSteepestCounted = 64.0f;  // steeper ones are no more of a wall

// The ratio of one direction. `texels`: how many each sum has.
double ratio_of(const std::vector<std::int64_t>& sums, int texels) {
    const std::int64_t border = std::max(sums.front(), sums.back());
    const std::int64_t inside = *std::max_element(sums.begin() + BorderSlope::kNear, sums.end() - BorderSlope::kNear);
    const double wall =
        static_cast<double>(border) / (static_cast<double>(texels) * static_cast<double>(BorderSlope::kFixed));
    if (wall < BorderSlope::kLeastWall) return 0.0;
    return static_cast<double>(border) / static_cast<double>(std::max<std::int64_t>(1, inside));
}

}  // namespace

std::int64_t BorderSlope::fixed_slope(float component, float z) {
    const float slope = std::abs(component) / std::max(z, 1.0f / kSteepestCounted);
    return static_cast<std::int64_t>(std::min(slope, kSteepestCounted) * kFixed);
}

BorderSlope::BorderSlope(Extent extent) : extent_(extent) {
    if (std::min(extent.width, extent.height) < kLeastSide) return;
    columns_.resize(static_cast<std::size_t>(extent.width));
    rows_.resize(static_cast<std::size_t>(extent.height));
}

void BorderSlope::add(int j, const VectorRow& row) {
    if (columns_.empty()) return;
    std::int64_t up = 0;
    for (int i = 0; i < extent_.width; i += kStep) up += fixed_slope(row.y[i], row.z[i]);
    const std::lock_guard lock(mutex_);
    rows_[static_cast<std::size_t>(j)] = up;
    if (j % kStep != 0) return;
    for (int i = 0; i < extent_.width; ++i) columns_[static_cast<std::size_t>(i)] += fixed_slope(row.x[i], row.z[i]);
}

double BorderSlope::ratio() const {
    if (columns_.empty()) return 0.0;
    return std::max(ratio_of(columns_, (extent_.height + kStep - 1) / kStep),
                    ratio_of(rows_, (extent_.width + kStep - 1) / kStep));
}

}  // namespace tex::inline v1
