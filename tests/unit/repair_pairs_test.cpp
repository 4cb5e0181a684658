// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "reference/damage.h"
#include "unit/repaired_maps.h"

namespace tex::repaired_maps {
namespace {

// Damage in double, which is then rounded to 8 bits.
Texture damaged(const std::function<void(double*)>& by) {
    Codes codes = clean();
    for (std::size_t k = 0; k < codes.values.size(); k += 3) {
        double t[3];
        for (std::size_t c = 0; c < 3; ++c) t[c] = codes.values[k + c] / 255.0;
        by(t);
        for (std::size_t c = 0; c < 3; ++c)
            codes.values[k + c] = static_cast<unsigned char>(std::floor(std::clamp(t[c], 0.0, 1.0) * 255.0 + 0.5));
    }
    return reference::texture_of(codes);
}

void levels(double* t, double black, double white) {
    for (int c = 0; c < 3; ++c) t[c] = std::clamp((t[c] - black) / (white - black), 0.0, 1.0);
}

void invert_blue(double* t) { t[2] = 1.0 - t[2]; }
void keep_upper_half(double* t) { t[2] = std::max(0.0, 2.0 * t[2] - 1.0); }

}  // namespace

// z was stored in another form before levels were changed, or channels were exchanged: each step alone leaves no map.
TEST(Repair, UndoesTwoDamages) {
    struct Pair {
        std::string plan;
        std::function<void(double*)> by;
        double most;  // degrees
    };
    const std::vector<Pair> pairs = {
        {"N213 exchange R and B, N220 invert B", [](double* t) { invert_blue(t), std::swap(t[0], t[2]); }, 0.01},
        {"N201 take levels from 10.0 % to 90.0 % back, N221 store z as (z + 1) / 2",
         [](double* t) { keep_upper_half(t), levels(t, 0.1, 0.9); }, 0.4},
        {"N314 take levels from 10.0 % to 100.0 % back, N221 store z as (z + 1) / 2",
         [](double* t) { keep_upper_half(t), levels(t, 0.1, 1.0); }, 0.2},
        {"N314 take levels from 0.0 % to 90.0 % back, N220 invert B",
         [](double* t) { invert_blue(t), levels(t, 0.0, 0.9); }, 0.2},
        {"N313 divide by 0.800, N220 invert B", [](double* t) { invert_blue(t), levels(t, 0.0, 1.25); }, 0.4},
        {"N313 divide by 0.800, N221 store z as (z + 1) / 2",
         [](double* t) { keep_upper_half(t), levels(t, 0.0, 1.25); }, 0.4},
    };
    const Texture plain = reference::texture_of(clean());
    RepairOptions likely;
    likely.likely = true;
    for (const Pair& pair : pairs) {
        const Repaired done = repaired(damaged(pair.by), likely);
        EXPECT_EQ(plan_of(done).substr(0, pair.plan.size()), pair.plan) << plan_of(done);
        ASSERT_TRUE(done.texture) << pair.plan;
        EXPECT_LT(angle(*done.texture, plain), pair.most) << pair.plan;
        EXPECT_FALSE(done.has_errors()) << pair.plan;
    }
}

}  // namespace tex::repaired_maps
