// SPDX-License-Identifier: Apache-2.0
// False colours, legends and text in pictures.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "preview/canvas.h"
#include "preview/colormap.h"
#include "preview/legend.h"
#include "preview/measures.h"
#include "reference/wikibook_shader.h"
#include "unit/preview_pictures.h"

namespace tex::render {
namespace {

// The normals of smooth heights that repeat, with green up or upside down.
NormalMap waves(Extent extent, bool upside_down) {
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double p = std::cos(0.4 * i) * std::sin(0.3 * j), q = -0.75 * std::sin(0.4 * i) * std::cos(0.3 * j);
            const double n = std::sqrt(p * p + q * q + 1.0);
            map.x.at(i, j) = static_cast<float>(-p / n);
            map.y.at(i, j) = static_cast<float>((upside_down ? q : -q) / n);
            map.z.at(i, j) = static_cast<float>(1.0 / n);
        }
    }
    return map;
}

TEST(PreviewColors, SrgbCodesAreTheNearestOnes) {
    for (int k = 0; k <= 10000; ++k) {
        const double linear = k / 10000.0;
        const double value = reference::encode_srgb(linear) * 255.0;
        EXPECT_LE(std::abs(srgb_code(linear) - value), 0.5 + 1e-9) << linear;
    }
    EXPECT_EQ(srgb_code(-1.0), 0);
    EXPECT_EQ(srgb_code(7.0), 255);
    EXPECT_EQ(srgb_code(std::nan("")), 0);
    for (int k = 0; k < 256; ++k) EXPECT_EQ(srgb_code(srgb_to_linear(k / 255.0)), k);
}

double lightness(Vec3 c) {
    return 0.2126 * srgb_to_linear(c.x) + 0.7152 * srgb_to_linear(c.y) + 0.0722 * srgb_to_linear(c.z);
}

TEST(PreviewColors, ViridisRunsFromDarkVioletToYellowAndGrowsInLightness) {
    // matplotlib's table at 0, 1/2 and 1.
    const Vec3 want[] = {
        {0.267004, 0.004874, 0.329415}, {0.127568, 0.566949, 0.550556}, {0.993248, 0.906157, 0.143936}};
    for (int k = 0; k < 3; ++k) {
        const Vec3 got = viridis(k / 2.0);
        EXPECT_NEAR(got.x, want[k].x, 0.02);
        EXPECT_NEAR(got.y, want[k].y, 0.02);
        EXPECT_NEAR(got.z, want[k].z, 0.02);
    }
    for (int k = 1; k <= 100; ++k) EXPECT_GT(lightness(viridis(k / 100.0)), lightness(viridis((k - 1) / 100.0)));
}

TEST(PreviewColors, DivergingIsLightestAtZeroAndDarkensToBothSides) {
    for (int k = 1; k <= 50; ++k) {
        EXPECT_LT(lightness(diverging(k / 50.0)), lightness(diverging((k - 1) / 50.0)));
        EXPECT_LT(lightness(diverging(-k / 50.0)), lightness(diverging(-(k - 1) / 50.0)));
        EXPECT_GT(diverging(-k / 50.0).z, diverging(-k / 50.0).x) << "blue below 0";
        EXPECT_LT(diverging(k / 50.0).z, diverging(k / 50.0).x) << "orange above 0";
    }
    EXPECT_EQ(diverging(std::nan("")).y, 0.0);
}

Measure measured(Show show, const NormalMap& map, float maximum = 0.0f) {
    PreviewOptions options;
    options.show = show;
    options.maximum = maximum;
    return std::move(measure(options, map, {}).value());
}

// A ball: 1 / radius everywhere on it.
TEST(PreviewMeasures, CurvatureIsThatOfTheSurface) {
    constexpr int kSide = 64;
    NormalMap map(Extent{kSide, kSide});
    for (int k = 0; k < kSide * kSide; ++k) {
        const float x = (static_cast<float>(k % kSide) - 31.5f) / 80.0f,
                    y = (31.5f - static_cast<float>(k / kSide)) / 80.0f;
        map.x.at(k % kSide, k / kSide) = x;
        map.y.at(k % kSide, k / kSide) = y;
        map.z.at(k % kSide, k / kSide) = std::sqrt(1.0f - x * x - y * y);
    }
    const Measure ball = measured(Show::curvature, map);
    EXPECT_NEAR(ball.values.at(20, 40), 1.0f / 80.0f, 1e-5f);
    EXPECT_EQ(ball.scale.palette, Palette::diverging);
    EXPECT_EQ(ball.scale.least, -ball.scale.greatest);
    EXPECT_DOUBLE_EQ(measured(Show::curvature, map, 0.5f).scale.greatest, 0.5);
}

TEST(PreviewMeasures, AreWhatTheirNamesSay) {
    const NormalMap map = uniform_map({4, 4}, 0.6f, 0.0f, 0.9f);
    const auto value = [&](Show show) { return measured(show, map).values.at(1, 2); };
    EXPECT_NEAR(value(Show::slope), 0.6 / 0.9, 1e-6);
    EXPECT_NEAR(value(Show::tilt), std::atan2(0.6, 0.9) * 180.0 / 3.14159265358979, 1e-4);
    EXPECT_NEAR(value(Show::length), std::sqrt(0.36 + 0.81) - 1.0, 1e-6);
    EXPECT_NEAR(value(Show::z_error), 0.1, 1e-6);
    EXPECT_EQ(value(Show::curl), 0.0f);
    EXPECT_DOUBLE_EQ(measured(Show::z_error, map, 0.0f).scale.greatest, 0.1);
    EXPECT_DOUBLE_EQ(measured(Show::slope, map, 3.0f).scale.greatest, 3.0);
}

TEST(PreviewMeasures, TiltEndsAtAnAngleThatSuitsTheMap) {
    const auto end = [](float x, float z) {
        return measured(Show::tilt, uniform_map({40, 40}, x, 0.0f, z), 0.0f).scale.greatest;
    };
    EXPECT_DOUBLE_EQ(end(0.0f, 1.0f), 0.1);
    EXPECT_DOUBLE_EQ(end(0.2f, 0.98f), 15.0);  // 11.5 degrees
    EXPECT_DOUBLE_EQ(end(0.6f, 0.8f), 45.0);
    EXPECT_DOUBLE_EQ(end(1.0f, 0.1f), 90.0);
    EXPECT_DOUBLE_EQ(end(0.5f, -0.5f), 180.0);
    NormalMap map = uniform_map({40, 40}, 0.05f, 0.0f, 1.0f);
    map.x.at(3, 3) = 1.0f;  // a single texel
    map.z.at(3, 3) = 0.0f;
    EXPECT_DOUBLE_EQ(measured(Show::tilt, map, 0.0f).scale.greatest, 5.0);
    EXPECT_DOUBLE_EQ(measured(Show::tilt, map, 60.0f).scale.greatest, 60.0);
}

TEST(PreviewMeasures, CurlTellsGreenThatIsUpsideDown) {
    const auto sound = measured(Show::curl, waves({96, 96}, false), 0.0f);
    const auto wrong = measured(Show::curl, waves({96, 96}, true), 0.0f);
    EXPECT_EQ(sound.scale.title.find("curl: y up as read, r="), 0u) << sound.scale.title;
    EXPECT_EQ(wrong.scale.title.find("curl: y DOWN as read, r=-"), 0u) << wrong.scale.title;
    double small = 0.0, large = 0.0;
    for (int j = 1; j < 95; ++j) {
        for (int i = 1; i < 95; ++i) {
            small += std::abs(static_cast<double>(sound.values.at(i, j)));
            large += std::abs(static_cast<double>(wrong.values.at(i, j)));
        }
    }
    EXPECT_LT(small * 20.0, large);
}

TEST(PreviewMeasures, ScalesEndAtRoundNumbers) {
    Plane<float> values(Extent{100, 10}, 0.3f);
    EXPECT_DOUBLE_EQ(round_maximum(values, 0.01), 0.5);
    values.at(3, 3) = 1000.0f;  // a single texel does not stretch the scale
    values.at(4, 3) = std::nanf("");
    EXPECT_DOUBLE_EQ(round_maximum(values, 0.01), 0.5);
    EXPECT_DOUBLE_EQ(round_maximum(Plane<float>(Extent{2, 2}, 0.0f), 0.01), 0.01);
}

TEST(PreviewLegend, NamesTheEndsInTheSameWayInEveryLocale) {
    EXPECT_EQ(number(0.5), "0.5");
    EXPECT_EQ(number(-0.01), "-0.01");
    EXPECT_EQ(number(90.0), "90");
    EXPECT_EQ(number(-0.71234), "-0.712");
    const Texture picture = with_legend(plain_picture({200, 50}, {1, 2, 3}), {"title", 0.0, 1.0, Palette::viridis});
    EXPECT_EQ(picture.extent(), (Extent{200, 86}));
    EXPECT_TRUE(code_at(picture, 10, 10) == (Code{1, 2, 3}));
    const Vec3 first = viridis(0.0);
    EXPECT_TRUE(code_at(picture, 8, 60) == (Code{display_code(first.x), display_code(first.y), display_code(first.z)}));
    EXPECT_EQ(with_legend(plain_picture({3, 2}, {}), {"title", 0.0, 1.0, Palette::viridis}).extent(), (Extent{96, 38}));
}

// A title that does not fit between the values goes below them, so that no figure is cut.
TEST(PreviewLegend, PutsALongTitleBelowTheValues) {
    const ColorScale scale{"curl: y DOWN, r=-0.998", -0.05, 0.05, Palette::diverging};
    EXPECT_EQ(with_legend(plain_picture({320, 2}, {}), scale).extent(), (Extent{320, 38}));
    EXPECT_EQ(with_legend(plain_picture({160, 2}, {}), scale).extent(), (Extent{160, 50}));
    EXPECT_EQ(with_legend(plain_picture({64, 2}, {}), scale).extent(), (Extent{96, 62}));
    EXPECT_EQ(legend(96, 1, scale).extent, (Extent{96, kLegendRows}));
}

TEST(PreviewCanvas, DrawsLettersAndCutsWhatDoesNotFit) {
    Canvas canvas({8, 9}, {0, 0, 0});
    canvas.text(0, 0, 1, "I~");
    canvas.text(5, -4, 3, "W");
    canvas.set(-1, 0, kInk);
    canvas.set(8, 8, kInk);
    const Texture picture = std::move(canvas).take();
    EXPECT_TRUE(code_at(picture, 2, 3) == kInk);  // the stem of the I
    EXPECT_TRUE(code_at(picture, 0, 3) == (Code{}));
    EXPECT_EQ(fitted("normal", 1, 100), "normal");
    EXPECT_EQ(fitted("normal", 1, 30), "n..al");
    EXPECT_EQ(fitted("lit: a_rather_long_name_of_a_wall_dxt5nm.dds", 1, 24 * 6), "lit: a_rath.._dxt5nm.dds")
        << "the end tells files apart";
    EXPECT_LE(text_width(fitted("a_rather_long_name_of_a_wall_dxt5nm.dds", 2, 201), 2), 201);
    EXPECT_EQ(fitted("normal", 2, 10), "");
    EXPECT_EQ(text_width("normal", 1), 35);
    EXPECT_EQ(text_width("w\u00e4nde", 1), text_width("wande", 1)) << "a letter of two bytes is one box";
    EXPECT_EQ(fitted("w\u00e4\u00e4\u00e4\u00e4\u00e4nde", 1, 36), "w\u00e4..de");
}

}  // namespace
}  // namespace tex::render
