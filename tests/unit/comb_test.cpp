// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "reference/damage.h"
#include "unit/repaired_maps.h"

namespace tex::repaired_maps {

// What image editors do, in double, and then rounded to 8 bits.
TEST(Repair, TakesChangesOfLevelsBack) {
    const auto changed = [](auto&& by) {
        Codes codes = clean();
        for (unsigned char& code : codes.values)
            code = static_cast<unsigned char>(std::floor(std::clamp(by(code / 255.0), 0.0, 1.0) * 255.0 + 0.5));
        return reference::texture_of(codes);
    };
    const Texture plain = reference::texture_of(clean());
    const auto expect = [&](const Texture& damaged, const std::string& plan, double most) {
        RepairOptions options;
        options.likely = true;
        const Repaired done = repaired(damaged, options);
        ASSERT_TRUE(done.texture) << plan;
        EXPECT_EQ(plan_of(done).substr(0, plan.size()), plan);
        EXPECT_LT(angle(*done.texture, plain), most) << plan_of(done);
        EXPECT_GT(angle(damaged, plain), 2 * most);
    };
    expect(changed([](double c) { return std::pow(c, 1.0 / 1.2); }), "N314 take gamma 1.200 back", 0.2);
    expect(changed([](double c) { return std::pow(c, 1.25); }), "N314 take gamma 0.800 back", 0.2);
    expect(changed([](double c) { return (c - 0.1) / 0.9; }), "N314 take levels from 10.0 % to 100.0 % back", 0.2);
    expect(changed([](double c) { return c / 0.9; }), "N314 take levels from 0.0 % to 90.0 % back", 0.4);
    expect(changed([](double c) { return (c - 0.07) / 0.81; }), "N314 take levels from 7.0 % to 88.0 % back", 0.3);
    expect(changed([](double c) { return 0.6 * c; }), "N313 divide by 0.6", 0.6);
    RepairOptions likely;
    likely.likely = true;
    const Repaired stretched = repaired(changed([](double c) { return (c - 0.04) / 0.92; }), likely);
    EXPECT_EQ(plan_of(stretched).substr(0, 42), "N201 take levels from 4.0 % to 96.0 % back") << plan_of(stretched);
    // ImageMagick cuts off what is behind the point.
    Codes cut = clean();
    for (unsigned char& code : cut.values)
        code = static_cast<unsigned char>(255.0 * std::clamp((code / 255.0 - 0.1) / 0.9, 0.0, 1.0) + 1e-6);
    EXPECT_EQ(plan_of(repaired(reference::texture_of(cut))), "N314 take levels from 10.0 % to 100.0 % back");
}

// A map whose maker stretched x and y by a fifth, and made z of them again: the gaps in its histogram are nobody's
// damage. What is done to it afterwards may be mended or left, but not made worse.
TEST(Repair, TakesNothingBackThatItsMakerMeant) {
    Codes meant = clean();
    for (int j = 0; j < meant.extent.height; ++j) {
        for (int i = 0; i < meant.extent.width; ++i) {
            double square = 1.0;
            for (int c = 0; c < 2; ++c) {
                meant.at(i, j, c) = static_cast<unsigned char>(
                    std::clamp(std::floor(127.5 + 1.2 * (clean().at(i, j, c) - 127.5) + 0.5), 0.0, 255.0));
                const double n = meant.at(i, j, c) / 127.5 - 1.0;
                square -= n * n;
            }
            const double z = std::sqrt(std::max(0.0, square));
            meant.at(i, j, 2) = static_cast<unsigned char>(std::floor(127.5 + 127.5 * z + 0.5));
        }
    }
    const Texture before = reference::texture_of(meant);
    const auto expect_no_worse = [&](auto&& by, double more) {
        Codes codes = meant;
        for (unsigned char& code : codes.values)
            code = static_cast<unsigned char>(std::floor(std::clamp(by(code / 255.0), 0.0, 1.0) * 255.0 + 0.5));
        const Texture damaged = reference::texture_of(codes);
        RepairOptions options;
        for (const bool likely : {false, true}) {
            options.likely = likely;
            const Repaired done = repaired(damaged, options);
            EXPECT_FALSE(done.has_errors()) << plan_of(done);
            EXPECT_LE(angle(done.texture ? *done.texture : damaged, before), angle(damaged, before) + more)
                << plan_of(done);
        }
    };
    constexpr double kRounding = 0.1;
    for (const double slope : {1.04, 1.0817, 1.1167, 1.3764})  // ImageMagick's -brightness-contrast 0x2.5, 5, 7, 20
        expect_no_worse([slope](double c) { return 0.5 + slope * (c - 0.5); }, kRounding);
    expect_no_worse([](double c) { return (c - 0.01) / 0.99; }, kRounding);
    for (const double levels : {8.0, 16.0})
        expect_no_worse([levels](double c) { return std::floor(c * (levels - 1.0) + 0.5) / (levels - 1.0); }, 0.5);
}

// The whole range of a map that is nearly flat, as `convert -normalize` stretches it: z is cut off everywhere, so that
// the gaps of the histogram alone show the numbers. They are no proof.
TEST(Repair, TakesAStretchBackThatCutZOffOnlyIfAsked) {
    const Codes flat = reference::codes_of(bumps(3.0f));
    const auto stretched = [&](double black, double white) {
        Codes codes = flat;
        for (unsigned char& code : codes.values)
            code = static_cast<unsigned char>(
                std::floor(std::clamp((code - black) / (white - black), 0.0, 1.0) * 255.0 + 0.5));
        return reference::texture_of(codes);
    };
    const Texture plain = reference::texture_of(flat);
    RepairOptions likely;
    likely.likely = true;
    for (const auto& [black, white] : {std::pair(91.0, 173.0), std::pair(84.0, 166.0)}) {
        const Texture damaged = stretched(black, white);
        EXPECT_TRUE(repaired(damaged).steps.empty()) << black << " " << plan_of(repaired(damaged));
        const Repaired done = repaired(damaged, likely);
        ASSERT_TRUE(done.texture) << black;
        EXPECT_LT(angle(*done.texture, plain), 0.05 * angle(damaged, plain)) << plan_of(done);
    }
    // Both ends alike leave the middle where it is. Rebuilding z from x and y that are too long makes them worse.
    const Texture damaged = stretched(40.3, 214.7);
    EXPECT_TRUE(repaired(damaged).steps.empty()) << plan_of(repaired(damaged));
    const Repaired done = repaired(damaged, likely);
    ASSERT_TRUE(done.texture);
    EXPECT_LT(angle(*done.texture, plain), 0.3) << plan_of(done);
}

// Every code as often as any other: nothing of a curve is left, least of all that of sRGB.
TEST(Repair, AnEqualizedMapIsLeft) {
    Codes codes = reference::codes_of(bumps(3.0f));
    std::vector<double> below(257);
    for (const unsigned char code : codes.values) below[code + 1u] += 1.0;
    for (std::size_t k = 1; k < below.size(); ++k) below[k] += below[k - 1];
    for (unsigned char& code : codes.values)
        code = static_cast<unsigned char>(255.0 * (below[code + 1u] - below[1]) / (below[256] - below[1]));
    RepairOptions likely;
    likely.likely = true;
    const Repaired done = repaired(reference::texture_of(codes), likely);
    for (const RepairStep& step : done.steps) EXPECT_NE(step.kind, RepairKind::encode_srgb) << plan_of(done);
    for (const Finding& finding : done.before.findings) EXPECT_NE(finding.rule->id, "N301");
}

// What 8 bits held is known by its values after a change that 16 bits hold.
TEST(Repair, TakesChangesBackThatWereStoredWith16Bits) {
    const auto changed = [](auto&& by) {
        Texture texture;
        texture.format = *format_of(SampleKind::unorm, 16, 3);
        Level level{clean().extent, {}};
        for (const unsigned char code : clean().values) {
            const double c = std::clamp(by(code / 255.0), 0.0, 1.0);
            const auto value = static_cast<unsigned>(std::floor(c * 65535.0 + 0.5));
            level.bytes.push_back(static_cast<std::byte>(value & 255u));
            level.bytes.push_back(static_cast<std::byte>(value >> 8));
        }
        texture.levels.push_back(std::move(level));
        return texture;
    };
    RepairOptions likely;
    likely.likely = true;
    const auto plan = [&](auto&& by) { return plan_of(repaired(changed(by), likely)); };
    EXPECT_EQ(plan([](double c) { return c; }), "");
    EXPECT_EQ(plan([](double c) { return std::pow(c, 1.0 / 1.13); }), "N314 take gamma 1.130 back");
    EXPECT_EQ(plan([](double c) { return (c - 0.05) / 0.95; }), "N314 take levels from 5.0 % to 100.0 % back");
    EXPECT_EQ(plan([](double c) { return (c - 0.03) / 0.94; }).substr(0, 42),
              "N201 take levels from 3.0 % to 97.0 % back");
}

}  // namespace tex::repaired_maps
