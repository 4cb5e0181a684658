// SPDX-License-Identifier: Apache-2.0
// Animated PNG: libpng reads the first frame; the tests check the other frames by their chunks.

#include "formats/png/apng.h"

#include <cstdint>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <tex/file.h>
#include <tex/preview.h>

#include "preview/canvas.h"
#include "scratch.h"

namespace tex {
namespace {

Texture picture(std::uint8_t shade, Extent extent = {5, 3}) { return render::Canvas(extent, {shade, 0, 9}).take(); }

std::vector<std::string> types_of(const std::vector<std::byte>& file) {
    std::vector<std::string> types;
    for (std::size_t at = 8; at + 12 <= file.size();) {
        std::size_t size = 0;
        for (std::size_t k = 0; k < 4; ++k) size = size << 8 | std::to_integer<std::size_t>(file[at + k]);
        types.emplace_back(reinterpret_cast<const char*>(&file[at + 4]), 4);
        at += 12 + size;
    }
    return types;
}

TEST(Apng, ShowsItsFirstFrameToProgramsThatKnowNoAnimation) {
    const auto file = encode_animation({picture(10), picture(20), picture(30)}, 20);
    ASSERT_TRUE(file);
    const Scratch scratch;
    const auto image = read_image(scratch.write("a.png", *file));  // libpng checks the CRC of every chunk that it reads
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->extent(), (Extent{5, 3}));
    EXPECT_FLOAT_EQ(image->planes[0].at(2, 1), 10.0f / 255.0f);
}

TEST(Apng, HoldsAControlForEveryFrameAndNumbersThemInOrder) {
    const auto file = encode_animation({picture(10), picture(20), picture(30)}, 20);
    ASSERT_TRUE(file);
    const std::vector<std::string> types = types_of(*file);
    std::string line;
    for (const std::string& type : types) {
        if (type == "IHDR" || type == "acTL" || type == "fcTL" || type == "IDAT" || type == "fdAT" || type == "IEND")
            line += type + " ";
    }
    EXPECT_EQ(line, "IHDR acTL fcTL IDAT fcTL fdAT fcTL fdAT IEND ");
}

TEST(Apng, RefusesFramesThatDiffer) {
    EXPECT_FALSE(encode_animation({}, 20));
    const auto differ = encode_animation({picture(1), picture(1, {4, 3})}, 20);
    ASSERT_FALSE(differ);
    EXPECT_EQ(differ.error().code, ErrorCode::bad_option);
}

}  // namespace
}  // namespace tex
