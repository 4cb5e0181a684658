// SPDX-License-Identifier: Apache-2.0

#include "formats/picture.h"

#include <cstddef>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/pack.h>

namespace tex {
namespace {

Image picture(std::vector<std::string> names, std::vector<float> values, SampleKind sample, int bits) {
    Image image;
    image.names = std::move(names);
    for (const float value : values) image.planes.emplace_back(Extent{3, 2}, value);
    image.sample = sample;
    image.bits = bits;
    return image;
}

Result<Texture> texture_of(const Image& image) {
    Result<PictureTexture> picture = picture_texture_of(image.names, image.sample, image.bits);
    if (!picture) return picture.error();
    Texture texture = std::move(picture->head);
    const Extent extent = image.extent();
    texture.levels.push_back({extent, std::vector<std::byte>(level_bytes(texture.format, extent))});
    store_texels(image, extent.height, texture.format, picture->planes, texture.levels[0].bytes.data());
    return texture;
}

TEST(Picture, KeepsItsValuesInTheSmallestFormat) {
    struct Case {
        SampleKind sample;
        int bits;
        float value;
        Format format;
    };
    const Case cases[] = {
        {SampleKind::unorm, 1, 1.0f, Format::rgb8_unorm},
        {SampleKind::unorm, 4, 7.0f / 15.0f, Format::rgb8_unorm},
        {SampleKind::unorm, 8, 200.0f / 255.0f, Format::rgb8_unorm},
        {SampleKind::unorm, 16, 4321.0f / 65535.0f, Format::rgb16_unorm},
        {SampleKind::unorm, 32, 0.123456f, Format::rgb32_float},
        {SampleKind::floating, 16, -0.25f, Format::rgb16_float},
        {SampleKind::floating, 32, 1e30f, Format::rgb32_float},
    };
    for (const Case& c : cases) {
        const auto texture = texture_of(picture({"R", "G", "B"}, {c.value, 0.0f, 1.0f}, c.sample, c.bits));
        ASSERT_TRUE(texture);
        EXPECT_EQ(texture->format, c.format) << c.bits;
        EXPECT_FALSE(texture->swizzle_known || texture->y_known);
        const auto back = decode(*texture, 0);
        EXPECT_EQ(back->planes[0].at(2, 1), c.value) << c.bits;
        EXPECT_EQ(back->planes[2].at(2, 1), 1.0f);
    }
    // 12-bit values are rounded to the nearest 16-bit code.
    const auto twelve = texture_of(picture({"Y"}, {1234.0f / 4095.0f}, SampleKind::unorm, 12));
    EXPECT_EQ(twelve->format, Format::r16_unorm);
    EXPECT_NEAR(decode(*twelve, 0)->planes[0].at(0, 0), 1234.0f / 4095.0f, 0.5f / 65535.0f);
}

TEST(Picture, ItsRowsAreRoundedAsItsTexels) {
    Image image = picture({"R", "G", "B"}, {0.0f, 0.0f, 1.0f}, SampleKind::unorm, 12);
    for (int k = 0; k < 6; ++k) image.planes[0].at(k % 3, k / 3) = static_cast<float>(k * 817) / 4095.0f;
    const auto described = picture_texture_of(image.names, image.sample, image.bits);
    EXPECT_TRUE(described->rounds);
    EXPECT_FALSE(picture_texture_of(image.names, image.sample, 16)->rounds);
    EXPECT_FALSE(picture_texture_of(image.names, image.sample, 4)->rounds);
    const auto texture = texture_of(image);
    EXPECT_EQ(described->head.format, texture->format);
    for (int j = 0; j < 2; ++j) {
        float rounded[3];
        round_to_texels(image.planes[described->planes[0]].row(j), 3, rounded);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(rounded[i], decode(*texture, 0)->planes[0].at(i, j));
    }
}

TEST(Picture, FindsItsChannelsByName) {
    const auto reversed = texture_of(picture({"A", "B", "G", "R"}, {0.0f, 0.2f, 0.4f, 0.6f}, SampleKind::unorm, 8));
    EXPECT_EQ(decode(*reversed, 0)->planes[0].at(0, 0), 0.6f);
    EXPECT_EQ(decode(*reversed, 0)->planes[3].at(0, 0), 0.0f);
    const auto grey = texture_of(picture({"Y", "A"}, {0.2f, 0.8f}, SampleKind::unorm, 8));
    EXPECT_EQ(grey->format, Format::rgba8_unorm);
    EXPECT_EQ(decode(*grey, 0)->planes[1].at(0, 0), 0.2f);
    EXPECT_EQ(decode(*grey, 0)->planes[3].at(0, 0), 0.8f);
    const auto two = texture_of(picture({"u", "v"}, {0.2f, 0.8f}, SampleKind::unorm, 8));
    EXPECT_EQ(two->format, Format::rg8_unorm);
    const auto many = texture_of(picture({"a", "b", "c", "d", "e"}, {0, 0, 0, 0, 0}, SampleKind::unorm, 8));
    EXPECT_EQ(many.error().code, ErrorCode::unsupported);
}

}  // namespace
}  // namespace tex
