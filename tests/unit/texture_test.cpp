// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>
#include <tex/format.h>

#include "unit/textures.h"

namespace tex {
namespace {

TEST(Texture, HasTheExtentOfItsBaseLevel) {
    EXPECT_EQ(Texture{}.extent(), Extent{});
    EXPECT_EQ(patterned_texture(Format::bc3_unorm, {13, 7}, 4).extent(), (Extent{13, 7}));
}

TEST(Texture, ClaimsNothingBeforeAFileSaysSo) {
    const Texture texture;
    EXPECT_FALSE(texture.swizzle_known || texture.y_known || texture.srgb);
    EXPECT_TRUE(texture.normal_encoding.empty());
    EXPECT_EQ(to_string(texture.swizzle), "xyz_");
}

}  // namespace
}  // namespace tex
