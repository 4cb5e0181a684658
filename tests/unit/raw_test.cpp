// SPDX-License-Identifier: Apache-2.0

#include "formats/raw/raw.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include <tex/file.h>
#include <tex/height.h>

namespace tex {
namespace {

Result<Image> read_raw(std::vector<std::byte> bytes, const std::string& layout, const std::string& name = "h.raw",
                       FileValues values = FileValues::automatic) {
    Result<InputFile> file = InputFile::from_memory(name, std::move(bytes));
    if (!file) return file.error();
    ReadOptions options;
    options.raw = layout;
    options.values = values;
    return read_image(*file, options);
}

std::vector<std::byte> bytes_of(std::initializer_list<int> values) {
    std::vector<std::byte> bytes;
    for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
    return bytes;
}

TEST(Raw, ReadsEveryType) {
    const auto texel = [](const std::vector<std::byte>& bytes, const std::string& layout) {
        const Result<Image> image = read_raw(bytes, layout);
        return image ? image->planes[0].at(1, 0) : -99.0f;
    };
    EXPECT_EQ(texel(bytes_of({0, 255}), "2x1,u8"), 1.0f);
    EXPECT_EQ(texel(bytes_of({0, 0, 0xFF, 0xFF}), "2x1,u16le"), 1.0f);
    EXPECT_EQ(texel(bytes_of({0, 0, 0x01, 0x02}), "2x1,u16le"), 513.0f / 65535.0f);
    EXPECT_EQ(texel(bytes_of({0, 0, 0x01, 0x02}), "2x1,u16be"), 258.0f / 65535.0f);
    EXPECT_EQ(texel(bytes_of({0, 0, 0xFF, 0x7F}), "2x1,s16le"), 32767.0f);  // signed heights are numbers
    EXPECT_EQ(texel(bytes_of({0, 0, 0x80, 0x00}), "2x1,s16be"), -32768.0f);
    EXPECT_EQ(texel(bytes_of({0, 0, 0, 0, 0, 0, 0x20, 0xC1}), "2x1,f32le"), -10.0f);
    EXPECT_EQ(texel(bytes_of({0, 0, 0, 0, 0xC1, 0x20, 0, 0}), "2x1,f32be"), -10.0f);
    EXPECT_EQ(texel(bytes_of({9, 9, 9, 0, 255}), "2x1,u8,3"), 1.0f);
    EXPECT_EQ(read_raw(bytes_of({0, 0, 0x01, 0x02}), "2x1,u16le", "h", FileValues::stored)->planes[0].at(1, 0), 513.0f);
    EXPECT_EQ(read_raw(bytes_of({0, 0, 0xFF, 0x7F}), "2x1,s16le", "h", FileValues::unit)->planes[0].at(1, 0), 1.0f);
}

TEST(Raw, ASquareIsFoundFromTheLengthAndSaid) {
    const Result<Image> image = read_raw(std::vector<std::byte>(32), "", "H.R16");
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->extent(), (Extent{4, 4}));
    EXPECT_EQ(image->remark, "the length of the file means 4x4 texels");
    EXPECT_EQ(read_raw(std::vector<std::byte>(64), "", "h.r32")->extent(), (Extent{4, 4}));
    EXPECT_EQ(read_raw(std::vector<std::byte>(32), "4x4,u16le")->remark, "");
    const auto odd = read_raw(std::vector<std::byte>(34), "", "h.r16");
    ASSERT_FALSE(odd);
    EXPECT_EQ(odd.error().code, ErrorCode::bad_data);
    EXPECT_EQ(odd.error().reason, "34 bytes are not a square of u16le; name its extent in the raw layout");
}

TEST(Raw, RefusesFilesOfAnotherLengthAndLayoutsThatMeanNothing) {
    const auto shorter = read_raw(std::vector<std::byte>(31), "4x4,u16le");
    ASSERT_FALSE(shorter);
    EXPECT_EQ(shorter.error().reason, "31 bytes, but the raw layout wants 32 bytes");
    EXPECT_FALSE(read_raw(std::vector<std::byte>(33), "4x4,u16le"));
    for (const char* layout : {"u16", "4x4", "4x,u8", "0x4,u8", "4x4,u8,-1", "4x4,u8,1,2", "4x4,,u8", "x", ",",
                               "99999999999x1,u8", "u8,99999999999999999999"}) {
        const auto wrong = read_raw(std::vector<std::byte>(16), layout);
        ASSERT_FALSE(wrong) << layout;
        EXPECT_EQ(wrong.error().code, ErrorCode::bad_option) << layout;
        EXPECT_FALSE(check_raw(layout)) << layout;
    }
    EXPECT_TRUE(check_raw("1025x1025,s16be,128"));
    EXPECT_TRUE(check_raw("f32le"));
}

TEST(Raw, WhatIsWrittenIsTheTexelsAndNothingElse) {
    Texture texture;
    texture.format = Format::r16_unorm;
    texture.levels.push_back({{2, 1}, bytes_of({1, 2, 3, 4})});
    const auto bytes = encode_file(texture, Container::r16);
    ASSERT_TRUE(bytes) << bytes.error().message();
    EXPECT_EQ(*bytes, bytes_of({1, 2, 3, 4}));
    EXPECT_FALSE(encode_file(texture, Container::r32));
    EXPECT_EQ(container_of("h.R16"), Container::r16);
}

TEST(Raw, ATerrainOfATerrainToolIsRead) {
    const std::string path = TEX_SOURCE_DIR "/../shared/data/wild/terrain.r16";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no ../shared/data/wild";
    const auto square = read_image(path);
    ASSERT_FALSE(square);
    EXPECT_EQ(square.error().reason, "3840 bytes are not a square of u16le; name its extent in the raw layout");
    ReadOptions options;
    options.raw = "48x40,u16le";
    const Result<Image> image = read_image(path, options);
    ASSERT_TRUE(image) << image.error().message();
    // By Python: struct.unpack_from("<H", bytes, 2 * (2 * 48 + 3)).
    EXPECT_EQ(image->planes[0].at(3, 2), 32913.0f / 65535.0f);
}

}  // namespace
}  // namespace tex
