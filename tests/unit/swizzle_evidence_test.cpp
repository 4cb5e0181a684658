// SPDX-License-Identifier: Apache-2.0

#include "rows/swizzle_evidence.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/format.h>

namespace tex {
namespace {

struct Rgba {
    std::vector<float> r, g, b, a;
    explicit Rgba(std::size_t width) : r(width), g(width), b(width), a(width) {}
};

float code(double n) { return static_cast<float>(n * 0.5 + 0.5); }

// x, y, z in R, G, B; or x in A and y in G.
void set(Rgba& row, int i, int j, bool rgb) {
    const auto k = static_cast<std::size_t>(i);
    const double x = 0.5 * std::sin(0.3 * i + 0.1 * j), y = 0.4 * std::cos(0.2 * j - 0.1 * i);
    row.r[k] = rgb ? code(x) : 1.0f;
    row.g[k] = code(y);
    row.b[k] = rgb ? code(std::sqrt(1.0 - x * x - y * y)) : 1.0f;
    row.a[k] = rgb ? 1.0f : code(x);
}

// The layout that is found if the texels for which `is_rgb` holds are x, y, z and the others are DXT5nm.
template <class IsRgb>
std::string layout(Extent extent, int rows, IsRgb&& is_rgb) {
    SwizzleEvidence evidence(extent, Texture());
    std::string certain;
    for (int j = 0; j < rows; ++j) {
        Rgba row(static_cast<std::size_t>(extent.width));
        for (int i = 0; i < extent.width; ++i) set(row, i, j, is_rgb(i, j));
        evidence.add_row(j, {row.r.data(), row.g.data(), row.b.data(), row.a.data()});
        if (certain.empty() && evidence.is_certain()) certain = name_of(kSwizzleNames, evidence.layout());
    }
    std::string found(name_of(kSwizzleNames, evidence.layout()));
    EXPECT_TRUE(certain.empty() || certain == found) << certain;
    return found;
}

// In a map of 2^21 texels, every second column of every second row is examined: from the first one.
TEST(SwizzleEvidence, LooksAtEverySecondRowAndColumnOfALargeMap) {
    const Extent large{2048, 1024};
    EXPECT_EQ(layout(large, 64, [](int i, int j) { return i % 2 == 0 && j % 2 == 0; }), "rgb");
    EXPECT_EQ(layout(large, 64, [](int i, int j) { return i % 2 != 0 || j % 2 != 0; }), "dxt5nm");
    const Extent larger{4096, 2048};  // every third
    EXPECT_EQ(layout(larger, 64, [](int i, int j) { return i % 3 == 0 && j % 3 == 0; }), "rgb");
    EXPECT_EQ(layout(larger, 64, [](int i, int j) { return i % 3 != 0 || j % 3 != 0; }), "dxt5nm");
}

// A map of x, y and z need not be read to its end.
TEST(SwizzleEvidence, IsCertainOfRgbEarly) {
    const Extent extent{256, 256};
    SwizzleEvidence rgb(extent, Texture()), packed(extent, Texture());
    for (int j = 0; j < 256; ++j) {
        Rgba row(256), dxt5nm(256);
        for (int i = 0; i < 256; ++i) {
            set(row, i, j, true);
            set(dxt5nm, i, j, false);
        }
        rgb.add_row(j, {row.r.data(), row.g.data(), row.b.data(), row.a.data()});
        packed.add_row(j, {dxt5nm.r.data(), dxt5nm.g.data(), dxt5nm.b.data(), dxt5nm.a.data()});
        EXPECT_TRUE(j < 32 || rgb.is_certain()) << j;
        EXPECT_FALSE(packed.is_certain()) << j;
    }
}

TEST(SwizzleEvidence, LooksAtEveryTexelOfASmallMap) {
    const Extent small{64, 64};
    EXPECT_EQ(layout(small, 64, [](int, int) { return false; }), "dxt5nm");
    EXPECT_EQ(layout(small, 64, [](int, int) { return true; }), "rgb");
    EXPECT_EQ(layout(small, 64, [](int i, int j) { return i == 63 && j == 63; }), "rgb") << "R is not constant";
    EXPECT_EQ(layout({1024, 1024}, 2, [](int i, int j) { return i == 1023 && j == 1; }), "rgb") << "2^20 are small";
}

}  // namespace
}  // namespace tex
