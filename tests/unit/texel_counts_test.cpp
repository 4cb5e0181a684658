// SPDX-License-Identifier: Apache-2.0

#include "checks/texel_counts.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "unit/stored_maps.h"

namespace tex {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kCode = 1.0f / 255.0f;

// Texels in one row after the other, 7 in each; the rest points up.
constexpr Extent kExtent{7, 20};
constexpr Texel kUp = {0.0f, 0.0f, 1.0f};

TexelCounts count(const StoredMap& map) {
    const auto counts = count_texels(map.stored(), {});
    EXPECT_TRUE(counts);
    return counts ? *counts : TexelCounts{};
}

TexelCounts count(const std::vector<Texel>& texels, bool with_z = true, bool in_blocks = false) {
    StoredMap map(kExtent, [&](int i, int j) {
        const auto k = static_cast<std::size_t>(j * kExtent.width + i);
        return k < texels.size() ? texels[k] : kUp;
    });
    if (!with_z) map.swizzle = kSwizzleXy;
    map.in_blocks = in_blocks;
    return count(map);
}

// Each vector is just on one side of a limit.
TEST(TexelCounts, PropertiesHaveTheirLimits) {
    const auto has = [](Texel texel, Property property, bool with_z = true, bool in_blocks = false) {
        return count({texel}, with_z, in_blocks)[property].count == 1;
    };
    EXPECT_TRUE(has({kNan, 0.0f, 1.0f}, Property::not_finite));
    EXPECT_TRUE(has({0.0f, 0.0f, std::numeric_limits<float>::infinity()}, Property::not_finite));
    EXPECT_FALSE(has({kNan, 0.0f, -1.0f}, Property::z_below)) << "no other property";
    EXPECT_TRUE(has({0.0f, 0.0f, 0.099f}, Property::null_vector));
    EXPECT_FALSE(has({0.0f, 0.0f, 0.101f}, Property::null_vector));
    EXPECT_TRUE(has({0.0f, 0.0f, 1.0f + 4.2f * kCode}, Property::off_length));
    EXPECT_FALSE(has({0.0f, 0.0f, 1.0f + 3.8f * kCode}, Property::off_length));
    EXPECT_TRUE(has({0.0f, 0.0f, 1.0f - 4.2f * kCode}, Property::off_length));
    EXPECT_FALSE(has({0.0f, 0.0f, 1.0f - 3.8f * kCode}, Property::off_length));
    EXPECT_TRUE(has({1.0f, 0.0f, -4.2f * kCode}, Property::z_below));
    EXPECT_FALSE(has({1.0f, 0.0f, -3.8f * kCode}, Property::z_below));
    EXPECT_TRUE(has({1.0f, 0.0f, -0.11f}, Property::z_behind));
    EXPECT_FALSE(has({1.0f, 0.0f, -0.09f}, Property::z_behind));
}

TEST(TexelCounts, TheUnitCircleIsWiderInBlocks) {
    for (const bool with_z : {true, false}) {
        const auto has = [&](float x, bool in_blocks) {
            return count({{0.0f, -x, 0.0f}}, with_z, in_blocks)[Property::beyond_unit].count == 1;
        };
        EXPECT_TRUE(has(1.0f + 4.2f * kCode, false));
        EXPECT_FALSE(has(1.0f + 3.8f * kCode, false));
        EXPECT_TRUE(has(1.31f, true));
        EXPECT_FALSE(has(1.29f, true));
    }
    // Without z, nothing is known about lengths.
    const TexelCounts flat = count(std::vector<Texel>(9, {0.0f, 0.0f, -1.0f}), false);
    for (const Property p : {Property::null_vector, Property::off_length, Property::z_below, Property::z_behind})
        EXPECT_EQ(flat[p].count, 0);
    EXPECT_NEAR(flat.mean_z, 1.0, 1e-6);
}

TEST(TexelCounts, TheFirstTexelIsThatOfTheFirstRow) {
    std::vector<Texel> texels(static_cast<std::size_t>(kExtent.texels()), kUp);
    for (const std::size_t k : {17u, 19u, 21u, 139u}) texels[k] = {0.0f, 0.0f, 0.5f};
    const TexelCounts counts = count(texels);
    EXPECT_EQ(counts[Property::off_length].count, 4);
    EXPECT_EQ(counts[Property::off_length].column, 17 % 7);
    EXPECT_EQ(counts[Property::off_length].row, 17 / 7);
    EXPECT_DOUBLE_EQ(counts.share(Property::off_length), 4.0 / 140.0);
    EXPECT_EQ(counts[Property::z_below].column, -1);
}

TEST(TexelCounts, MeansAreOverFiniteTexels) {
    const TexelCounts counts = count({{kNan, 0.0f, 0.0f}, {0.6f, 0.0f, 0.0f}, {0.0f, -0.3f, 0.4f}});
    EXPECT_EQ(counts.texels, 140);
    EXPECT_EQ(counts.finite, 139);
    EXPECT_NEAR(counts.mean_x, 0.6 / 139.0, 1e-7);
    EXPECT_NEAR(counts.mean_y, -0.3 / 139.0, 1e-7);
    EXPECT_NEAR(counts.mean_z, 137.4 / 139.0, 1e-6);
    EXPECT_NEAR(counts.mean_length, 138.1 / 139.0, 1e-6);
    EXPECT_NEAR(counts.min_length, 0.5f, 1e-6f);
    EXPECT_NEAR(counts.max_length, 1.0f, 1e-6f);
}

TEST(TexelCounts, FlatCodesAreThoseOf8Bits) {
    StoredMap map(kExtent, [](int i, int) {
        const float code = i < 2 ? 127.0f : i < 5 ? 128.0f : 130.0f;
        return Texel{code * kCode, i == 0 ? 128.0f * kCode : code * kCode, 1.0f};
    });
    map.is_signed = false;
    map.image.sample = SampleKind::unorm;
    map.image.bits = 8;
    for (Plane<float>& plane : map.image.planes) {
        for (int k = 0; k < kExtent.width * kExtent.height; ++k) {
            float& value = plane.at(k % kExtent.width, k / kExtent.width);
            value = std::round(value * 255.0f) / 255.0f;
        }
    }
    EXPECT_EQ(count(map)[Property::flat_low].count, 20);
    EXPECT_EQ(count(map)[Property::flat_high].count, 60);
    map.image.bits = 16;
    EXPECT_EQ(count(map)[Property::flat_low].count, 0);
}

// Alpha of 0.5 + i/20, and colours that follow it, with one texel above it.
TEST(TexelCounts, AlphaIsComparedWithTheLargestColour) {
    StoredMap map(
        kExtent,
        [](int i, int j) {
            const float a = 0.5f + static_cast<float>(i) / 20.0f;
            const bool above = i == 3 && j == 4;
            return Texel{0.1f, above ? a + 1.6f * kCode : a * 0.9f, 0.2f, a};
        },
        4);
    map.is_signed = false;
    const TexelCounts counts = count(map);
    EXPECT_EQ(counts[Property::above_alpha].count, 1);
    EXPECT_EQ(counts[Property::above_alpha].column, 3);
    EXPECT_EQ(counts[Property::above_alpha].row, 4);
    EXPECT_GT(counts.alpha_correlation, 0.98);
    EXPECT_LT(counts.alpha_correlation, 1.0);
    EXPECT_EQ(counts[Property::alpha_not_one].count, 140);
    EXPECT_FLOAT_EQ(counts.low[3], 0.5f);
    EXPECT_FLOAT_EQ(counts.high[3], 0.8f);
    EXPECT_FLOAT_EQ(counts.low[0], 0.1f);
    EXPECT_EQ(counts[Property::red_not_one].count, 0);
    map.swizzle = kSwizzleDxt5nm;
    EXPECT_EQ(count(map)[Property::red_not_one].count, 140);
    EXPECT_EQ(count(map)[Property::alpha_not_one].count, 0);
}

TEST(TexelCounts, GreyIsWithinACodeAndAHalf) {
    const auto grey = [](float g, float b) {
        StoredMap map(kExtent, [=](int, int) { return Texel{0.5f, 0.5f + g * kCode, 0.5f + b * kCode}; });
        map.is_signed = false;
        return count(map)[Property::grey].count == 140;
    };
    EXPECT_TRUE(grey(0.0f, 0.0f));
    EXPECT_TRUE(grey(1.4f, 1.4f));
    EXPECT_FALSE(grey(1.6f, 1.4f));
    EXPECT_FALSE(grey(-1.6f, -1.6f));
    EXPECT_FALSE(grey(1.0f, -1.0f));
}

}  // namespace
}  // namespace tex
