// SPDX-License-Identifier: Apache-2.0

#include <tex/check.h>

#include <gtest/gtest.h>

namespace tex {
namespace {

TEST(HeatMap, RunsFromBlackToPaleYellow) {
    Plane<float> degrees(Extent{200, 2}, 0.0f);
    degrees.at(1, 0) = 10.0f;
    degrees.at(2, 0) = 90.0f;
    const auto image = heat_map(degrees, 10.0);
    ASSERT_TRUE(image);
    ASSERT_EQ(image->extent(), (Extent{200, 2 + kHeatMapLegendRows}));
    EXPECT_EQ(image->planes[0].at(0, 0), 0.0f);
    EXPECT_EQ(image->planes[2].at(0, 0), 4.0f / 255.0f);
    EXPECT_EQ(image->planes[0].at(1, 0), 252.0f / 255.0f);
    EXPECT_EQ(image->planes[1].at(1, 0), 1.0f);
    EXPECT_EQ(image->planes[1].at(2, 0), 1.0f) << "beyond the scale";
}

TEST(HeatMap, LightnessGrowsAlongTheScale) {
    Plane<float> degrees(Extent{256, 1});
    for (int i = 0; i < 256; ++i) degrees.at(i, 0) = static_cast<float>(i);
    const auto image = heat_map(degrees, 180.0);
    ASSERT_TRUE(image);
    float last = -1.0f;
    for (int i = 0; i <= 180; ++i) {
        const float lightness = 0.2126f * image->planes[0].at(i, 0) + 0.7152f * image->planes[1].at(i, 0) +
                                0.0722f * image->planes[2].at(i, 0);
        EXPECT_GT(lightness, last);
        last = lightness;
    }
}

TEST(HeatMap, NarrowMapsHaveRoomForTheLegend) {
    const auto image = heat_map(Plane<float>(Extent{1, 1}, 3.0f), 180.0);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->extent(), (Extent{kHeatMapLeastWidth, 1 + kHeatMapLegendRows}));
}

// Below the map, as in preview()'s false colours: a bar with the scale's colours, and labels at its ends.
TEST(HeatMap, LegendNamesItsEnds) {
    const auto image = heat_map(Plane<float>(Extent{160, 4}, 0.0f), 7.5);
    ASSERT_TRUE(image);
    const int bar = 4 + 10;  // one of its rows
    EXPECT_LT(image->planes[0].at(8, bar), 0.01f);
    EXPECT_GT(image->planes[0].at(151, bar), 0.98f);
    const auto ink = [&](int from, int to) {
        int count = 0;
        for (int j = 4 + 21; j < 4 + 30; ++j) {
            for (int i = from; i < to; ++i) count += image->planes[0].at(i, j) > 0.8f ? 1 : 0;
        }
        return count;
    };
    EXPECT_GT(ink(8, 13), 10) << "0";
    EXPECT_EQ(ink(14, 50), 0);
    EXPECT_GT(ink(60, 100), 30) << "degrees";
    EXPECT_GT(ink(130, 152), 20) << "7.5";
}

TEST(LargestOfCells, LosesNoAngle) {
    Plane<float> degrees(Extent{10, 5}, 1.0f);
    degrees.at(9, 4) = 7.0f;
    degrees.at(3, 1) = 5.0f;
    const auto cells = largest_of_cells(degrees, 4);
    ASSERT_TRUE(cells);
    ASSERT_EQ(cells->extent(), (Extent{4, 2})) << "cells of 3 texels";
    EXPECT_EQ(cells->at(1, 0), 5.0f);
    EXPECT_EQ(cells->at(3, 1), 7.0f);
    EXPECT_EQ(cells->at(0, 0), 1.0f);
    EXPECT_EQ(largest_of_cells(degrees, 10)->extent(), degrees.extent());
}

}  // namespace
}  // namespace tex
