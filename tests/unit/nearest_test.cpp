// SPDX-License-Identifier: Apache-2.0

#include "surface/nearest.h"

#include <tex/height.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "unit/fields.h"

namespace {

using tex::Extent;
using tex::Plane;
using tex::Wrap;
using tex::fields::noise;
using tex::fields::plane_of;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr Wrap kWraps[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror};

// Finds the nearest texel with a height by looking at all texels.
float nearest_by_search(const Plane<float>& heights, Wrap wrap_x, Wrap wrap_y, int i, int j) {
    const auto [width, height] = heights.extent();
    long long best = std::numeric_limits<long long>::max();
    float value = kNan;
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column) {
            if (std::isnan(heights.at(column, row))) continue;
            long long x = std::abs(column - i), y = std::abs(row - j);
            if (wrap_x == Wrap::repeat) x = std::min(x, width - x);
            if (wrap_y == Wrap::repeat) y = std::min(y, height - y);
            if (x * x + y * y < best) {
                best = x * x + y * y;
                value = heights.at(column, row);
            }
        }
    }
    return value;
}

// `heights` with its holes filled.
Plane<float> filled(const Plane<float>& heights, Wrap wrap_x, Wrap wrap_y) {
    Plane<float> result = heights.clone();
    EXPECT_TRUE(tex::fill_from_nearest(result.view(), wrap_x, wrap_y, {2, {}}, {}));
    return result;
}

TEST(Nearest, FillsFromTheNearestTexelTiesByRowThenColumn) {
    for (const Extent extent : {Extent{1, 1}, Extent{1, 9}, Extent{9, 1}, Extent{2, 2}, Extent{7, 5}, Extent{16, 16},
                                Extent{33, 20}, Extent{300, 12}}) {
        for (const double holes : {0.1, 0.5, 0.9, 0.98}) {
            for (const Wrap wrap_x : kWraps) {
                for (const Wrap wrap_y : kWraps) {
                    // Every texel has a unique height, so that a wrong source shows.
                    Plane<float> heights = plane_of(extent, [&](int i, int j) {
                        const bool is_hole = noise(i, j, 7) < holes && (holes != 0.9 || j % 5 != 2);  // full rows, too
                        return is_hole ? static_cast<double>(kNan) : 1.0 + i + 1000.0 * j;
                    });
                    heights.at(extent.width / 2, extent.height / 3) = 0.5f;
                    const Plane<float> result = filled(heights, wrap_x, wrap_y);
                    for (int j = 0; j < extent.height; ++j) {
                        for (int i = 0; i < extent.width; ++i) {
                            ASSERT_EQ(result.at(i, j), nearest_by_search(heights, wrap_x, wrap_y, i, j))
                                << extent.width << "x" << extent.height << " at " << i << " " << j;
                        }
                    }
                }
            }
        }
    }
}

TEST(Nearest, LooksAcrossTheBorderOnlyWhereTheAxisRepeats) {
    Plane<float> heights({8, 1}, kNan);
    heights.at(0, 0) = 1.0f;
    heights.at(4, 0) = 2.0f;
    EXPECT_EQ(filled(heights, Wrap::repeat, Wrap::repeat).at(7, 0), 1.0f);
    EXPECT_EQ(filled(heights, Wrap::clamp, Wrap::repeat).at(7, 0), 2.0f);
    EXPECT_EQ(filled(heights, Wrap::mirror, Wrap::repeat).at(7, 0), 2.0f);
}

TEST(Nearest, TakesTimeInProportionToTheTexels) {
    // One valid texel in a million. A search around each hole would look at 10^11 texels.
    Plane<float> heights({1000, 1000}, kNan);
    heights.at(999, 0) = 0.25f;
    const Plane<float> result = filled(heights, Wrap::clamp, Wrap::repeat);
    EXPECT_EQ(result.at(0, 999), 0.25f);
    EXPECT_EQ(result.at(500, 500), 0.25f);
}

}  // namespace
