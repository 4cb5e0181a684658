// SPDX-License-Identifier: Apache-2.0
// border_slope.h: whether a baked map has a wall at its border, because heights that do not repeat were baked as if
// they did.

#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include <tex/types.h>

#include "kernels/normal_row.h"

namespace tex::inline v1 {

// Looks at rows of a map, in any order and from any thread. The result depends on neither.
class BorderSlope {
public:
    static constexpr double kWall = 2.0;       // of ratio()
    static constexpr double kLeastWall = 0.1;  // mean slope of a border that can be seen: 6 degrees
    static constexpr int kLeastSide = 16;      // in texels
    static constexpr int kStep = 4;            // of the rows that columns are measured on, and the other way round
    static constexpr int kNear = 3;            // columns and rows that kernels may mix with the other side of the map
    static constexpr float kFixed = 1024.0f;   // units of a slope of 1

    // |component / z| in units of 1 / kFixed.
    static std::int64_t fixed_slope(float component, float z);

    explicit BorderSlope(Extent extent);

    void add(int j, const VectorRow& row);

    // How many times as steep the outermost columns or rows are, across the border, as the steepest column or row
    // inside; 0 if they are too flat to be seen, or the map is too small to tell. Of 12 height maps in the tests' data
    // that tile it is at most 1.3; of 10 terrains that do not, 2.6 to 31. To be called after all rows.
    [[nodiscard]] double ratio() const;

private:
    const Extent extent_;
    std::mutex mutex_;
    std::vector<std::int64_t> columns_, rows_;  // sums of |slope| to the right, and upwards, in fixed point
};

}  // namespace tex::inline v1
