// SPDX-License-Identifier: Apache-2.0
// BC6H and BC7. The peer tests compare random blocks of every mode with Mesa's decoder, bit for bit.

#include "blocks/bptc.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <tex/file.h>
#include <tex/pack.h>

#include "blocks/bc6h.h"
#include "blocks/bc7.h"

namespace tex {
namespace {

TEST(Bptc, ReservedModesAreBlack) {
    std::byte block[16];
    std::fill_n(block, 16, std::byte{0xFF});
    block[0] = std::byte{0};
    std::uint8_t rgba[16][4];
    decode_bc7(block, rgba);
    for (const auto& texel : rgba) EXPECT_EQ(std::count(texel, texel + 4, 0), 4);
    for (const unsigned mode : {0x13u, 0x17u, 0x1Bu, 0x1Fu}) {
        block[0] = static_cast<std::byte>(0xE0u | mode);
        std::uint16_t rgb[16][3];
        decode_bc6h(block, true, rgb);
        for (const auto& texel : rgb) EXPECT_EQ(std::count(texel, texel + 3, 0), 3);
    }
}

TEST(Bptc, ABlockOfOneColourHasItExactly) {
    // Mode 6: seven bits for each channel of both endpoints, and a lowest bit for each endpoint.
    const std::uint8_t color[4] = {200, 128, 254, 90};
    std::byte block[16] = {};
    int at = 7;
    const auto put = [&](unsigned value, int count) {
        for (int k = 0; k < count; ++k, ++at) block[at / 8] |= static_cast<std::byte>((value >> k & 1u) << (at % 8));
    };
    block[0] = std::byte{0x40};
    for (const std::uint8_t channel : color) {
        put(channel >> 1u, 7);
        put(channel >> 1u, 7);
    }
    std::uint8_t rgba[16][4];
    decode_bc7(block, rgba);
    for (const auto& texel : rgba) EXPECT_TRUE(std::equal(texel, texel + 4, color));
}

TEST(Bptc, Bc6hIsReadAndNotWritten) {
    for (const Format format : {Format::bc6h_ufloat, Format::bc6h_sfloat}) {
        Texture texture;
        texture.format = format;
        texture.levels.push_back({{4, 4}, std::vector<std::byte>(16)});
        for (const auto& row : kContainerNames) {
            EXPECT_FALSE(can_hold(row.value, format)) << row.name;
            EXPECT_FALSE(encode_file(texture, row.value)) << row.name;
        }
        EXPECT_EQ(encode_file(texture, Container::dds).error().reason,
                  std::string(name_of(kFormatNames, format)) + " can be read, but not written");
    }
}

// A DX10 header for one level of 8 x 4 texels.
std::vector<std::byte> dds_of(std::uint32_t dxgi) {
    Texture texture;
    texture.format = Format::bc5_unorm;
    texture.levels.push_back({{8, 4}, std::vector<std::byte>(32, std::byte{0x55})});
    WriteOptions options;
    options.dds_header = DdsHeader::dx10;
    std::vector<std::byte> file = *encode_file(texture, Container::dds, options);
    file[128] = static_cast<std::byte>(dxgi);
    return file;
}

TEST(Bptc, EveryNumberInDdsIsKnown) {
    const std::pair<std::uint32_t, Format> numbers[] = {
        {94, Format::bc6h_ufloat}, {95, Format::bc6h_ufloat}, {96, Format::bc6h_sfloat},
        {97, Format::bc7_unorm},   {98, Format::bc7_unorm},   {99, Format::bc7_unorm},
    };
    for (const auto& [dxgi, format] : numbers) {
        const std::vector<std::byte> file = dds_of(dxgi);
        const auto texture = read_texture(file, "x.dds");
        ASSERT_TRUE(texture) << texture.error().message();
        EXPECT_EQ(texture->format, format) << dxgi;
        EXPECT_EQ(texture->srgb, dxgi == 99);
        const auto image = decode(*texture, 0);
        ASSERT_TRUE(image);
        EXPECT_EQ(image->extent(), (Extent{8, 4}));
    }
}

}  // namespace
}  // namespace tex
