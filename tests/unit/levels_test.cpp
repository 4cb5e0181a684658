// SPDX-License-Identifier: Apache-2.0

#include "checks/levels.h"

#include <cmath>

#include <gtest/gtest.h>

#include "unit/normal_maps.h"
#include "unit/stored_maps.h"

namespace tex {
namespace {

constexpr Extent kExtent{48, 40};

// A map that leans: the means of x and y are far from 0, and differ.
Texel leaning(double i, double j) {
    const double x = 0.3 + 0.2 * std::sin(0.21 * i + 0.13 * j), y = -0.15 + 0.25 * std::cos(0.17 * j - 0.11 * i);
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(std::sqrt(1.0 - x * x - y * y))};
}

NormalMap averages() {
    NormalMap map(kExtent);
    for (int j = 0; j < kExtent.height; ++j) {
        for (int i = 0; i < kExtent.width; ++i) {
            const Texel t = leaning(i, j);
            map.x.at(i, j) = 0.8f * t.r;  // shorter than 1, as averages are
            map.y.at(i, j) = 0.8f * t.g;
            map.z.at(i, j) = 0.8f * t.b;
        }
    }
    return map;
}

template <class Make>
LevelMeasure measured(Make&& make) {
    const StoredMap map(kExtent, make);
    LevelMeasure measure;
    EXPECT_TRUE(measure_level(map.stored(), averages(), 1, {}, measure));
    return measure;
}

// The root mean square of x and y of `make` about their means, and the correlation with those of leaning().
struct Reference {
    double spread = 0.0, correlation = 0.0;
};
template <class Make>
Reference reference_of(Make&& make) {
    const int n = kExtent.width * kExtent.height;
    double mean_s[2] = {}, mean_r[2] = {};
    for (int k = 0; k < n; ++k) {
        const Texel s = make(k % kExtent.width, k / kExtent.width), r = leaning(k % kExtent.width, k / kExtent.width);
        mean_s[0] += s.r / n, mean_s[1] += s.g / n, mean_r[0] += r.r / n, mean_r[1] += r.g / n;
    }
    double ss = 0.0, rr = 0.0, rs = 0.0;
    for (int k = 0; k < n; ++k) {
        const Texel s = make(k % kExtent.width, k / kExtent.width), r = leaning(k % kExtent.width, k / kExtent.width);
        const double ds[2] = {s.r - mean_s[0], s.g - mean_s[1]}, dr[2] = {r.r - mean_r[0], r.g - mean_r[1]};
        for (int c = 0; c < 2; ++c) ss += ds[c] * ds[c], rr += dr[c] * dr[c], rs += ds[c] * dr[c];
    }
    return {std::sqrt(ss / n), rs / std::sqrt(rr * ss)};
}

TEST(Levels, ALevelThatFollowsIsEqualToTheAverage) {
    const LevelMeasure m = measured([](int i, int j) { return leaning(i, j); });
    const Reference reference = reference_of([](int i, int j) { return leaning(i, j); });
    EXPECT_EQ(m.level, 1);
    EXPECT_EQ(m.extent, kExtent);
    EXPECT_NEAR(m.signal, reference.spread, 1e-5);
    EXPECT_NEAR(m.stored_signal, reference.spread, 1e-5);
    EXPECT_NEAR(m.correlation, 1.0, 1e-6);
    EXPECT_NEAR(m.gain, 1.0, 1e-6);
    EXPECT_NEAR(m.shift_x, 0.0, 1e-4);
    EXPECT_NEAR(m.shift_y, 0.0, 1e-4);
    EXPECT_NEAR(m.length, 1.0, 1e-5);
    EXPECT_NEAR(m.average_length, 0.8, 1e-5);
    EXPECT_NEAR(m.error_normalised, 0.0, 1e-5);
    double square = 0.0;  // of x and y of what the average lacks
    for (int j = 0; j < kExtent.height; ++j) {
        for (int i = 0; i < kExtent.width; ++i) {
            const Texel t = leaning(i, j);
            square += 0.04 * (static_cast<double>(t.r) * t.r + static_cast<double>(t.g) * t.g);
        }
    }
    EXPECT_NEAR(m.error_average, std::sqrt(square / (kExtent.width * kExtent.height)), 1e-5);
}

TEST(Levels, SpreadAndCorrelationAreAboutTheMeans) {
    const auto other = [](int i, int j) {
        const Texel t = leaning(i, j);
        return Texel{0.5f * t.r - 0.2f, t.g + 0.1f * std::sin(0.9f * static_cast<float>(i)) + 0.3f, t.b};
    };
    const LevelMeasure m = measured(other);
    const Reference reference = reference_of(other);
    EXPECT_NEAR(m.stored_signal, reference.spread, 1e-5);
    EXPECT_NEAR(m.correlation, reference.correlation, 1e-5);
    EXPECT_GT(m.correlation, 0.5);
    EXPECT_LT(m.correlation, 0.99);
}

TEST(Levels, FadingIsTheGain) {
    const LevelMeasure m = measured([](int i, int j) {
        const Texel t = leaning(i, j);
        return Texel{0.4f * t.r, 0.4f * t.g, 1.0f};
    });
    EXPECT_NEAR(m.gain, 0.4, 1e-5);
    EXPECT_NEAR(m.correlation, 1.0, 1e-5);
}

TEST(Levels, ShiftsHaveTheirDirection) {
    for (const auto& [x, y] : {std::pair(0.4, 0.0), std::pair(0.0, -0.3), std::pair(-0.25, 0.35)}) {
        const LevelMeasure m = measured([x = x, y = y](int i, int j) { return leaning(i - x, j - y); });
        EXPECT_NEAR(m.shift_x, x, 0.02);
        EXPECT_NEAR(m.shift_y, y, 0.02);
    }
}

// The average over a texel of a smaller level, as an integral over the texels under it.
double average_of(const Plane<float>& plane, Extent to, int i, int j) {
    const Extent from = plane.extent();
    const double w = static_cast<double>(from.width) / to.width, h = static_cast<double>(from.height) / to.height;
    double sum = 0.0;
    for (int y = 0; y < from.height; ++y) {
        for (int x = 0; x < from.width; ++x) {
            const double across = std::min(x + 1.0, (i + 1) * w) - std::max(static_cast<double>(x), i * w);
            const double down = std::min(y + 1.0, (j + 1) * h) - std::max(static_cast<double>(y), j * h);
            if (across > 0.0 && down > 0.0) sum += across * down * plane.at(x, y);
        }
    }
    return sum / (w * h);
}

TEST(Levels, AveragesWeightTexelsByWhatIsCovered) {
    for (const Extent extent : {Extent{8, 6}, Extent{7, 5}, Extent{9, 1}, Extent{1, 3}, Extent{33, 18}}) {
        const NormalMap map = wavy_map(extent), half = *averages_of(map, {});
        const Extent to = half.extent();
        EXPECT_EQ(to, (Extent{std::max(1, extent.width / 2), std::max(1, extent.height / 2)}));
        const StoredMap stored(extent, [&](int i, int j) {
            return Texel{map.x.at(i, j), map.y.at(i, j), map.z.at(i, j)};
        });
        const auto base = base_averages(stored.stored(), {});
        ASSERT_TRUE(base);
        for (int j = 0; j < to.height; ++j) {
            for (int i = 0; i < to.width; ++i) {
                EXPECT_NEAR(half.x.at(i, j), average_of(map.x, to, i, j), 1e-6);
                EXPECT_NEAR(half.y.at(i, j), average_of(map.y, to, i, j), 1e-6);
                EXPECT_NEAR(half.z.at(i, j), average_of(map.z, to, i, j), 1e-6);
                EXPECT_EQ(half.x.at(i, j), base->x.at(i, j));
                EXPECT_EQ(half.z.at(i, j), base->z.at(i, j));
            }
        }
    }
}

TEST(Levels, VectorsOutsideTheCircleAreShortenedIfZIsNotStored) {
    StoredMap map({4, 1}, [](int i, int) {
        constexpr Texel kTexels[] = {{0.6f, 0.0f}, {3.0f, 4.0f}, {NAN, 0.0f}, {0.0f, -1.0f}};
        return kTexels[i];
    });
    map.swizzle = kSwizzleXy;
    float x[4], y[4], z[4];
    vectors_of_row(map.stored(), 0, 0, 4, x, y, z);
    EXPECT_NEAR(z[0], 0.8f, 1e-6f);
    EXPECT_NEAR(x[1], 0.6f, 1e-6f);
    EXPECT_NEAR(y[1], 0.8f, 1e-6f);
    EXPECT_NEAR(z[1], 0.0f, 1e-3f);
    EXPECT_EQ(x[2], 0.0f);
    EXPECT_EQ(z[2], 0.0f);
    EXPECT_NEAR(y[3], -1.0f, 1e-6f);
    float part_x[2], part_y[2], part_z[2];
    vectors_of_row(map.stored(), 0, 1, 2, part_x, part_y, part_z);
    EXPECT_EQ(part_x[0], x[1]);
    EXPECT_EQ(part_y[0], y[1]);
    EXPECT_EQ(part_z[1], z[2]);
    map.swizzle = kSwizzleXyz;
    vectors_of_row(map.stored(), 0, 0, 4, x, y, z);
    EXPECT_EQ(x[1], 0.0f) << "longer than 4";
    EXPECT_NEAR(x[0], 0.6f, 1e-6f);
    EXPECT_EQ(z[0], 0.0f);
}

}  // namespace
}  // namespace tex
