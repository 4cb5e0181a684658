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

}  // namespace tex::repaired_maps
