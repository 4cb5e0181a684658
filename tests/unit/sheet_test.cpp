// SPDX-License-Identifier: Apache-2.0

#include <tex/preview.h>

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/file.h>
#include <unistd.h>

#include "scratch.h"
#include "unit/preview_pictures.h"

namespace tex::render {
namespace {

TEST(ContactSheet, PutsPanelsInRowsOfEqualColumns) {
    std::vector<Panel> panels;
    for (std::uint8_t k = 1; k <= 3; ++k) panels.push_back({plain_picture({20 * k, 10}, {k, k, k}), "panel"});
    const auto sheet = contact_sheet(panels, 2);
    ASSERT_TRUE(sheet);
    // Columns of 60 and 40, rows of 10 and 14 for the caption, gaps of 8.
    EXPECT_EQ(sheet->extent(), (Extent{60 + 40 + 24, 2 * (10 + 14) + 24}));
    EXPECT_TRUE(code_at(*sheet, 8, 8) == (Code{1, 1, 1}));
    EXPECT_TRUE(code_at(*sheet, 76, 8) == (Code{2, 2, 2}));
    EXPECT_TRUE(code_at(*sheet, 8, 40) == (Code{3, 3, 3}));
    EXPECT_EQ(contact_sheet(panels)->extent().width, 124) << "three pictures stand in two columns";
    const auto none = contact_sheet({});
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::bad_option);
}

TEST(ContactSheet, AnEmptyCellHoldsItsNote) {
    std::vector<Panel> panels = {{plain_picture({90, 60}, {1, 1, 1}), "good"}, {{}, "bad", "is damaged at its end"}};
    const auto sheet = contact_sheet(panels, 2);
    ASSERT_TRUE(sheet);
    EXPECT_EQ(sheet->extent(), (Extent{2 * 90 + 24, 60 + 14 + 16}));
    const auto letters = [](const Texture& picture, int top, int bottom) {
        int count = 0;
        for (int y = top; y < bottom; ++y) {
            for (int x = 106; x < 196; ++x) count += code_at(picture, x, y) == kInk ? 1 : 0;
        }
        return count;
    };
    EXPECT_GT(letters(*sheet, 8, 68), 50) << "the note, in several lines";
    panels[1].note.clear();
    EXPECT_EQ(letters(*contact_sheet(panels, 2), 8, 68), 0);
    EXPECT_EQ(contact_sheet({{{}, "", "nothing"}})->extent(), (Extent{320 + 16, 320 + 16}));
    panels[0].picture = plain_picture({4, 4}, {1, 1, 1});
    panels[1].note = "a cell that has no room";
    EXPECT_TRUE(contact_sheet(panels, 2));
}

TEST(EncodePicture, TakesTheFewestChannels) {
    const auto color_type = [](const std::vector<std::byte>& png) { return std::to_integer<int>(png[25]); };
    Texture picture = plain_picture({20, 10}, {7, 7, 7});
    const auto grey = encode_picture(picture);
    ASSERT_TRUE(grey);
    EXPECT_EQ(color_type(*grey), 0);
    picture.levels.front().bytes[0] = std::byte{8};
    const auto indexed = encode_picture(picture);
    ASSERT_TRUE(indexed);
    EXPECT_EQ(color_type(*indexed), 3);

    Canvas canvas({32, 32}, {0, 0, 0});
    for (int j = 0; j < 32; ++j) {
        for (int i = 0; i < 32; ++i)
            canvas.set(i, j, {static_cast<std::uint8_t>(8 * i), static_cast<std::uint8_t>(8 * j), 1});
    }
    Texture many = std::move(canvas).take();
    const auto colors = encode_picture(many);
    ASSERT_TRUE(colors);
    EXPECT_EQ(color_type(*colors), 2);

    // Reading the file must give the written picture.
    const Scratch scratch;
    for (const auto& [png, made] : {std::pair{&*indexed, &picture}, {&*colors, &many}}) {
        const auto read = read_texture(scratch.write("picture.png", *png));
        ASSERT_TRUE(read);
        EXPECT_EQ(read->levels.front().bytes, made->levels.front().bytes);
    }
}

TEST(SplitView, ShowsTheLeftHalfOfOneAndTheRightHalfOfTheOther) {
    const auto split = split_view({plain_picture({40, 20}, {9, 9, 9}), "a"}, {plain_picture({40, 20}, {7, 7, 7}), "b"});
    ASSERT_TRUE(split);
    EXPECT_TRUE(code_at(*split, 17, 10) == (Code{9, 9, 9}));
    EXPECT_TRUE(code_at(*split, 20, 10) == kInk);
    EXPECT_TRUE(code_at(*split, 22, 10) == (Code{7, 7, 7}));
    const auto refused = split_view({plain_picture({40, 20}, {}), ""}, {plain_picture({40, 21}, {}), ""});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::bad_option);
}

TEST(PictureOf, RoundsToTheNearestCode) {
    Image image;
    for (const char* name : {"R", "G", "B"}) {
        image.names.emplace_back(name);
        image.planes.emplace_back(Extent{2, 1}, 0.5f);
    }
    image.planes[1].at(1, 0) = 2.0f;
    image.planes[2].at(1, 0) = std::nanf("");
    const auto picture = picture_of(image);
    ASSERT_TRUE(picture);
    EXPECT_TRUE(code_at(*picture, 0, 0) == (Code{128, 128, 128}));
    EXPECT_TRUE(code_at(*picture, 1, 0) == (Code{128, 255, 0}));
    image.names = {"Y", "G", "B"};
    EXPECT_FALSE(picture_of(image));
}

}  // namespace
}  // namespace tex::render
