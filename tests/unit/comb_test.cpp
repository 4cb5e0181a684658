// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <string>

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

}  // namespace tex::repaired_maps
