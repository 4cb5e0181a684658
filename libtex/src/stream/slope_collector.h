// SPDX-License-Identifier: Apache-2.0
// slope_collector.h: finds the least and the greatest slopes of rows of normals, which may come in any order and from
// any thread.

#pragma once

#include <limits>
#include <mutex>

#include <tex/bake.h>

#include "kernels/bake.h"

namespace tex {

class SlopeCollector {
public:
    // Adds rows [begin, end) of `map`.
    void add(const NormalMap& map, int begin, int end);

    // To be called after all rows. Returns zeros if there was no row.
    [[nodiscard]] SlopeRange range() const;

private:
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();
    static constexpr SlopeBounds kNone{kInfinity, -kInfinity, kInfinity, -kInfinity};

    std::mutex mutex_;
    SlopeBounds all_ = kNone;
};

}  // namespace tex
