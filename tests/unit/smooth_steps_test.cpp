// SPDX-License-Identifier: Apache-2.0

#include <cmath>

#include <gtest/gtest.h>

#include "reference/damage.h"
#include "unit/repaired_maps.h"

namespace tex::repaired_maps {

// Reduced to few values; what lies between them comes back, but not exactly.
TEST(Repair, SmoothsTheStepsOfFewValues) {
    const Texture plain = reference::texture_of(clean());
    for (const int most : {15, 31}) {
        Codes few = clean();
        for (unsigned char& code : few.values)
            code = static_cast<unsigned char>(std::lround(std::round(code * most / 255.0) * 255.0 / most));
        const Texture texture = reference::texture_of(few);
        EXPECT_EQ(plan_of(repaired(texture)), "");
        RepairOptions options;
        options.likely = true;
        const Repaired done = repaired(texture, options);
        EXPECT_EQ(plan_of(done).substr(0, 10), "N315 smoot") << plan_of(done);
        ASSERT_TRUE(done.texture);
        EXPECT_LT(angle(*done.texture, plain), 0.7 * angle(texture, plain)) << most;
        const auto codes = codes_in(*done.texture);
        for (std::size_t k = 0; k < codes.size(); ++k)
            if (k % 3 < 2) {
                ASSERT_NEAR(codes[k], few.values[k], 0.5 * 255.0 / most + 1.0) << k;
            }
    }
}

}  // namespace tex::repaired_maps
