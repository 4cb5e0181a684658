// SPDX-License-Identifier: Apache-2.0
// Sampling in previews: filters, borders, footprints and parallax.

#include "preview/sampling.h"

#include <cmath>

#include <gtest/gtest.h>

#include "preview/parallax.h"
#include "reference/wikibook_shader.h"

namespace tex::render {
namespace {

// A plane with the values of f(i, j).
template <class F>
Plane<float> plane_of(Extent extent, F f) {
    Plane<float> plane(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) plane.at(i, j) = static_cast<float>(f(i, j));
    }
    return plane;
}

Sampler single(const Plane<float>& plane, Wrap wrap) { return {{{plane.view()}}, 1, wrap, wrap}; }

constexpr Footprint kPoint{};

double at(const Sampler& sampler, double u, double v) { return sample(sampler, {u, v}, kPoint, 1)[0]; }

TEST(PreviewSampling, TexelCentresGiveTheTexelAndRowsRunDownFromTheTop) {
    const Plane<float> plane = plane_of({4, 2}, [](int i, int j) { return 10 * j + i; });
    const Sampler sampler = single(plane, Wrap::repeat);
    EXPECT_EQ(at(sampler, 0.125, 0.75), 0.0);
    EXPECT_EQ(at(sampler, 0.875, 0.75), 3.0);
    EXPECT_EQ(at(sampler, 0.625, 0.25), 12.0);
    EXPECT_EQ(at(sampler, 0.25, 0.5), 5.5);  // the mean of 0, 1, 10, 11
}

TEST(PreviewSampling, BordersFollowTheirWrap) {
    const Plane<float> plane = plane_of({4, 1}, [](int i, int) { return i; });
    EXPECT_EQ(at(single(plane, Wrap::repeat), 0.0, 0.5), 1.5);  // between 3 and 0
    EXPECT_EQ(at(single(plane, Wrap::clamp), 0.0, 0.5), 0.0);
    EXPECT_EQ(at(single(plane, Wrap::mirror), 0.0, 0.5), 0.0);
    EXPECT_EQ(at(single(plane, Wrap::repeat), 1.125, 0.5), 0.0);
    EXPECT_EQ(at(single(plane, Wrap::clamp), 7.0, 0.5), 3.0);
    EXPECT_EQ(at(single(plane, Wrap::mirror), 1.125, 0.5), 3.0);
    EXPECT_EQ(at(single(plane, Wrap::mirror), -0.125, 0.5), 0.0);
    // Coordinates that no texel number can express must stay inside the texture.
    EXPECT_GE(at(single(plane, Wrap::repeat), 1e300, std::nan("")), 0.0);
}

TEST(PreviewSampling, PyramidsAverageWhatATexelCovers) {
    const Plane<float> plane = plane_of({5, 3}, [](int i, int) { return i; });
    const auto pyramid = Pyramid::build({plane.view()}, {});
    ASSERT_TRUE(pyramid);
    const Sampler sampler = pyramid->sampler(Wrap::clamp, Wrap::clamp);
    ASSERT_EQ(sampler.levels.size(), 3u);
    EXPECT_EQ(sampler.levels[1][0].extent, (Extent{2, 1}));
    // Texel 0 covers [0, 2.5): (0 + 1 + 2 / 2) / 2.5.
    EXPECT_FLOAT_EQ(sampler.levels[1][0].at(0, 0), 0.8f);
    EXPECT_FLOAT_EQ(sampler.levels[1][0].at(1, 0), 3.2f);
    EXPECT_FLOAT_EQ(sampler.levels[2][0].at(0, 0), 2.0f);
}

TEST(PreviewSampling, AnisotropyKeepsStripesAcrossTheShortAxis) {
    // Vertical stripes, seen at a slant: a pixel covers 8 texels of a column, but one of a row.
    const Plane<float> plane = plane_of({64, 64}, [](int i, int) { return i % 2; });
    const auto pyramid = Pyramid::build({plane.view()}, {});
    ASSERT_TRUE(pyramid);
    const Sampler sampler = pyramid->sampler(Wrap::repeat, Wrap::repeat);
    const Footprint slant{{1.0 / 64, 0.0}, {0.0, 8.0 / 64}};
    const Vec2 white{1.5 / 64, 0.5};
    EXPECT_DOUBLE_EQ(sample(sampler, white, slant, 1)[0], 0.5);  // trilinear: level 3, grey
    EXPECT_DOUBLE_EQ(sample(sampler, white, slant, 8)[0], 1.0);  // 8 samples of level 0
    EXPECT_DOUBLE_EQ(sample(sampler, white, slant, 4)[0], 0.5);  // 4 samples of level 1
}

TEST(PreviewParallax, OneStepIsTheWikibooksFormulaOnAStepHeightMap) {
    const Plane<float> step = plane_of({16, 16}, [](int i, int) { return i < 8 ? 0.0 : 1.0; });
    const Sampler height = single(step, Wrap::repeat);
    for (const double amount : {0.05, 0.2, -0.1}) {
        for (const double limit : {0.5, 0.03}) {
            for (const double u : {0.2, 0.7}) {
                const Vec3 view{0.6, -0.3, 0.5};
                const Parallax parallax{static_cast<float>(amount), static_cast<float>(limit), 0};
                const Vec2 offset = parallax_offset(parallax, {height, 1.0}, {u, 0.4}, kPoint, view, 1);
                const double p = static_cast<float>(amount), l = static_cast<float>(limit), h = u < 0.5 ? 0.0 : 1.0;
                EXPECT_DOUBLE_EQ(offset.x, reference::parallax_offset(p, h, view.x, view.z, l));
                EXPECT_DOUBLE_EQ(offset.y, reference::parallax_offset(p, h, view.y, view.z, l));
            }
        }
    }
}

TEST(PreviewParallax, MarchingFindsWhereTheRayMeetsTheStep) {
    const Plane<float> step = plane_of({256, 4}, [](int i, int) { return i < 128 ? 0.0 : 1.0; });
    const Sampler height = single(step, Wrap::clamp);
    const Vec3 view{-1.0, 0.0, 1.0};  // the viewer is to the left: the ray runs to the right as it sinks
    const Parallax parallax{0.4f, 1.0f, 400};
    // From u = 0.45 the ray is at 0.45 - 0.4 (t - 0.5): it enters the step's wall, at 0.5, at t = 0.375.
    const Vec2 wall = parallax_offset(parallax, {height, 1.0}, {0.45, 0.5}, kPoint, view, 1);
    EXPECT_NEAR(0.45 + wall.x, 0.5, 0.005);
    // From u = 0.9 it lands on the step's top, t = 1; from u = 0.1 on the floor, t = 0.
    EXPECT_NEAR(parallax_offset(parallax, {height, 1.0}, {0.9, 0.5}, kPoint, view, 1).x, -0.2, 1e-6);
    EXPECT_NEAR(parallax_offset(parallax, {height, 1.0}, {0.1, 0.5}, kPoint, view, 1).x, 0.2, 1e-6);
}

TEST(PreviewParallax, MarchingAgreesWithOneStepOnALevelSurface) {
    const Plane<float> level(Extent{8, 8}, 0.75f);
    const Sampler height = single(level, Wrap::repeat);
    const Vec3 view{0.4, 0.2, 0.8};
    const Vec2 one = parallax_offset({0.1f, 1.0f, 0}, {height, 1.0}, {0.3, 0.3}, kPoint, view, 1);
    for (const int steps : {1, 3, 64}) {
        const Vec2 many = parallax_offset({0.1f, 1.0f, steps}, {height, 1.0}, {0.3, 0.3}, kPoint, view, 1);
        EXPECT_NEAR(many.x, one.x, 1e-12);
        EXPECT_NEAR(many.y, one.y, 1e-12);
    }
    const Plane<float> texels(Extent{8, 8}, 3.75f);  // the same in another unit
    const Vec2 same =
        parallax_offset({0.1f, 1.0f, 0}, {single(texels, Wrap::repeat), 5.0}, {0.3, 0.3}, kPoint, view, 1);
    EXPECT_DOUBLE_EQ(same.x, one.x);
    const Vec2 grazing = parallax_offset({0.1f, 0.02f, 0}, {height, 1.0}, {0.3, 0.3}, kPoint, {1.0, -1.0, 0.0}, 1);
    EXPECT_FLOAT_EQ(static_cast<float>(grazing.x), 0.02f);
    EXPECT_FLOAT_EQ(static_cast<float>(grazing.y), -0.02f);
}

}  // namespace
}  // namespace tex::render
