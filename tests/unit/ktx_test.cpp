// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx/ktx.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/file.h>
#include <tex/pack.h>

namespace tex {
namespace {

// A file as the specification lays it out, made without the reader's code.
class KtxFile {
public:
    KtxFile(std::uint32_t type, std::uint32_t type_bytes, std::uint32_t format, std::uint32_t internal_format,
            bool big_endian = false)
        : big_endian_(big_endian) {
        for (const char c : kKtxMagic) bytes_.push_back(static_cast<std::byte>(c));
        for (const std::uint32_t field : {0x04030201u, type, type_bytes, format, internal_format, format}) u32(field);
    }
    // Width, height, depth, elements, faces, levels, bytes of keys.
    KtxFile& sizes(const std::vector<std::uint32_t>& fields) {
        for (const std::uint32_t field : fields) u32(field);
        return *this;
    }
    KtxFile& u32(std::uint32_t value) {
        for (unsigned k = 0; k < 4; ++k)
            bytes_.push_back(static_cast<std::byte>(value >> 8 * (big_endian_ ? 3 - k : k) & 0xFF));
        return *this;
    }
    KtxFile& data(const std::string& text) {
        for (const char c : text) bytes_.push_back(static_cast<std::byte>(c));
        return *this;
    }
    [[nodiscard]] Result<Texture> read(const std::string& layer = {}) const {
        ReadOptions options;
        options.layer = layer;
        return read_texture(bytes_, "a.ktx", options);
    }
    [[nodiscard]] std::string reason() const {
        const auto texture = read();
        return texture ? "read" : texture.error().reason;
    }
    [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }

private:
    const bool big_endian_;
    std::vector<std::byte> bytes_;
};

std::string text_of(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(Ktx, FilesOfAnotherProgramAreTheMapThatTheyHold) {
    const std::string folder = TEX_SOURCE_DIR "/../shared/data/wild/tex/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no ../shared/data/wild";
    for (const auto& [ktx, dds] : {std::pair("ktx1_bc5.ktx", "bc5u.dds"), {"ktx1_rgb8.ktx", "rgb24_masks.dds"}}) {
        const auto texture = read_texture(folder + ktx), same = read_texture(folder + dds);
        ASSERT_TRUE(texture) << texture.error().message();
        ASSERT_TRUE(same) << same.error().message();
        EXPECT_EQ(texture->format, same->format);
        EXPECT_EQ(texture->extent(), same->extent());
        EXPECT_EQ(texture->levels[0].bytes, same->levels[0].bytes) << ktx;
    }
}

TEST(Ktx, RowsAreAlignedAndLevelsFollowEachOther) {
    const auto texture = KtxFile(0x1401, 1, 0x1907, 0x8051)
                             .sizes({3, 2, 0, 0, 1, 2, 0})
                             .u32(24)
                             .data("abcdefghi---jklmnopqr---")
                             .u32(4)
                             .data("xyz-")
                             .read();
    ASSERT_TRUE(texture) << texture.error().message();
    EXPECT_EQ(texture->format, Format::rgb8_unorm);
    EXPECT_EQ(text_of(texture->levels[0].bytes), "abcdefghijklmnopqr");
    EXPECT_EQ(text_of(texture->levels[1].bytes), "xyz");
    EXPECT_TRUE(texture->remarks.empty());
}

TEST(Ktx, BlueFirstAndRowsFromTheBottom) {
    const std::string key = std::string("KTXorientation\0S=r,T=u\0", 23);
    const auto texture = KtxFile(0x1401, 1, 0x80e1, 0x8c43)
                             .sizes({1, 2, 0, 0, 1, 1, 28})
                             .u32(23)
                             .data(key + "-")
                             .u32(8)
                             .data("bgraBGRA")
                             .read();
    ASSERT_TRUE(texture) << texture.error().message();
    EXPECT_TRUE(texture->srgb);
    EXPECT_EQ(text_of(texture->levels[0].bytes), "RGBArgba");
}

TEST(Ktx, EitherOrderOfBytesAndEverySample) {
    const auto big = KtxFile(0x1400, 1, 0x8227, 0x8f95, true).sizes({2, 1, 0, 0, 1, 0, 0}).u32(4).data("abcd").read();
    ASSERT_TRUE(big) << big.error().message();
    EXPECT_EQ(big->format, Format::rg8_snorm);
    EXPECT_EQ(text_of(big->levels[0].bytes), "abcd");
    const auto half = KtxFile(0x140b, 2, 0x1908, 0x881a).sizes({1, 1, 0, 0, 1, 1, 0}).u32(8).data("abcdefgh").read();
    ASSERT_TRUE(half) << half.error().message();
    EXPECT_EQ(half->format, Format::rgba16_float);
    const auto bc7 = KtxFile(0, 1, 0, 0x8e8d).sizes({4, 4, 0, 0, 1, 1, 0}).u32(16).data("@bcdefghijklmnop").read();
    ASSERT_TRUE(bc7) << bc7.error().message();
    EXPECT_EQ(bc7->format, Format::bc7_unorm);
    EXPECT_TRUE(bc7->srgb);
}

TEST(Ktx, LayersAndFaces) {
    KtxFile array(0x1401, 1, 0x1903, 0x8229);
    array.sizes({4, 1, 0, 2, 1, 2, 0}).u32(8).data("abcdABCD").u32(8).data("xy--XY--");
    const auto second = array.read("1");
    ASSERT_TRUE(second) << second.error().message();
    EXPECT_EQ(text_of(second->levels[0].bytes), "ABCD");
    EXPECT_EQ(text_of(second->levels[1].bytes), "XY");
    EXPECT_EQ(array.reason(), "a texture array of 2 layers; --layer 0 to 1 reads one");
    KtxFile cube(0x1401, 1, 0x1903, 0x8229);  // the size is that of one face
    cube.sizes({1, 1, 0, 0, 6, 1, 0}).u32(4).data("a---b---c---d---e---f---");
    const auto face = cube.read("5");
    ASSERT_TRUE(face) << face.error().message();
    EXPECT_EQ(text_of(face->levels[0].bytes), "f");
}

TEST(Ktx, RefusesWhatIsDamagedOrUnknown) {
    const auto rg8 = [](const std::vector<std::uint32_t>& sizes) {
        return KtxFile(0x1401, 1, 0x8227, 0x822b).sizes(sizes);
    };
    EXPECT_EQ(rg8({2, 1, 0, 0, 1, 1, 0}).u32(4).data("abc").reason(), "truncated: level 0 is not complete");
    EXPECT_EQ(rg8({2, 1, 0, 0, 1, 1, 0}).u32(5).data("abcde").reason(), "level 0 has 5 bytes instead of 4");
    EXPECT_EQ(rg8({2, 1, 0, 0, 1, 1, 0}).reason(), "truncated: level 0 is not complete");
    EXPECT_EQ(rg8({2, 1, 0, 0, 1, 3, 0}).reason(), "3 levels, a complete chain has 2");
    EXPECT_EQ(rg8({2, 1, 0, 0, 2, 1, 0}).reason(), "2 faces");
    EXPECT_EQ(rg8({2, 1, 4, 0, 1, 1, 0}).reason(), "volume textures are not supported");
    EXPECT_EQ(rg8({2, 0, 0, 0, 1, 1, 0}).reason(), "one-dimensional textures are not supported");
    EXPECT_EQ(rg8({2, 1, 0, 0, 1, 1, 0xFFFFFFF0}).reason(), "truncated: level 0 is not complete");
    EXPECT_EQ(rg8({2, 1, 0, 0xFFFFFFFF, 6, 1, 0}).u32(4).data("abcd").reason(),
              "cube maps with 25769803770 faces; --layer 0 to 25769803769 reads one for +X, -X, +Y, -Y, +Z, -Z");
    EXPECT_EQ(KtxFile(0x8363, 2, 0x1907, 0x8d62).sizes({2, 1, 0, 0, 1, 1, 0}).reason(),
              "glInternalFormat 36194 with glFormat 6407 and glType 33635 is not supported");
    EXPECT_EQ(KtxFile(0x1403, 2, 0x1903, 0x822a, true).sizes({2, 1, 0, 0, 1, 1, 0}).reason(),
              "big-endian texels are not supported");
    std::vector<std::byte> bytes = rg8({2, 1, 0, 0, 1, 1, 0}).u32(4).data("abcd").bytes();
    bytes[12] = std::byte{7};
    EXPECT_EQ(read_texture(bytes, "a").error().code, ErrorCode::bad_data);
    for (std::size_t size = 12; size < bytes.size(); ++size)
        EXPECT_FALSE(read_texture(std::span(bytes).first(size), "a"));
}

}  // namespace
}  // namespace tex
