// SPDX-License-Identifier: Apache-2.0
// What files state about the channels and y: every file type that can hold text keeps it.

#include "formats/normal_mark.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tex/tex.h>

#include "scratch.h"
#include "textures.h"

namespace tex {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr Container kMarked[] = {Container::dds,  Container::ktx2, Container::png, Container::exr,
                                 Container::tiff, Container::tga,  Container::jpeg};

Swizzle swizzle_from(const std::string& letters) {
    Swizzle swizzle{};
    for (std::size_t c = 0; c < 4; ++c) swizzle[c] = *find_by_name(kComponentNames, letters.substr(c, 1));
    return swizzle;
}

class NormalMark : public testing::Test, protected Scratch {
protected:
    // The texture after a trip through a file.
    Texture through(const Texture& texture, Container container) {
        const auto bytes = encode_file(texture, container);
        EXPECT_TRUE(bytes) << bytes.error().message();
        const std::string path = folder_ + "/file";
        EXPECT_TRUE(write_file(path, *bytes));
        auto back = read_texture(path);
        EXPECT_TRUE(back) << back.error().message();
        return std::move(*back);
    }
};

TEST(NormalMarkText, IsTheNameOfTheLayoutAndY) {
    TextureHead head;
    EXPECT_EQ(normal_mark(head), "");
    head.swizzle_known = true;
    const auto mark = [&](const char* swizzle) {
        head.swizzle = swizzle_from(swizzle);
        return normal_mark(head);
    };
    EXPECT_EQ(mark("xyz1"), "rgb");
    EXPECT_EQ(mark("xyz_"), "rgb");
    head.y_known = true;
    EXPECT_EQ(mark("1y1x"), "dxt5nm +y");
    EXPECT_EQ(mark("_y_x"), "dxt5nm +y");
    head.y_axis = YAxis::down;
    EXPECT_EQ(mark("xy01"), "rg -y");
    EXPECT_EQ(mark("_yzx"), "rxgb -y");
    EXPECT_EQ(mark("y__x"), "y__x -y") << "a layout without a name";
    for (const auto& row : kSwizzleNames) EXPECT_EQ(layout_name(row.value), row.name);
}

TEST(NormalMarkText, IsAppliedOnlyIfItIsUnderstoodAndFits) {
    Texture texture;
    texture.format = Format::rg8_unorm;
    for (const char* wrong : {"", "rgb +y", "dxt5nm", "rg+y", "rg  +y", "rg +y ", "rg up", "xx01", "rgb", "xy012"}) {
        EXPECT_FALSE(apply_normal_mark(wrong, texture)) << wrong;
        EXPECT_FALSE(texture.swizzle_known || texture.y_known) << wrong;
    }
    EXPECT_TRUE(apply_normal_mark("gr -y", texture));
    EXPECT_EQ(texture.swizzle, kSwizzleYx);
    EXPECT_TRUE(texture.y_known && texture.y_axis == YAxis::down);
    EXPECT_TRUE(apply_normal_mark("xy01 +y", texture)) << "the letters of a swizzle";
    EXPECT_EQ(texture.y_axis, YAxis::up);
}

TEST(NormalMarkText, IsFoundInADescription) {
    EXPECT_EQ(mark_in_description("libtex.normal rgb +y"), "rgb +y");
    EXPECT_EQ(mark_in_description("A wall.\r\nlibtex.normal rgb -y\nCopyright"), "rgb -y");
    for (const char* none : {"", "libtex.normal", "libtex.normals rgb", "a libtex.normal rgb +y", "\n\n"})
        EXPECT_EQ(mark_in_description(none), "") << none;
}

TEST_F(NormalMark, ReturnsFromEveryFileTypeWithEveryEncoding) {
    for (const Container container : kMarked) {
        for (const auto& row : kEncodingNames) {
            if (!can_hold(container, row.value)) continue;
            for (const YAxis y : {YAxis::up, YAxis::down}) {
                Texture texture = encoded_texture(row.value, {16, 16}, 1);
                texture.y_axis = y;
                const Texture back = through(texture, container);
                EXPECT_TRUE(back.swizzle_known && back.y_known) << int(container) << row.name;
                EXPECT_EQ(back.y_axis, y) << int(container) << row.name;
                EXPECT_EQ(layout_name(back.swizzle), layout_name(texture.swizzle)) << int(container) << row.name;
                EXPECT_THAT(back.remarks, IsEmpty());
            }
        }
    }
}

TEST_F(NormalMark, ClaimsNothingThatIsNotKnown) {
    for (const Container container : kMarked) {
        Texture texture = encoded_texture(container == Container::exr ? Encoding::half : Encoding::rgb8, {16, 16}, 1);
        texture.y_known = false;
        EXPECT_FALSE(through(texture, container).y_known) << int(container);
        EXPECT_TRUE(through(texture, container).swizzle_known) << int(container);
        if (container == Container::exr) continue;  // its attribute says that floats are signed
        texture.swizzle_known = false;
        EXPECT_FALSE(through(texture, container).swizzle_known) << int(container);
    }
}

TEST_F(NormalMark, OfDdsIsInReservedWordsThatNobodyElseUses) {
    Texture texture = encoded_texture(Encoding::dxt5nm, {16, 16}, 5);
    auto with = encode_file(texture, Container::dds).value();
    texture.swizzle_known = false;
    const auto without = encode_file(texture, Container::dds).value();
    ASSERT_EQ(with.size(), without.size());
    for (std::size_t k = 0; k < with.size(); ++k) {
        const bool is_marked = k >= 44 && k < 60;  // reserved words 3 to 6
        if (!is_marked) {
            EXPECT_EQ(with[k], without[k]) << k;
        } else {
            EXPECT_EQ(without[k], std::byte{0}) << k;
        }
    }
    with[48] = std::byte{'?'};
    const auto damaged = read_texture(with, "x.dds");
    ASSERT_TRUE(damaged);
    EXPECT_FALSE(damaged->swizzle_known);
    EXPECT_THAT(damaged->remarks, testing::ElementsAre(HasSubstr("libtex.normal was not understood")));
}

}  // namespace
}  // namespace tex
