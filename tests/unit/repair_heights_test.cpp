// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bench/wild_maps.h"
#include "repairs/whole_heights.h"
#include "unit/repaired_maps.h"

namespace tex::repaired_maps {
namespace {

constexpr int kSide = 256;
constexpr double kBumpiness = 24.0;

double hills(int i, int j) {
    const double turn = 2.0 * 3.14159265358979 / kSide, x = turn * i, y = turn * j;
    return 0.5 + 0.2 * std::sin(2 * x + y) + 0.14 * std::sin(3 * x - 4 * y + 1.0) +
           0.1 * std::sin(5 * x + 2.0) * std::cos(4 * y);
}

// Central differences in double, stored with 8 bits. `values`: how many the heights have, 0 for all.
Texture baked(int values, double y_sign, bool is_sobel = false) {
    const auto height = [&](int i, int j) {
        const double h = hills((i + kSide) % kSide, (j + kSide) % kSide);
        return values == 0 ? h : std::floor(h * (values - 1) + 0.5) / (values - 1);
    };
    const auto across = [&](int i, int j) { return kBumpiness * (height(i + 1, j) - height(i - 1, j)) / 2.0; };
    const auto up = [&](int i, int j) { return kBumpiness * (height(i, j - 1) - height(i, j + 1)) / 2.0; };
    Codes codes{{kSide, kSide}, 3, {}};
    for (int k = 0; k < kSide * kSide; ++k) {
        const int i = k % kSide, j = k / kSide;
        double p = across(i, j), q = up(i, j);
        if (is_sobel) {
            p = 0.25 * across(i, j - 1) + 0.5 * p + 0.25 * across(i, j + 1);
            q = 0.25 * up(i - 1, j) + 0.5 * q + 0.25 * up(i + 1, j);
        }
        const double length = std::sqrt(1.0 + p * p + q * q);
        for (const double n : {-p, -q * y_sign, 1.0})
            codes.values.push_back(static_cast<unsigned char>(std::floor(127.5 * (n / length + 1.0) + 0.5)));
    }
    return reference::texture_of(codes);
}

Repaired likely(const Texture& texture) {
    RepairOptions options;
    options.likely = true;
    return repaired(texture, options);
}

}  // namespace

// Heights of 8 bits make slopes of few values. The heights come back exactly, so that they can be smoothed and baked.
TEST(Repair, SmoothsTheHeightsBehindSlopesOnALattice) {
    for (const double y_sign : {1.0, -1.0}) {
        const Texture coarse = baked(256, y_sign), fine = baked(0, y_sign);
        EXPECT_TRUE(repaired(coarse).steps.empty()) << "it is a guess";
        const Repaired done = likely(coarse);
        ASSERT_TRUE(done.texture) << y_sign;
        EXPECT_EQ(plan_of(done), "N305 smooth the steps between few values");
        EXPECT_GT(angle(coarse, fine), 1.0);
        EXPECT_LT(angle(*done.texture, fine), 0.4 * angle(coarse, fine));
    }
    EXPECT_TRUE(likely(baked(0, 1.0)).steps.empty());
}

// Other kernels mix the slopes of three rows, and central differences do not explain them.
TEST(Repair, LeavesALatticeThatItCannotExplain) {
    const Texture coarse = baked(64, 1.0, true), fine = baked(0, 1.0, true);
    const Repaired done = likely(coarse);
    EXPECT_LE(done.texture ? angle(*done.texture, fine) : 0.0, angle(coarse, fine)) << plan_of(done);
}

TEST(Repair, SmoothsTheWaterOfOgre) {
    if (!std::filesystem::exists(reference::kWildMaps)) GTEST_SKIP() << "no ../shared/data/wild4";
    for (const char* name : {"normal/ogre_WaterNormal1.tga", "normal/ogre_WaterNormal2.tga"}) {
        const auto map = read_texture(reference::kWildMaps + name);
        ASSERT_TRUE(map) << name;
        const Repaired done = likely(*map);
        EXPECT_EQ(plan_of(done), "N305 smooth the steps between few values") << name;
        for (const FaultLeft& fault : done.left) EXPECT_NE(fault.finding.rule->id, "N305") << name;
    }
}

// Around a wall whose slopes nobody can read, heights follow from each other nevertheless, and all grids fit together.
TEST(WholeHeights, ComeBackAroundWhatIsUnknown) {
    const auto height = [](int i, int j) { return (i * i + 3 * j * j) / 40 - j; };
    WholeSlopes slopes{{48, 40}, std::vector<std::int16_t>(48 * 40), std::vector<std::int16_t>(48 * 40)};
    for (int j = 0; j < 40; ++j) {
        for (int i = 0; i < 48; ++i) {
            slopes.across[slopes.at(i, j)] = static_cast<std::int16_t>(height(i + 1, j) - height(i - 1, j));
            slopes.down[slopes.at(i, j)] = static_cast<std::int16_t>(height(i, j + 1) - height(i, j - 1));
            if (i > 20 && i < 27 && j < 30) slopes.across[slopes.at(i, j)] = WholeSlopes::kUnknown;
        }
    }
    const auto heights = whole_heights(slopes);
    const std::int32_t offset = *heights[slopes.at(2, 2)] - height(2, 2);
    int known = 0;
    for (int j = 0; j < 40; ++j) {
        for (int i = 0; i < 48; ++i) {
            const auto& found = heights[slopes.at(i, j)];
            if (!found) continue;
            EXPECT_EQ(*found, height(i, j) + offset) << i << " " << j;
            ++known;
        }
    }
    EXPECT_GT(known, 48 * 40 * 3 / 4);
}

}  // namespace tex::repaired_maps
