// SPDX-License-Identifier: Apache-2.0

#include "formats/dds/dds.h"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tex/file.h>
#include <tex/pack.h>

#include "formats/bytes.h"
#include "formats/dds/dds_format.h"
#include "rows/codecs.h"
#include "unit/textures.h"

namespace tex {
namespace {

using Bytes = std::vector<std::byte>;
using testing::HasSubstr;

Result<Texture> decode_bytes(const Bytes& bytes, const ReadOptions& options = {}) {
    return read_texture(bytes, "test.dds", options);
}

Bytes encode(const Texture& texture, const WriteOptions& options = {}) {
    Result<Bytes> bytes = encode_file(texture, Container::dds, options);
    return bytes ? *bytes : Bytes{};
}

WriteOptions with_header(DdsHeader header) {
    WriteOptions options;
    options.dds_header = header;
    return options;
}

// A field of the header by its offset in the file.
std::uint32_t field(const Bytes& bytes, std::size_t offset) { return load_u32(bytes.data() + offset); }

void set_field(Bytes& bytes, std::size_t offset, std::uint32_t value) {
    for (std::size_t k = 0; k < 4; ++k) bytes[offset + k] = static_cast<std::byte>(value >> (8 * k) & 0xff);
}

constexpr std::size_t kHeightAt = 12, kWidthAt = 16, kPitchAt = 20, kMipsAt = 28, kFormatFlagsAt = 80, kFourCcAt = 84,
                      kBitCountAt = 88, kMasksAt = 92, kCapsAt = 108, kCaps2At = 112, kDxgiAt = 128;

// A DDS with the header of `format`, 8x8 and one level, which tests then change.
Bytes plain_file(Format format, DdsHeader header = DdsHeader::legacy) {
    return encode(patterned_texture(format, {8, 8}, 1), with_header(header));
}

std::string swizzle_after_code(const char (&code)[5]) {
    Bytes file = plain_file(Format::bc3_unorm);
    set_field(file, kBitCountAt, fourcc(code));
    const auto texture = decode_bytes(file);
    return texture && texture->swizzle_known ? to_string(texture->swizzle) : "unknown";
}

// -- round trips ----------------------------------------------------------------------------------------------

TEST(Dds, ReadsBackEveryFormatWithEitherHeader) {
    for (const auto& row : kFormatNames) {
        if (!can_hold(Container::dds, row.value)) continue;
        for (const DdsHeader header : {DdsHeader::legacy, DdsHeader::dx10}) {
            const Texture texture = patterned_texture(row.value, {13, 7}, 4);
            const auto read = decode_bytes(encode(texture, with_header(header)));
            ASSERT_TRUE(read) << row.name << ": " << read.error().message();
            EXPECT_THAT(read->remarks, testing::IsEmpty()) << row.name;
            ASSERT_EQ(read->levels.size(), 4u) << row.name;
            for (int k = 0; k < 4; ++k) {
                const auto before = decode(texture, k);
                const auto after = decode(*read, k);
                ASSERT_TRUE(before && after);
                // A widened texture has A = 1 in addition to the same colours.
                ASSERT_GE(after->planes.size(), before->planes.size()) << row.name;
                for (std::size_t c = 0; c < after->planes.size(); ++c) {
                    for (int j = 0; j < after->extent().height; ++j) {
                        for (int i = 0; i < after->extent().width; ++i) {
                            const float expected = c < before->planes.size() ? before->planes[c].at(i, j) : 1.0f;
                            ASSERT_EQ(after->planes[c].at(i, j), expected) << row.name << " level " << k;
                        }
                    }
                }
            }
        }
    }
}

TEST(Dds, KeepsTheOrderOfXAndYInBc5) {
    for (const auto encoding : {Encoding::bc5, Encoding::bc5_snorm}) {
        const Texture texture = encoded_texture(encoding, {8, 8}, 1);
        const auto read = decode_bytes(encode(texture));
        ASSERT_TRUE(read);
        EXPECT_EQ(read->swizzle, texture.swizzle);
        EXPECT_EQ(read->levels[0].bytes, texture.levels[0].bytes);
    }
}

TEST(Dds, TakesTheMarkOfNvidiasToolsForDxt5nm) {
    WriteOptions options;
    options.dds_mark = true;
    Texture texture = encoded_texture(Encoding::dxt5nm, {8, 8}, 1);
    texture.swizzle_known = false;  // no mark of libtex
    const Bytes file = encode(texture, options);
    EXPECT_EQ(field(file, kFormatFlagsAt), kDdpfFourCc | kDdpfNormal);
    EXPECT_EQ(field(file, kFourCcAt), fourcc("DXT5"));
    EXPECT_EQ(field(file, kBitCountAt), fourcc("A2D5"));
    const auto read = decode_bytes(file);
    ASSERT_TRUE(read);
    EXPECT_TRUE(read->swizzle_known);
    EXPECT_EQ(to_string(read->swizzle), "_y_x");
}

TEST(Dds, SetsEveryFlagThatTheFormatAsksFor) {
    const Bytes chain = encode(patterned_texture(Format::bc3_unorm, {16, 8}, 5));
    EXPECT_EQ(field(chain, 4), 124u);
    EXPECT_EQ(field(chain, 8), 0xa1007u);  // CAPS, HEIGHT, WIDTH, PIXELFORMAT, MIPMAPCOUNT, LINEARSIZE
    EXPECT_EQ(field(chain, kHeightAt), 8u);
    EXPECT_EQ(field(chain, kWidthAt), 16u);
    EXPECT_EQ(field(chain, kPitchAt), 128u);  // 4 x 2 blocks of 16 bytes
    EXPECT_EQ(field(chain, kMipsAt), 5u);
    EXPECT_EQ(field(chain, kCapsAt), 0x401008u);  // TEXTURE, COMPLEX, MIPMAP
    const Bytes single = encode(patterned_texture(Format::rgb8_unorm, {5, 3}, 1));
    EXPECT_EQ(field(single, 8), 0x2100fu);  // PITCH instead of LINEARSIZE
    EXPECT_EQ(field(single, kPitchAt), 15u);
    EXPECT_EQ(field(single, kCapsAt), 0x1000u);
}

// -- what others write ----------------------------------------------------------------------------------------

TEST(Dds, KnowsTheSwizzleCodesOfOtherTools) {
    EXPECT_EQ(swizzle_after_code("xGxR"), "_y_x");
    EXPECT_EQ(swizzle_after_code("A2D5"), "_y_x");
    EXPECT_EQ(swizzle_after_code("RxBG"), "x_zy");
    EXPECT_EQ(swizzle_after_code("RBxG"), "xz_y");
    EXPECT_EQ(swizzle_after_code("xRBG"), "_xzy");
    EXPECT_EQ(swizzle_after_code("xGBR"), "_yzx");
    EXPECT_EQ(swizzle_after_code("RGxB"), "xy_z");
    EXPECT_EQ(swizzle_after_code("GRXB"), "unknown");
}

TEST(Dds, ReadsSwizzleCodesInThePlaceOfTheFourCc) {
    Bytes file = plain_file(Format::bc3_unorm);
    set_field(file, kFourCcAt, fourcc("RXGB"));
    EXPECT_EQ(to_string(decode_bytes(file)->swizzle), "_yzx");
    set_field(file, kFourCcAt, fourcc("xGBR"));
    EXPECT_EQ(to_string(decode_bytes(file)->swizzle), "_yzx");
}

TEST(Dds, TakesAti2ForXFirstUnlessItSaysOtherwise) {
    Bytes file = plain_file(Format::bc5_unorm);
    EXPECT_EQ(to_string(decode_bytes(file)->swizzle), "xy01");
    set_field(file, kBitCountAt, 0);
    EXPECT_EQ(to_string(decode_bytes(file)->swizzle), "xy01");
    EXPECT_TRUE(decode_bytes(file)->order_open);
    EXPECT_FALSE(decode_bytes(file)->swizzle_known);
    set_field(file, kFourCcAt, fourcc("BC5U"));
    EXPECT_EQ(to_string(decode_bytes(file)->swizzle), "xy01");
}

// Masks, a texel such as 0x8421, and its expected values.
TEST(Dds, ReadsMasksOfAnyWidth) {
    struct Case {
        std::uint32_t flags, bits, r, g, b, a, texel;
        std::vector<float> values;
    };
    const Case cases[] = {
        {kDdpfRgb, 16, 0xf800, 0x7e0, 0x1f, 0, 0x8410, {16.0f / 31, 32.0f / 63, 16.0f / 31}},
        {kDdpfRgb | kDdpfAlphaPixels, 16, 0x7c00, 0x3e0, 0x1f, 0x8000, 0x8001, {0, 0, 1.0f / 31, 1}},
        {kDdpfRgb | kDdpfAlphaPixels,
         16,
         0xf00,
         0xf0,
         0xf,
         0xf000,
         0x1234,
         {2.0f / 15, 3.0f / 15, 4.0f / 15, 1.0f / 15}},
        {kDdpfRgb, 32, 0xff, 0xff00, 0xff0000, 0, 0x44332211, {17.0f / 255, 34.0f / 255, 51.0f / 255}},
        {kDdpfRgb | kDdpfAlphaPixels,
         32,
         0x3ff,
         0xffc00,
         0x3ff00000,
         0xc0000000,
         0x80000001,
         {1.0f / 1023, 0, 0, 2.0f / 3}},
        {kDdpfRgb, 32, 0xffff, 0xffff0000, 0, 0, 0x00020001, {1.0f / 65535, 2.0f / 65535}},
        {kDdpfLuminance, 8, 0xff, 0, 0, 0, 0x33, {0.2f}},
        {kDdpfLuminance, 16, 0xffff, 0, 0, 0, 0x3333, {0.2f}},
        {kDdpfLuminance | kDdpfAlphaPixels, 16, 0xff, 0, 0, 0xff00, 0x33ff, {1, 1, 1, 0.2f}},
        {kDdpfAlpha, 8, 0, 0, 0, 0xff, 0x33, {0.2f}},
        {kDdpfBumpDudv, 16, 0xff, 0xff00, 0, 0, 0x7f80, {-1, 1}},
        {kDdpfBumpDudv, 32, 0xff, 0xff00, 0xff0000, 0xff000000, 0x0081007f, {1, 0, -1, 0}},
    };
    for (const Case& c : cases) {
        Bytes file = plain_file(Format::rgba8_unorm);
        set_field(file, kHeightAt, 1);
        set_field(file, kWidthAt, 1);
        set_field(file, kFormatFlagsAt, c.flags);
        set_field(file, kBitCountAt, c.bits);
        const std::uint32_t masks[] = {c.r, c.g, c.b, c.a};
        for (std::size_t k = 0; k < 4; ++k) set_field(file, kMasksAt + 4 * k, masks[k]);
        set_field(file, 128, c.texel);
        const auto texture = decode_bytes(file);
        ASSERT_TRUE(texture) << texture.error().message();
        const auto image = decode(*texture, 0);
        ASSERT_EQ(image->planes.size(), c.values.size());
        for (std::size_t k = 0; k < c.values.size(); ++k) {
            EXPECT_NEAR(image->planes[k].at(0, 0), c.values[k], 0.5 / 65535) << std::hex << c.texel << " channel " << k;
        }
    }
}

TEST(Dds, OverlooksMissingFlagsAndSaysSo) {
    Bytes file = plain_file(Format::bc3_unorm);
    set_field(file, 8, 0);               // no CAPS, HEIGHT, WIDTH, PIXELFORMAT
    set_field(file, kFormatFlagsAt, 0);  // no FOURCC
    const auto texture = decode_bytes(file);
    ASSERT_TRUE(texture) << texture.error().message();
    EXPECT_THAT(texture->remarks, testing::ElementsAre(HasSubstr("flags are missing")));
}

TEST(Dds, ReadsTheLevelsThatAreThere) {
    Bytes file = encode(patterned_texture(Format::bc1_unorm, {16, 16}, 5));
    file.resize(file.size() - 12);  // half of the 2x2 level, all of the 1x1 level
    const auto texture = decode_bytes(file);
    ASSERT_TRUE(texture);
    EXPECT_EQ(texture->levels.size(), 3u);
    EXPECT_THAT(texture->remarks, testing::Contains(HasSubstr("the mip count is 5, the data end after 3")));
}

// -- what cannot be read ---------------------------------------------------------------------------------------

TEST(Dds, TellsUnsupportedFromDamaged) {
    const auto code_of = [](const Bytes& file) {
        const auto texture = decode_bytes(file);
        return texture ? std::string("read") : std::string(name_of(kErrorCodeNames, texture.error().code));
    };
    const auto changed = [](DdsHeader header, std::size_t offset, std::uint32_t value) {
        Bytes file = plain_file(Format::bc3_unorm, header);
        set_field(file, offset, value);
        return file;
    };
    const auto legacy = DdsHeader::legacy;
    const auto dx10 = DdsHeader::dx10;
    EXPECT_EQ(code_of(plain_file(Format::bc3_unorm)), "read");
    EXPECT_EQ(code_of(changed(legacy, kCaps2At, 0xfe00)), "unsupported");    // cube map
    EXPECT_EQ(code_of(changed(legacy, kCaps2At, 0x200000)), "unsupported");  // volume
    EXPECT_EQ(code_of(changed(dx10, kDxgiAt + 4, 4)), "unsupported");        // 3D
    EXPECT_EQ(code_of(changed(dx10, kDxgiAt + 8, 4)), "unsupported");        // cube map
    EXPECT_EQ(code_of(changed(dx10, kDxgiAt + 12, 2)), "unsupported");       // array
    EXPECT_EQ(code_of(changed(dx10, kDxgiAt, 98)), "read");                  // BC7
    EXPECT_EQ(code_of(changed(dx10, kDxgiAt, 67)), "unsupported");           // R9G9B9E5
    EXPECT_EQ(code_of(changed(legacy, kFourCcAt, fourcc("UYVY"))), "unsupported");
    EXPECT_EQ(code_of(changed(legacy, kWidthAt, 0)), "bad-data");
    EXPECT_EQ(code_of(changed(legacy, kHeightAt, 0xffffffff)), "unsupported");
    EXPECT_EQ(code_of(changed(legacy, kHeightAt, 100000)), "bad-data");
    EXPECT_EQ(code_of(changed(legacy, 4, 100)), "bad-data");
    EXPECT_EQ(code_of(changed(legacy, 76, 31)), "bad-data");
    EXPECT_EQ(code_of({}), "bad-data");
}

TEST(Dds, RejectsHeaderThatClaimsMoreThanTheFileHolds) {
    Bytes file = plain_file(Format::bc3_unorm);
    set_field(file, kWidthAt, 32768);
    set_field(file, kHeightAt, 32768);
    const auto texture = decode_bytes(file);
    ASSERT_FALSE(texture);
    EXPECT_EQ(texture.error().code, ErrorCode::bad_data);
    EXPECT_EQ(texture.error().message(), "test.dds: truncated: the base level wants 1073741824 bytes, 64 are left");
    ReadOptions options;
    options.max_texels = 1000;
    EXPECT_EQ(decode_bytes(file, options).error().code, ErrorCode::unsupported);
}

TEST(Dds, RejectsMasksThatMakeNoSense) {
    const std::array<std::uint32_t, 4> masks[] = {
        {0, 0, 0, 0}, {0xff00ff, 0xff00, 0, 0}, {0xff, 0xff00, 0xff000000, 0}, {0x1ffff, 0, 0, 0}};
    for (const auto& mask : masks) {
        Bytes file = plain_file(Format::rgb8_unorm);
        for (std::size_t k = 0; k < 4; ++k) set_field(file, kMasksAt + 4 * k, mask[k]);
        const auto texture = decode_bytes(file);
        ASSERT_FALSE(texture);
        EXPECT_EQ(texture.error().code, ErrorCode::bad_data);
    }
}

TEST(Dds, IsMemorySafeAtEveryTruncation) {
    for (const auto& row : kFormatNames) {
        if (!can_hold(Container::dds, row.value)) continue;
        const Bytes file = encode(patterned_texture(row.value, {9, 5}, 4), with_header(DdsHeader::dx10));
        for (std::size_t size = 0; size < file.size(); ++size) {
            const Bytes cut(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size));
            const auto texture = decode_bytes(cut);
            if (texture) {
                EXPECT_FALSE(texture->remarks.empty()) << row.name << " " << size;
            } else {
                EXPECT_EQ(texture.error().code, ErrorCode::bad_data) << row.name << " " << size;
            }
        }
    }
}

TEST(Dds, IsMemorySafeForEveryByteOfItsHeaderChanged) {
    for (const Format format : {Format::bc3_unorm, Format::rgb8_unorm, Format::rg16_unorm}) {
        const Bytes file = encode(patterned_texture(format, {9, 5}, 4));
        expect_safe_with_any_byte(file, 4, 148, [](const Bytes& changed) { return decode_bytes(changed); });
    }
}

}  // namespace
}  // namespace tex
