// SPDX-License-Identifier: Apache-2.0
// Strength from units, see tex/height.h.

#include <tex/height.h>

#include <limits>

#include <gtest/gtest.h>

namespace {

using tex::Extent;

TEST(Strength, OfTheSameSurfaceGrowsWithTheResolution) {
    // 0.1 m of height on an area of 2 m by 1 m.
    const tex::Strength coarse = tex::strength_from_world({512, 256}, 0.1, 2.0, 1.0).value();
    EXPECT_FLOAT_EQ(coarse.x, 25.6f);
    EXPECT_FLOAT_EQ(coarse.y, 25.6f);
    EXPECT_FLOAT_EQ(tex::strength_from_world({2048, 1024}, 0.1, 2.0, 1.0)->x, 4 * 25.6f);
    // Texels are twice as high as wide.
    EXPECT_FLOAT_EQ(tex::strength_from_world({512, 256}, 0.1, 2.0, 2.0)->y, 12.8f);
}

TEST(Strength, WithoutAHeightTexelsAreSquare) {
    const tex::Strength strength = tex::strength_from_world({512, 100}, 0.1, 2.0).value();
    EXPECT_EQ(strength.x, strength.y);
    EXPECT_FLOAT_EQ(strength.x, 25.6f);
}

TEST(Strength, FromTextureWidthsIsColumns) {
    EXPECT_FLOAT_EQ(tex::strength_from_uv({512, 64}, 0.05)->x, 25.6f);
    EXPECT_FLOAT_EQ(tex::strength_from_uv({512, 64}, 0.05)->y, 25.6f);
}

// bake() requires a finite strength: with infinity, flat areas would get slopes.
TEST(Strength, IsFinite) {
    constexpr float kMost = std::numeric_limits<float>::max();
    EXPECT_EQ(tex::strength_from_uv({512, 64}, 1e308)->x, kMost);
    EXPECT_EQ(tex::strength_from_uv({512, 64}, -1e37)->y, -kMost);
    EXPECT_EQ(tex::strength_from_world({512, 256}, 1e308, 1e-300, 1e-300)->y, kMost);
    EXPECT_EQ(tex::strength_from_world({512, 256}, 0.0, 1e-300)->x, 0.0f);
}

TEST(Strength, RefusesWhatIsNoSize) {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    for (const auto& wrong :
         {tex::strength_from_world({4, 4}, 1.0, 0.0), tex::strength_from_world({4, 4}, 1.0, 1.0, -1.0),
          tex::strength_from_world({4, 4}, kInfinite, 1.0), tex::strength_from_uv({4, 4}, kInfinite)})
        EXPECT_EQ(wrong.error().code, tex::ErrorCode::bad_option);
}

}  // namespace
