// SPDX-License-Identifier: Apache-2.0

#include "checks/curl.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "unit/stored_maps.h"

namespace tex {
namespace {

// The normals of the height sin(a i + b j) / 2 + sin(c i - d j) / 3, with y up.
Texel normal_at(int i, int j) {
    const double u = 0.31 * i + 0.17 * j, v = 0.13 * i - 0.29 * j;
    const double p = 0.31 * std::cos(u) / 2.0 + 0.13 * std::cos(v) / 3.0;
    const double q = -(0.17 * std::cos(u) / 2.0 - 0.29 * std::cos(v) / 3.0);  // rows count down
    const double length = std::sqrt(p * p + q * q + 1.0);
    return {static_cast<float>(-p / length), static_cast<float>(-q / length), static_cast<float>(1.0 / length)};
}

template <class Change>
Curl curl_of(Extent extent, Change&& change) {
    const StoredMap map(extent, [&](int i, int j) { return change(normal_at(i, j), i, j); });
    return measure_curl(map.stored());
}

TEST(CurlOfSlopes, HasTheSignOfGreen) {
    for (const Extent extent : {Extent{128, 128}, Extent{96, 160}, Extent{600, 520}}) {
        const Curl up = curl_of(extent, [](Texel t, int, int) { return t; });
        EXPECT_GT(up.correlation, 0.99);
        EXPECT_GT(up.confidence, 0.99);
        EXPECT_DOUBLE_EQ(up.usable, 1.0);
        EXPECT_LT(std::abs(up.exchanged), 0.95);
        const Curl down = curl_of(extent, [](Texel t, int, int) { return Texel{t.r, -t.g, t.b}; });
        EXPECT_NEAR(down.correlation, -up.correlation, 1e-6);
        EXPECT_NEAR(down.confidence, up.confidence, 1e-6);
        const Curl exchanged = curl_of(extent, [](Texel t, int, int) { return Texel{t.g, t.r, t.b}; });
        EXPECT_GT(exchanged.exchanged, 0.99);
        EXPECT_GT(exchanged.exchanged_confidence, 0.99);
        EXPECT_LT(std::abs(exchanged.correlation), 0.95);
    }
}

TEST(CurlOfSlopes, RegionsCoverTheMap) {
    const Curl curl = curl_of({100, 70}, [](Texel t, int, int) { return t; });
    ASSERT_EQ(curl.regions.size(), 12u);  // 32 texels each
    std::int64_t texels = 0;
    double cross = 0.0;
    for (const CurlRegion& region : curl.regions) {
        texels += std::int64_t{region.rect.width} * region.rect.height;
        cross += region.scale[0].cross;
    }
    EXPECT_EQ(texels, 7000);
    EXPECT_EQ(curl.regions.back().rect.width, 4);
    EXPECT_EQ(curl.regions.back().rect.height, 6);
    EXPECT_NEAR(cross, curl.scale[0].cross, 1e-9 * std::abs(cross));
    EXPECT_EQ(curl_of({512, 512}, [](Texel t, int, int) { return t; }).regions.size(), 64u) << "64 texels each";
}

// A map of more than 2^20 texels, of which 16 windows are examined.
TEST(CurlOfSlopes, IsTheSameForEveryNumberOfThreads) {
    const StoredMap map({1300, 900}, normal_at);
    const Curl expected = measure_curl(map.stored());
    for (const int threads : {1, 2, 5}) {
        const auto curl = measure_curl(map.stored(), Execution{threads, {}});
        ASSERT_TRUE(curl);
        ASSERT_EQ(curl->regions.size(), expected.regions.size());
        for (std::size_t k = 0; k < curl->regions.size(); ++k) {
            EXPECT_EQ(curl->regions[k].rect.x, expected.regions[k].rect.x);
            EXPECT_EQ(curl->regions[k].scale[2].cross, expected.regions[k].scale[2].cross);
        }
        for (int k = 0; k < kCurlScales; ++k) EXPECT_EQ(curl->scale[k].cross, expected.scale[k].cross);
        EXPECT_EQ(curl->correlation, expected.correlation);
        EXPECT_EQ(curl->confidence, expected.confidence);
        EXPECT_EQ(curl->usable, expected.usable);
    }
}

// The sums of one region against their definition.
TEST(CurlOfSlopes, SumsAreThoseOfCentralDifferences) {
    const StoredMap map({32, 32}, normal_at);
    const Slopes s = slopes_of(map.stored(), {0, 0, 32, 32});
    double cross = 0.0, p_square = 0.0, q_square = 0.0, exchanged = 0.0, px_square = 0.0, qy_square = 0.0;
    for (int j = 1; j < 31; ++j) {
        for (int i = 1; i < 31; ++i) {
            const double py = s.p.at(i, j - 1) - s.p.at(i, j + 1), qx = s.q.at(i + 1, j) - s.q.at(i - 1, j);
            const double px = s.p.at(i + 1, j) - s.p.at(i - 1, j), qy = s.q.at(i, j - 1) - s.q.at(i, j + 1);
            const double w = 1.0 / (0.25 + py * py + qx * qx), v = 1.0 / (0.25 + px * px + qy * qy);
            cross += w * py * qx, p_square += w * py * py, q_square += w * qx * qx;
            exchanged += v * px * qy, px_square += v * px * px, qy_square += v * qy * qy;
        }
    }
    const CurlSums sums = measure_curl(map.stored()).scale[0];
    EXPECT_NEAR(sums.cross, cross, 1e-5);
    EXPECT_NEAR(sums.p_square, p_square, 1e-5);
    EXPECT_NEAR(sums.q_square, q_square, 1e-5);
    EXPECT_NEAR(sums.exchanged, exchanged, 1e-5);
    EXPECT_NEAR(sums.px_square, px_square, 1e-5);
    EXPECT_NEAR(sums.qy_square, qy_square, 1e-5);
    EXPECT_NEAR(sums.correlation(), cross / std::sqrt(p_square * q_square), 1e-5);
    EXPECT_NEAR(sums.exchanged_correlation(), exchanged / std::sqrt(px_square * qy_square), 1e-5);
}

TEST(CurlOfSlopes, UsableIsTheShareWithNormals) {
    const Curl half = curl_of({128, 64}, [](Texel t, int i, int) {
        return i < 60 ? Texel{std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f} : t;
    });
    EXPECT_DOUBLE_EQ(half.usable, 0.5);  // four more columns are beside the hole
    EXPECT_GT(half.correlation, 0.99);
    const Curl none = curl_of({64, 64}, [](Texel, int, int) { return Texel{0.0f, 0.0f, 1.0f}; });
    EXPECT_EQ(none.correlation, 0.0);
    EXPECT_EQ(none.confidence, 0.5);
}

}  // namespace
}  // namespace tex
