// SPDX-License-Identifier: Apache-2.0

#include "checks/stored.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "unit/stored_maps.h"

namespace tex {
namespace {

TEST(Stored, SlopesFollowFromTheVectors) {
    const StoredMap map({8, 8}, [](int i, int j) {
        return Texel{0.1f * static_cast<float>(i), -0.05f * static_cast<float>(j), 0.8f};
    });
    const Slopes slopes = slopes_of(map.stored(), {2, 1, 5, 6});
    EXPECT_EQ(slopes.extent(), (Extent{5, 6}));
    for (int j = 0; j < 6; ++j) {
        for (int i = 0; i < 5; ++i) {
            EXPECT_NEAR(slopes.p.at(i, j), -0.1 * (i + 2) / 0.8, 1e-6);
            EXPECT_NEAR(slopes.q.at(i, j), 0.05 * (j + 1) / 0.8, 1e-6);
        }
    }
}

TEST(Stored, SlopesWithoutZUseTheOneThatXAndYImply) {
    StoredMap map({4, 4}, [](int, int) { return Texel{0.6f, 0.0f, 0.0f}; });
    map.swizzle = kSwizzleXy;
    EXPECT_NEAR(slopes_of(map.stored(), {0, 0, 4, 4}).p.at(1, 1), -0.75, 1e-6);
}

// A texel is unusable, together with those up to four texels beside, above and below it, and no others.
TEST(Stored, HolesGrowByFourTexelsInEveryDirection) {
    const Extent extent{40, 32};
    for (const auto& [column, row] : {std::pair(20, 15), std::pair(0, 0), std::pair(39, 31), std::pair(2, 30)}) {
        StoredMap map(extent, [](int, int) { return Texel{0.0f, 0.1f, 0.9f}; });
        map.image.planes[2].at(column, row) = std::numeric_limits<float>::quiet_NaN();
        const Slopes slopes = slopes_of(map.stored(), {0, 0, extent.width, extent.height});
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                const bool near = std::abs(i - column) <= 4 && std::abs(j - row) <= 4;
                EXPECT_EQ(std::isnan(slopes.p.at(i, j)), near) << i << ", " << j;
                EXPECT_EQ(std::isnan(slopes.q.at(i, j)), near) << i << ", " << j;
            }
        }
    }
}

TEST(Stored, TexelsWithoutADirectionAreHoles) {
    const auto is_hole = [](Texel texel, bool with_z = true) {
        StoredMap map({2, 2}, [&](int, int) { return texel; });
        if (!with_z) map.swizzle = kSwizzleXy;
        return std::isnan(slopes_of(map.stored(), {0, 0, 2, 2}).p.at(0, 0));
    };
    EXPECT_TRUE(is_hole({0.0f, 0.0f, 0.49f}));
    EXPECT_FALSE(is_hole({0.0f, 0.0f, 0.51f}));
    EXPECT_FALSE(is_hole({0.0f, 0.0f, 1.99f}));
    EXPECT_TRUE(is_hole({0.0f, 0.0f, 2.01f}));
    EXPECT_TRUE(is_hole({0.9f, 0.0f, 0.049f}));
    EXPECT_FALSE(is_hole({0.9f, 0.0f, 0.051f}));
    EXPECT_TRUE(is_hole({0.9f, 0.0f, -0.5f}));
    EXPECT_FALSE(is_hole({0.9f, 0.9f, 0.5f})) << "with z, only the length counts";
    EXPECT_TRUE(is_hole({0.0f, std::numeric_limits<float>::infinity(), 0.5f}));
    EXPECT_FALSE(is_hole({0.7f, 0.7f, 0.0f}, false));
    EXPECT_TRUE(is_hole({0.8f, 0.8f, 0.0f}, false));
}

TEST(Stored, LargeMapsAreSampledInSixteenSquares) {
    const auto whole = sample_windows({1024, 1024});
    ASSERT_EQ(whole.size(), 1u);
    EXPECT_EQ(whole[0].width, 1024);
    EXPECT_EQ(whole[0].height, 1024);
    const auto windows = sample_windows({4096, 1000});
    ASSERT_EQ(windows.size(), 16u);
    // (4096 - 256) k / 3 and (1000 - 256) k / 3, rounded down to multiples of 16.
    const int columns[] = {0, 1280, 2560, 3840}, rows[] = {0, 240, 496, 736};
    for (std::size_t k = 0; k < 16; ++k) {
        EXPECT_EQ(windows[k].x, columns[k % 4]);
        EXPECT_EQ(windows[k].y, rows[k / 4]);
        EXPECT_EQ(windows[k].width, 256);
        EXPECT_EQ(windows[k].height, 256);
    }
    for (const Rect& window : sample_windows({100000, 100})) {
        EXPECT_EQ(window.y, 0);
        EXPECT_EQ(window.height, 100);
    }
}

TEST(Stored, HalvedSlopesAreMeansOfFour) {
    Slopes slopes{Plane<float>(Extent{5, 4}), Plane<float>(Extent{5, 4})};
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 5; ++i) {
            slopes.p.at(i, j) = static_cast<float>(i * i + 10 * j * j);
            slopes.q.at(i, j) = static_cast<float>(i - 3 * j);
        }
    }
    slopes.q.at(3, 3) = std::numeric_limits<float>::quiet_NaN();
    const Slopes half = halved(slopes);
    EXPECT_EQ(half.extent(), (Extent{2, 2}));
    EXPECT_FLOAT_EQ(half.p.at(0, 0), (0.0f + 1.0f + 10.0f + 11.0f) / 4.0f);
    EXPECT_FLOAT_EQ(half.p.at(1, 1), (44.0f + 49.0f + 94.0f + 99.0f) / 4.0f);
    EXPECT_FLOAT_EQ(half.q.at(1, 0), (2.0f + 3.0f - 1.0f + 0.0f) / 4.0f);
    EXPECT_TRUE(std::isnan(half.q.at(1, 1)));
    EXPECT_FALSE(std::isnan(half.q.at(0, 1)));
}

}  // namespace
}  // namespace tex
