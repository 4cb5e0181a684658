// SPDX-License-Identifier: Apache-2.0
// Normals of surfaces given by a formula, whose y points up or down.

#include "stream/map_inspector.h"

#include <array>
#include <cmath>
#include <cstdlib>
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
        EXPECT_EQ(*measured_y(waves({96, 80}, steepest, 1.0)), YAxis::up) << steepest;
        EXPECT_EQ(*measured_y(waves({96, 80}, steepest, -1.0)), YAxis::down) << steepest;
    }
}

TEST(MapInspector, SmallAndFlatMapsShowNothing) {
    EXPECT_FALSE(measured_y(waves({31, 96}, 1.0, -1.0)));
    EXPECT_FALSE(measured_y(waves({96, 96}, 0.0, -1.0)));
    SourceOptions otherwise;
    otherwise.y_otherwise = YAxis::down;
    EXPECT_EQ(*measured_y(waves({96, 96}, 0.0, -1.0), otherwise), YAxis::down);
    EXPECT_EQ(*measured_y(waves({96, 80}, 0.5, 1.0), otherwise), YAxis::up) << "what the texels show comes first";
}

void put_texel(NormalMap& map, int i, int j, const std::array<float, 3>& n) {
    map.x.at(i, j) = n[0];
    map.y.at(i, j) = n[1];
    map.z.at(i, j) = n[2];
}

// Filters mix what fills a hole with its neighbours. Here they show a surface that is far steeper, and the wrong way
// round.
TEST(MapInspector, IgnoresHolesAndWhatIsBesideThem) {
    const Extent extent{128, 96};
    const NormalMap wrong = waves(extent, 6.0, -1.0);
    for (const float z : {0.0f, -0.5f, 0.004f}) {
        NormalMap map = waves(extent, 0.05, 1.0);
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                const int beside = std::abs(i % 32 - 10);
                if (beside > 4) continue;
                put_texel(map, i, j, {wrong.x.at(i, j), wrong.y.at(i, j), wrong.z.at(i, j)});
                if (beside == 0) put_texel(map, i, j, {0.8f, j % 2 == 0 ? -0.6f : 0.6f, z});
            }
        }
        EXPECT_EQ(*measured_y(map), YAxis::up) << z;
    }
}

// The findings on a map whose texels are `background` for a share of rows, and look into the surface in a share of the
// others.
SourceInfo found_in(double background_rows, const std::array<float, 3>& background, double behind) {
    const Extent extent{100, 100};
    NormalMap map = waves(extent, 0.5, 1.0);
    const int first = static_cast<int>(background_rows * extent.height);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            if (j < first) put_texel(map, i, j, background);
            if (j >= first && i < behind * extent.width) map.z.at(i, j) = -map.z.at(i, j);
        }
    }
    MapInspector inspector(extent, false);
    for (int j = 0; j < extent.height; ++j) inspector.add_row(j, {map.x.row(j), map.y.row(j), map.z.row(j)});
    SourceInfo info;
    inspector.report(info);
    return info;
}

// Black, as unpack() reads it, looks into the surface, too.
TEST(MapInspector, JudgesObjectSpaceByWhatIsNoBackground) {
    const std::array<float, 3> black = {-0.57735f, -0.57735f, -0.57735f};
    EXPECT_FALSE(found_in(0.5, black, 0.0).object_space);
    EXPECT_NEAR(found_in(0.5, black, 0.0).background, 0.5, 1e-9);
    EXPECT_FALSE(found_in(0.0, black, 0.03).object_space);
    EXPECT_FALSE(found_in(0.8, black, 0.03).object_space);
    EXPECT_TRUE(found_in(0.0, black, 0.10).object_space);
    EXPECT_TRUE(found_in(0.8, black, 0.10).object_space);
    EXPECT_EQ(found_in(0.0, black, 0.0).background, 0.0);
}

}  // namespace
}  // namespace tex
