// SPDX-License-Identifier: Apache-2.0

#include "formats/layers.h"

#include <cstring>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>
#include <tex/file.h>
#include <tex/pack.h>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex {
namespace {

const std::string kTextures = TEX_SOURCE_DIR "/../shared/data/wild/tex/";

Result<Texture> read_layer(const std::string& name, const std::string& layer) {
    ReadOptions options;
    options.layer = layer;
    return read_texture(kTextures + name, options);
}

std::string reason_of(const std::string& name, const std::string& layer) {
    const auto texture = read_layer(name, layer);
    return texture ? "read" : texture.error().reason;
}

TEST(Layers, OfArraysAndCubeMapsAreReadByTheirNumber) {
    if (!std::filesystem::exists(kTextures)) GTEST_SKIP() << "no ../shared/data/wild";
    const auto map = read_layer("dx10_typeless_rgba8.dds", "");
    ASSERT_TRUE(map);
    const auto first = read_layer("dx10_array3.dds", "0"), flat = read_layer("dx10_array3.dds", "2");
    ASSERT_TRUE(first) << first.error().message();
    ASSERT_TRUE(flat);
    EXPECT_EQ(first->levels[0].bytes, map->levels[0].bytes);
    EXPECT_EQ(flat->levels[0].bytes[0], std::byte{0x80});  // layers 1 and 2 are flat
    EXPECT_TRUE(first->remarks.empty());
    EXPECT_TRUE(flat->remarks.empty());
    const auto face = read_layer("cube_dx10.dds", "5"), legacy = read_layer("cube_legacy.dds", "3");
    ASSERT_TRUE(face) << face.error().message();
    ASSERT_TRUE(legacy) << legacy.error().message();
    EXPECT_EQ(face->levels[0].bytes, legacy->levels[0].bytes);
    const auto bc5 = read_layer("ktx2_bc5.ktx2", ""), second = read_layer("ktx2_bc5_array2.ktx2", "1");
    ASSERT_TRUE(second) << second.error().message();
    EXPECT_EQ(second->levels[0].bytes, bc5->levels[0].bytes);
    EXPECT_TRUE(read_layer("ktx2_bc5.ktx2", "0"));
}

TEST(Layers, TheErrorsSayHowManyThereAre) {
    if (!std::filesystem::exists(kTextures)) GTEST_SKIP() << "no ../shared/data/wild";
    EXPECT_EQ(reason_of("dx10_array3.dds", ""), "a texture array of 3 layers; --layer 0 to 2 reads one");
    EXPECT_EQ(reason_of("ktx2_bc5_array2.ktx2", ""), "a texture array of 2 layers; --layer 0 to 1 reads one");
    EXPECT_EQ(reason_of("cube_dx10.dds", ""),
              "a cube map of 6 faces; --layer 0 to 5 reads one for +X, -X, +Y, -Y, +Z, -Z");
    EXPECT_EQ(reason_of("dx10_array3.dds", "3"),
              "has no layer \"3\": it holds a texture array of 3 layers; --layer 0 to 2 reads one");
    EXPECT_EQ(reason_of("dxt5nm.dds", "1"), "has no layer \"1\": it holds one layer");
    EXPECT_EQ(reason_of("dxt5nm.dds", "Normal"), "has no layer \"Normal\": it holds one layer");
    EXPECT_EQ(read_layer("dx10_array3.dds", "").error().code, ErrorCode::unsupported);
    EXPECT_EQ(read_layer("dx10_array3.dds", "-1").error().code, ErrorCode::bad_option);
}

void put_u32(std::vector<std::byte>& bytes, std::size_t at, std::uint32_t value) {
    for (std::size_t k = 0; k < 4; ++k) bytes[at + k] = static_cast<std::byte>(value >> 8 * k & 0xFF);
}

// An array of three maps with two levels each, in a file of this type. Layer k has bytes k + 1, and 0x10 more in
// level 1.
std::vector<std::byte> array_of_three(Container container, int zstd) {
    constexpr Extent kExtent = {4, 4};
    Texture texture;
    texture.format = Format::rgba8_unorm;
    const bool is_dds = container == Container::dds;
    WriteOptions options;
    options.dds_header = DdsHeader::dx10;
    options.zstd = zstd;
    // Three times the width holds the bytes of three layers.
    texture.levels.push_back({{kExtent.width * 3, kExtent.height}, std::vector<std::byte>(192)});
    texture.levels.push_back({{6, 2}, std::vector<std::byte>(48)});
    for (std::size_t k = 0; k < 192; ++k) texture.levels[0].bytes[k] = static_cast<std::byte>(k / 64 + 1);
    for (std::size_t k = 0; k < 48; ++k) texture.levels[1].bytes[k] = static_cast<std::byte>(k / 16 + 0x11);
    std::vector<std::byte> file = *encode_file(texture, container, options);
    if (is_dds) {
        put_u32(file, 16, 4);
        put_u32(file, 140, 3);
        // Layer after layer.
        std::vector<std::byte> texels;
        for (std::size_t k = 0; k < 3; ++k) {
            texels.insert(texels.end(), 64, static_cast<std::byte>(k + 1));
            texels.insert(texels.end(), 16, static_cast<std::byte>(k + 0x11));
        }
        std::copy(texels.begin(), texels.end(), file.begin() + 148);
    } else {
        put_u32(file, 20, 4);
        put_u32(file, 32, 3);
    }
    return file;
}

TEST(Layers, AllLevelsAreThoseOfTheLayer) {
    for (const auto& [container, zstd] : {std::pair(Container::dds, 0), {Container::ktx2, 0}, {Container::ktx2, 3}}) {
        const std::vector<std::byte> file = array_of_three(container, zstd);
        for (unsigned layer = 0; layer < 3; ++layer) {
            ReadOptions options;
            options.layer = std::to_string(layer);
            const auto texture = read_texture(file, "a", options);
            ASSERT_TRUE(texture) << texture.error().message();
            ASSERT_EQ(texture->levels.size(), 2u);
            EXPECT_EQ(texture->levels[0].bytes, std::vector<std::byte>(64, static_cast<std::byte>(layer + 1)));
            EXPECT_EQ(texture->levels[1].bytes, std::vector<std::byte>(16, static_cast<std::byte>(layer + 0x11)));
            EXPECT_TRUE(texture->remarks.empty());
            // By rows.
            auto input = InputFile::from_memory("a", file);
            ASSERT_TRUE(input);
            options.values = FileValues::stored;
            const auto image = read_image(*input, options);
            ASSERT_TRUE(image) << image.error().message();
            EXPECT_EQ(image->planes[0].at(3, 3), static_cast<float>(layer + 1));
        }
    }
}

TEST(Layers, WhatTheFileDoesNotHaveIsRefused) {
    std::vector<std::byte> dds = array_of_three(Container::dds, 0);
    ReadOptions last;
    last.layer = "2";
    const auto cut = read_texture(std::span(dds).first(dds.size() - 1), "a", last);
    ASSERT_FALSE(cut);
    EXPECT_EQ(cut.error().reason, "truncated: the file ends before layer 2 is complete");
    put_u32(dds, 140, 0xFFFFFFFF);  // more layers than there are
    last.layer = "4000000000";
    EXPECT_EQ(read_texture(dds, "a", last).error().code, ErrorCode::bad_data);
    last.layer = "0";
    EXPECT_TRUE(read_texture(dds, "a", last));
    std::vector<std::byte> ktx2 = array_of_three(Container::ktx2, 0);
    put_u32(ktx2, 32, 4);
    const auto wrong = read_texture(ktx2, "a", last);
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().reason, "level 0 has 192 bytes instead of 4 times 64");
}

}  // namespace
}  // namespace tex
