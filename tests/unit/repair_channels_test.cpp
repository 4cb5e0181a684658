// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include "reference/damage.h"
#include "unit/repaired_maps.h"

namespace tex::repaired_maps {
namespace {

unsigned char stored(double c) { return static_cast<unsigned char>(std::floor(std::clamp(c, 0.0, 1.0) * 255.0 + 0.5)); }

template <class By>
Texture changed(std::size_t first, std::size_t step, By by) {
    Codes codes = clean();
    for (std::size_t k = first; k < codes.values.size(); k += step)
        codes.values[k] = stored(by(codes.values[k] / 255.0));
    return reference::texture_of(codes);
}

constexpr std::size_t kRed = 0, kGreen = 1, kChannels = 3;

}  // namespace

// One of x and y leaves the middle, and z no longer fits.
TEST(Repair, TakesAChangeOfOneChannelBack) {
    const Texture plain = reference::texture_of(clean());
    const auto expect = [&](const Texture& damaged, int channel) {
        EXPECT_FALSE(repaired(damaged).texture);  // the surface may lean
        RepairOptions options;
        options.likely = true;
        const Repaired done = repaired(damaged, options);
        ASSERT_TRUE(done.texture);
        EXPECT_EQ(done.steps.front().rule->id, "N207");
        EXPECT_EQ(done.steps.front().kind, RepairKind::undo_tone);
        EXPECT_EQ(done.steps.front().channel, channel);
        EXPECT_GT(angle(damaged, plain), 8.0);
        EXPECT_LT(angle(*done.texture, plain), 0.7) << plan_of(done);
    };
    expect(changed(kGreen, kChannels, [](double c) { return std::pow(c, 1.0 / 1.5); }), 1);
    expect(changed(kRed, kChannels, [](double c) { return c + 0.2; }), 0);
    expect(changed(kRed, kChannels, [](double c) { return 0.75 * c; }), 0);
    expect(changed(kGreen, kChannels, [](double c) { return 0.25 + 0.75 * c; }), 1);
}

// Two channels that changed by different amounts are no change of one.
TEST(Repair, TurnsAMapWhoseChannelsAllChanged) {
    Codes codes = clean();
    for (std::size_t k = 0; k < codes.values.size(); k += kChannels) {
        codes.values[k] = stored(codes.values[k] / 255.0 + 0.2);
        codes.values[k + 1] = stored(codes.values[k + 1] / 255.0 - 0.12);
    }
    RepairOptions options;
    options.likely = true;
    for (const RepairStep& step : repaired(reference::texture_of(codes), options).steps)
        EXPECT_NE(step.kind, RepairKind::undo_tone) << text_of(step);
}

// The numbers are known, but what lies beyond the ends does not come back, so that this is no safe repair.
TEST(Repair, CallsLevelsThatCutXOrYOffLikely) {
    const Codes steep = reference::codes_of(bumps(24.0f));
    Codes codes = steep;
    for (unsigned char& code : codes.values) code = stored((code / 255.0 - 0.25) / 0.6);
    const Texture damaged = reference::texture_of(codes);
    const Repaired left = repaired(damaged);
    EXPECT_FALSE(left.texture);
    ASSERT_FALSE(left.left.empty());
    EXPECT_EQ(left.left.front().finding.rule->id, "N314");
    EXPECT_EQ(left.left.front().certainty, RepairClass::likely);
    EXPECT_NE(left.left.front().finding.message.find("x or y was cut off in"), std::string::npos)
        << left.left.front().finding.message;
    RepairOptions options;
    options.likely = true;
    EXPECT_TRUE(repaired(damaged, options).texture);
}

// Brightness moves x, y and z up, and z is cut off: z of the wrong x and y would lean more.
TEST(Repair, RebuildsNoZOfAMapThatLeans) {
    const Texture damaged = changed(0, 1, [](double c) { return c + 0.2; });
    const Repaired left = repaired(damaged);
    EXPECT_FALSE(left.texture) << plan_of(left);
}

}  // namespace tex::repaired_maps
