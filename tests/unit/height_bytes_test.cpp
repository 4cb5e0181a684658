// SPDX-License-Identifier: Apache-2.0

#include "rows/height_bytes.h"

#include <gtest/gtest.h>

#include <filesystem>

#include <tex/file.h>

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
}

}  // namespace
}  // namespace tex
