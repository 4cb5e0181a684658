// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>
#include <tex/surface.h>

#include "reference/damage.h"
#include "unit/repaired_maps.h"

namespace tex::repaired_maps {

// The vectors of a picture that was turned to the left, y up, are those of the turned map, turned back.
TEST(Repair, TurnsVectorsAsThePictureWas) {
    Codes turned = clean();
    for (std::size_t k = 0; k < turned.values.size(); k += 3) {
        turned.values[k] = clean().values[k + 1];
        turned.values[k + 1] = static_cast<unsigned char>(255 - clean().values[k]);
    }
    const Texture texture = reference::texture_of(turned);
    const auto surface = integrate(unpack(reference::texture_of(clean()))->levels.front());
    ASSERT_TRUE(surface);
    RepairOptions options;
    options.checks.require.y = YAxis::up;
    const Repaired left = repaired(texture, options);
    EXPECT_FALSE(left.texture);
    ASSERT_FALSE(left.left.empty());
    EXPECT_EQ(left.left.front().finding.rule->id, "N308");
    EXPECT_EQ(left.left.front().certainty, RepairClass::choice);
    options.turned = TurnedPicture::left;
    const Repaired told = repaired(texture, options);
    EXPECT_EQ(plan_of(told), "N308 turn all vectors by 90 degrees to the left, as the picture was");
    ASSERT_TRUE(told.texture);
    EXPECT_EQ(codes_in(*told.texture), clean().values);
    options.turned.reset();
    options.checks.height = &surface->field;
    const Repaired shown = repaired(texture, options);
    EXPECT_EQ(plan_of(shown), plan_of(told));
    EXPECT_EQ(shown.steps.front().certainty, RepairClass::safe);
}

// Whoever says that the picture was turned leaves one direction of green that its slopes allow.
TEST(Repair, TurnsVectorsWhoseGreenPointsDown) {
    const Codes down = reference::flip_green(clean());
    Codes turned = down;
    for (std::size_t k = 0; k < turned.values.size(); k += 3) {
        turned.values[k] = static_cast<unsigned char>(255 - down.values[k + 1]);
        turned.values[k + 1] = down.values[k];
    }
    RepairOptions options;
    options.turned = TurnedPicture::left;
    const Repaired done = repaired(reference::texture_of(turned), options);
    EXPECT_EQ(plan_of(done), "N308 turn all vectors by 90 degrees to the left, as the picture was; green points down");
    ASSERT_TRUE(done.texture);
    EXPECT_EQ(codes_in(*done.texture), down.values);
    options.checks.require.y = YAxis::up;
    const Repaired refused = repaired(reference::texture_of(turned), options);
    EXPECT_TRUE(refused.has_errors());
    ASSERT_FALSE(refused.left.empty());
    EXPECT_EQ(refused.left.front().finding.rule->id, "N401") << "green is still down, or red is mirrored";
}

// The file states that y is down, and it is up, as required: the statement is wrong, or red is mirrored.
TEST(Repair, LeavesAStatementThatTheTexelsContradictToAChoice) {
    Texture texture = reference::texture_of(clean());
    texture.y_axis = YAxis::down;
    texture.y_known = true;
    RepairOptions options;
    options.checks.require.y = YAxis::up;
    options.likely = true;
    const Repaired left = repaired(texture, options);
    EXPECT_FALSE(left.texture);
    EXPECT_TRUE(left.has_errors());
    for (const FaultLeft& fault : left.left) {
        if (fault.finding.rule->id == "N112") {
            EXPECT_EQ(fault.certainty, RepairClass::choice);
        }
    }
    options.mirrored = MirroredChannel::green;
    const Repaired done = repaired(texture, options);
    ASSERT_TRUE(done.texture);
    EXPECT_EQ(codes_in(*done.texture), clean().values);
    EXPECT_EQ(done.texture->y_axis, YAxis::up);
}

}  // namespace tex::repaired_maps
