// SPDX-License-Identifier: Apache-2.0

#include <tex/blend.h>

#include <cmath>
#include <optional>

#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <tex/bake.h>
#include <tex/check.h>

#include "reference/scale.h"
#include "unit/fields.h"
#include "unit/normal_maps.h"

namespace tex {
namespace {

double largest_angle(const NormalMap& a, const NormalMap& b) { return compare(a, b)->error.max; }

TEST(Scale, AgreesWithTheReference) {
    for (const ScaleMode mode : {ScaleMode::slope, ScaleMode::xy}) {
        for (const float s : {0.0f, 0.25f, 1.0f, 2.0f, -1.5f, 30.0f}) {
            const NormalMap map = wavy_map({61, 17});
            const auto result = scale(copy_of(map), s, mode);
            ASSERT_TRUE(result);
            const reference::Grid<reference::Vector> grid = reference::grid_of(map);
            for (int j = 0; j < 17; ++j) {
                for (int i = 0; i < 61; ++i) {
                    const reference::Vector n = reference::scaled(grid.at(i, j), static_cast<double>(s), mode);
                    // Near the horizon, the clamp makes z of xy sensitive. Its square is exact to a few units in the
                    // last place.
                    EXPECT_NEAR(static_cast<double>(result->x.at(i, j)), n.x, 1e-6);
                    EXPECT_NEAR(static_cast<double>(result->y.at(i, j)), n.y, 1e-6);
                    EXPECT_NEAR(static_cast<double>(result->z.at(i, j)), n.z, mode == ScaleMode::xy ? 1e-3 : 1e-6);
                }
            }
        }
    }
}

TEST(Scale, GivesTheMapBackForTheInverseInSlopeMode) {
    const NormalMap map = wavy_map({64, 64});
    for (const float s : {0.01f, 0.5f, 3.0f, 100.0f, -7.0f}) {
        auto there = scale(copy_of(map), s);
        ASSERT_TRUE(there);
        const auto back = scale(std::move(*there), 1.0f / s);
        for (int j = 0; j < 64; ++j) {
            for (int i = 0; i < 64; ++i) {
                EXPECT_NEAR(back->x.at(i, j), map.x.at(i, j), 1e-5f);
                EXPECT_NEAR(back->y.at(i, j), map.y.at(i, j), 1e-5f);
                EXPECT_NEAR(back->z.at(i, j), map.z.at(i, j), 1e-5f);
            }
        }
    }
}

TEST(Scale, IsWhatBakingWithScaledBumpinessGives) {
    HeightField field;
    field.height = Plane<float>({64, 48});
    for (int j = 0; j < 48; ++j) {
        for (int i = 0; i < 64; ++i)
            field.height.at(i, j) = std::sin(0.2f * static_cast<float>(i)) * std::cos(0.3f * static_cast<float>(j));
    }
    auto gentle = bake(field);
    field.bumpiness_x = field.bumpiness_y = 5.0f;
    const auto steep = bake(field);
    ASSERT_TRUE(gentle && steep);
    EXPECT_LE(largest_angle(*scale(std::move(*gentle), 5.0f), *steep), 1e-4);
}

// On a normal tilted by 32 degrees, the modes differ by two degrees at 1/2 and by 39 degrees at 2, as scale.h says.
TEST(Scale, ModesDifferAsDocumented) {
    const double tilt = 32.0 * 3.14159265358979 / 180;
    const auto angle = [&](float s) {
        const NormalMap map =
            uniform_map({1, 1}, static_cast<float>(std::sin(tilt)), 0.0f, static_cast<float>(std::cos(tilt)));
        return largest_angle(*scale(copy_of(map), s, ScaleMode::slope), *scale(copy_of(map), s, ScaleMode::xy));
    };
    EXPECT_NEAR(angle(0.5f), 2.0, 0.1);
    EXPECT_NEAR(angle(2.0f), 39.0, 0.7);
    EXPECT_NEAR(angle(1.0f), 0.0, 1e-4);
}

TEST(Scale, FlattensAtZeroAndTurnsBumpsIntoDents) {
    for (const ScaleMode mode : {ScaleMode::slope, ScaleMode::xy}) {
        const auto flat = scale(wavy_map({5, 3}), 0.0f, mode);
        EXPECT_EQ(largest_angle(*flat, flat_map({5, 3})), 0.0);
        const auto horizon = scale(uniform_map({1, 1}, 1.0f, 0.0f, 0.0f), 0.0f, mode);
        EXPECT_EQ(horizon->z.at(0, 0), 1.0f);
        const auto dent = scale(uniform_map({1, 1}, 0.6f, 0.0f, 0.8f), -1.0f, mode);
        EXPECT_NEAR(dent->x.at(0, 0), -0.6f, 1e-6f);
        EXPECT_NEAR(dent->z.at(0, 0), 0.8f, 1e-6f);
    }
}

TEST(Scale, TreatsEveryLevelOfAChain) {
    MipChain chain;
    for (int k = 0; k < 4; ++k) chain.levels.push_back(wavy_map(level_extent({13, 7}, k)));
    const auto scaled = scale(std::move(chain), 2.0f);
    ASSERT_TRUE(scaled);
    ASSERT_EQ(scaled->levels.size(), 4u);
    for (int k = 0; k < 4; ++k) {
        const auto single = scale(wavy_map(level_extent({13, 7}, k)), 2.0f);
        EXPECT_EQ(fields::hash_of(scaled->levels[static_cast<std::size_t>(k)]), fields::hash_of(*single));
    }
}

TEST(Scale, GivesTheSameBytesEverywhere) {
    for (const ScaleMode mode : {ScaleMode::slope, ScaleMode::xy}) {
        for (const int width : {1, 2, 15, 16, 17, 33, 257}) {
            std::optional<std::uint64_t> expected;
            for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
                hwy::SetSupportedTargetsForTest(target);
                for (const int threads : {1, 3}) {
                    Execution execution;
                    execution.threads = threads;
                    const auto scaled = scale(wavy_map({width, 9}), 1.7f, mode, execution);
                    if (!expected) expected = fields::hash_of(*scaled);
                    EXPECT_EQ(fields::hash_of(*scaled), *expected) << hwy::TargetName(target);
                }
            }
            hwy::SetSupportedTargetsForTest(0);
        }
    }
}

TEST(Scale, StopsWhenItIsCancelled) {
    Execution execution;
    execution.progress = [](double) { return false; };
    EXPECT_EQ(scale(wavy_map({64, 64}), 2.0f, ScaleMode::slope, execution).error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace tex
