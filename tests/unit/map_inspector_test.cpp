// SPDX-License-Identifier: Apache-2.0
// Normals of surfaces given by a formula, whose y points up or down.

#include "stream/map_inspector.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace tex {
namespace {

// The normals of height * sin(...) * sin(...), whose slopes reach about `steepest`. y points up if `sign` is 1.
NormalMap waves(Extent extent, double steepest, double sign) {
    NormalMap map(extent);
    constexpr double kWave = 2.0 * std::numbers::pi / 16.0;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double u = kWave * (i + 0.31 * j), v = kWave * (j - 0.23 * i);
            // Slopes along x and along y upwards; rows run downwards.
            const double p = steepest * (std::cos(u) * std::sin(v) - 0.23 * std::sin(u) * std::cos(v));
            const double q = -steepest * (0.31 * std::cos(u) * std::sin(v) + std::sin(u) * std::cos(v));
            const double z = 1.0 / std::sqrt(1.0 + p * p + q * q);
            map.x.at(i, j) = static_cast<float>(-p * z);
            map.y.at(i, j) = static_cast<float>(-q * z * sign);
            map.z.at(i, j) = static_cast<float>(z);
        }
    }
    return map;
}

TEST(MapInspector, SeesTheDirectionOfGentleAndSteepSurfaces) {
    for (const double steepest : {0.05, 1.0, 6.0}) {
        EXPECT_EQ(shown_y(waves({96, 80}, steepest, 1.0)), YAxis::up) << steepest;
        EXPECT_EQ(shown_y(waves({96, 80}, steepest, -1.0)), YAxis::down) << steepest;
    }
}

TEST(MapInspector, SmallAndFlatMapsShowNothing) {
    EXPECT_EQ(shown_y(waves({31, 96}, 1.0, -1.0)), std::nullopt);
    EXPECT_EQ(shown_y(waves({96, 96}, 0.0, -1.0)), std::nullopt);
}

}  // namespace
}  // namespace tex
