// SPDX-License-Identifier: Apache-2.0
// Steps towards the least bending, in strips of rows.

#include "surface/bending_grid.h"

#include <gtest/gtest.h>

#include "unit/fields.h"

namespace tex {
namespace {

constexpr Extent kGroundExtent{40, 5 * kBendingStrip / 2};

// Rough ground whose first row is row `first` of it, after some steps.
Plane<float> relaxed_ground(int first) {
    BendingGrid grid;
    grid.codes = fields::plane_of(kGroundExtent, [=](int i, int j) {
        return 2.0 + static_cast<int>(4.0 * fields::noise(i, (j + first) % kGroundExtent.height, 1));
    });
    grid.weights = fields::plane_of({kGroundExtent.width / 2, kGroundExtent.height / 2}, [=](int i, int j) {
        return 0.02 * fields::noise(i, (j + first / 2) % (kGroundExtent.height / 2), 2);
    });
    grid.range = {0.0f, 8.0f};
    Plane<float> heights = grid.codes.clone();
    EXPECT_TRUE(relax(grid, 12, heights, {}, {0.0, 1.0}));
    return heights;
}

// On ground that repeats, a row has no place of its own. So strips must not show, wherever they begin.
TEST(BendingGrid, StripsDoNotShow) {
    const Plane<float> expected = relaxed_ground(0);
    EXPECT_FALSE(fields::same_bytes(expected, relaxed_ground(2))) << "the ground is the same everywhere";
    for (const int first : {2, 10, 62, 64}) {
        const Plane<float> turned = relaxed_ground(first);
        int other = 0;
        for (int j = 0; j < kGroundExtent.height; ++j) {
            for (int i = 0; i < kGroundExtent.width; ++i)
                other += turned.at(i, j) != expected.at(i, (j + first) % kGroundExtent.height) ? 1 : 0;
        }
        EXPECT_EQ(other, 0) << first;
    }
}

}  // namespace
}  // namespace tex
