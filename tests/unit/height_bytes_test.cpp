// SPDX-License-Identifier: Apache-2.0

#include "rows/height_bytes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include <tex/file.h>

#include "checks/byte_heights.h"

namespace tex {
namespace {

Result<PictureHeights> height(float r, float g, float b, HeightChannel channel, int bits = 8) {
    Image image;
    image.names = {"R", "G", "B"};
    image.bits = bits;
    for (const float code : {r, g, b}) image.planes.emplace_back(Extent{1, 1}, code / 255.0f);
    HeightOptions options;
    options.channel = channel;
    return height_field(image, options);
}

TEST(HeightBytes, AreTheHeightsOfTheFormulas) {
    EXPECT_EQ(height(1, 134, 160, HeightChannel::terrain_rgb)->height.at(0, 0), 0.0f);
    EXPECT_EQ(height(1, 134, 161, HeightChannel::terrain_rgb)->height.at(0, 0), 0.1f);
    EXPECT_EQ(height(128, 0, 0, HeightChannel::terrarium)->height.at(0, 0), 0.0f);
    EXPECT_EQ(height(130, 7, 64, HeightChannel::terrarium)->height.at(0, 0), 519.25f);
    EXPECT_EQ(height(255, 255, 0, HeightChannel::rg16)->height.at(0, 0), 1.0f);
    EXPECT_EQ(height(1, 2, 77, HeightChannel::rg16)->height.at(0, 0), 258.0f / 65535.0f);
}

// Every code must come back whole, although it was divided by 255.
TEST(HeightBytes, EveryCodeIsExact) {
    for (int code = 0; code < 256; ++code)
        EXPECT_EQ(height(128, static_cast<float>(code), 0, HeightChannel::terrarium)->height.at(0, 0),
                  static_cast<float>(code));
}

TEST(HeightBytes, ImplausibleOnesAreCounted) {
    EXPECT_EQ(height(255, 255, 255, HeightChannel::terrain_rgb)->report.implausible_texels, 1);
    EXPECT_EQ(height(0, 0, 0, HeightChannel::terrarium)->report.implausible_texels, 1);
    EXPECT_EQ(height(130, 0, 0, HeightChannel::terrarium)->report.implausible_texels, 0);
    EXPECT_EQ(height(9, 9, 0, HeightChannel::rg16)->report.implausible_texels, 1);
}

TEST(HeightBytes, AnAlphaOfZeroIsNoHeight) {
    Image image;
    image.names = {"R", "G", "B", "A"};
    // 0 m, and a texel that a server left out: black and transparent, -10000 m or -32768 m.
    for (const float code : {128.0f, 0.0f, 0.0f, 255.0f}) {
        image.planes.emplace_back(Extent{2, 1}, 0.0f);
        image.planes.back().row(0)[0] = code / 255.0f;
    }
    HeightOptions options;
    for (const HeightChannel channel : {HeightChannel::terrarium, HeightChannel::terrain_rgb}) {
        options = {};
        options.channel = channel;
        const auto refused = height_field(image, options);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().reason, "1 height is NaN, infinite or no-data, the first at column 1, row 0");
        options.fill_invalid = true;
        const auto filled = height_field(image, options);
        ASSERT_TRUE(filled) << filled.error().message();
        EXPECT_EQ(filled->height.at(1, 0), filled->height.at(0, 0));
        EXPECT_EQ(filled->report.invalid_texels, 1);
        options = {};
        options.channel = channel;
        options.no_data = std::numeric_limits<float>::quiet_NaN();  // nothing is missing
        EXPECT_LT(height_field(image, options)->height.at(1, 0), -9000.0f);
    }
}

// A slope of 37 codes a texel, with its low byte in one channel and its high byte in the other.
Image slope_in_bytes(const char* low, const char* high) {
    Image image;
    image.names = {low, high, "B"};
    for (int k = 0; k < 3; ++k) image.planes.emplace_back(Extent{64, 4});
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 64; ++i) {
            const int code = 300 + 37 * (i + j);
            image.planes[0].row(j)[i] = static_cast<float>(code % 256) / 255.0f;
            image.planes[1].row(j)[i] = static_cast<float>(code / 256) / 255.0f;
        }
    }
    return image;
}

TEST(HeightBytes, OfWhichTheLowOneIsInRedAreReadAsGr16) {
    EXPECT_EQ(height(2, 1, 77, HeightChannel::gr16)->height.at(0, 0), 258.0f / 65535.0f);
    HeightOptions options;
    options.channel = HeightChannel::gr16;
    const auto read = height_field(slope_in_bytes("R", "G"), options);
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->height.at(10, 2), 744.0f / 65535.0f);
    options.channel = HeightChannel::rg16;
    EXPECT_EQ(height_field(slope_in_bytes("G", "R"), options)->height.at(10, 2), 744.0f / 65535.0f);
}

TEST(HeightBytes, InTheWrongOrderAreRefused) {
    HeightOptions options;
    options.channel = HeightChannel::rg16;
    const auto refused = height_field(slope_in_bytes("R", "G"), options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::bad_data);
    EXPECT_EQ(refused.error().reason,
              "the heights are not rg16: red, their high byte, varies more from texel to texel than green; gr16 takes "
              "red as the low byte");
    options.channel = HeightChannel::gr16;
    EXPECT_EQ(height_field(slope_in_bytes("G", "R"), options).error().reason,
              "the heights are not gr16: green, their high byte, varies more from texel to texel than red; rg16 takes "
              "green as the low byte");
}

TEST(HeightBytes, NeedEightBits) {
    const auto deep = height(1, 2, 3, HeightChannel::terrarium, 16);
    ASSERT_FALSE(deep);
    EXPECT_EQ(deep.error().code, ErrorCode::bad_option);
    EXPECT_EQ(deep.error().reason, "the picture has not the 8 bits that heights as \"terrarium\" have");
}

TEST(HeightBytes, TilesOfMapServersAreRead) {
    const std::string folder = TEX_SOURCE_DIR "/../shared/data/wild/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no ../shared/data/wild";
    const auto texel = [&](const char* file, HeightChannel channel) {
        HeightOptions options;
        options.channel = channel;
        const Result<PictureHeights> field = height_field(*read_image(folder + file), options);
        return field ? field->height.at(20, 30) : -1e9f;
    };
    // From the bytes that oiiotool prints: 1 187 98 and 133 70 160.
    EXPECT_FLOAT_EQ(texel("terrain_rgb_mapbox.png", HeightChannel::terrain_rgb), 1350.6f);
    EXPECT_FLOAT_EQ(texel("terrarium.png", HeightChannel::terrarium), 1350.625f);
    EXPECT_EQ(byte_heights(*read_image(folder + "terrain_rgb_mapbox.png")), HeightChannel::terrain_rgb);
    EXPECT_EQ(byte_heights(*read_image(folder + "terrarium.png")), HeightChannel::terrarium);
}

TEST(HeightBytes, PicturesAreNoTiles) {
    for (const char* name : {"bricks", "report", "relief", "strip", "y_axis", "occlusion"}) {
        const auto picture = read_image(TEX_SOURCE_DIR "/samples/" + std::string(name) + ".png");
        ASSERT_TRUE(picture) << picture.error().message();
        EXPECT_EQ(byte_heights(*picture), std::nullopt) << name;
    }
    const std::string folder = TEX_SOURCE_DIR "/../shared/data/wild4/colour";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no ../shared/data/wild4";
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const auto picture = read_image(entry.path().string());
        if (!picture || picture->bits != 8) continue;
        EXPECT_EQ(byte_heights(*picture), std::nullopt) << entry.path();
    }
}

}  // namespace
}  // namespace tex
