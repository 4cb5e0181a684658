// SPDX-License-Identifier: Apache-2.0
// slope_collector.h: the least and the greatest slopes of rows of normals, which come in any order, from any thread.

#pragma once

#include <limits>
#include <mutex>

#include <tex/bake.h>

#include "kernels/bake.h"

namespace tex {

class SlopeCollector {
public:
    // Rows [begin, end) of `map`.
    void add(const NormalMap& map, int begin, int end);

    // After all rows; zeros if there was none.
    [[nodiscard]] SlopeRange range() const;

private:
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();
    static constexpr SlopeBounds kNone{kInfinity, -kInfinity, kInfinity, -kInfinity};

    std::mutex mutex_;
    SlopeBounds all_ = kNone;
};

}  // namespace tex
