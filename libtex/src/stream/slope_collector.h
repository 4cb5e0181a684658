// SPDX-License-Identifier: Apache-2.0
// slope_collector.h: finds the least and the greatest slopes of rows of normals, and counts steep texels. Rows may come
// in any order and from any thread.

#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>

#include <tex/bake.h>

#include "kernels/bake.h"

namespace tex::inline v1 {

class SlopeCollector {
public:
    // Slopes above `steepest` are counted. The range of slopes is found only if `ranges` is set.
    SlopeCollector(float steepest, bool ranges)
        : least_z_(1.0f / std::sqrt(1.0f + steepest * steepest)), ranges_(ranges) {}

    // Adds rows [begin, end) of `map`.
    void add(const NormalMap& map, int begin, int end);

    // To be called after all rows. Returns zeros if there was no row.
    [[nodiscard]] SlopeRange range() const;

    // To be called after all rows.
    [[nodiscard]] std::int64_t steep_texels() const { return steep_texels_; }

private:
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();
    static constexpr SlopeBounds kNone{kInfinity, -kInfinity, kInfinity, -kInfinity};

    const float least_z_;  // of texels that are not steep
    const bool ranges_;
    std::mutex mutex_;
    std::int64_t steep_texels_ = 0;
    SlopeBounds all_ = kNone;
};

}  // namespace tex::inline v1
