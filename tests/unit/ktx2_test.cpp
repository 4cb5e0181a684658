// SPDX-License-Identifier: Apache-2.0

#include "formats/ktx2/ktx2.h"

#include <cstring>
#include <numeric>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tex/file.h>
#include <tex/format.h>
#include <tex/pack.h>

#include "formats/bytes.h"
#include "unit/textures.h"

namespace tex {
namespace {

using Bytes = std::vector<std::byte>;
using testing::HasSubstr;

Result<Texture> decode_bytes(const Bytes& bytes) { return read_texture(bytes, "test.ktx2"); }

Bytes encode(const Texture& texture) {
    Result<Bytes> bytes = encode_file(texture, Container::ktx2);
    return bytes ? *bytes : Bytes{};
}

std::uint32_t field(const Bytes& bytes, std::size_t offset) { return load_u32(bytes.data() + offset); }

void set_field(Bytes& bytes, std::size_t offset, std::uint32_t value) {
    for (std::size_t k = 0; k < 4; ++k) bytes[offset + k] = static_cast<std::byte>(value >> (8 * k) & 0xff);
}

constexpr std::size_t kVkFormatAt = 12, kWidthAt = 20, kHeightAt = 24, kDepthAt = 28, kLayersAt = 32, kFacesAt = 36,
                      kLevelsAt = 40, kSchemeAt = 44, kDescriptorAt = 48, kEntriesAt = 56, kLevel0At = 80;

// Replaces the value of `key` with `value`, padded to the length of the old one.
void set_value(Bytes& file, const std::string& key, const std::string& value) {
    for (std::size_t at = field(file, kEntriesAt); at + key.size() < file.size(); ++at) {
        if (std::memcmp(file.data() + at, key.data(), key.size()) != 0) continue;
        std::memcpy(file.data() + at + key.size() + 1, value.data(), value.size());
        return;
    }
    FAIL() << "no key " << key;
}

TEST(Ktx2, ReadsBackEveryFormatThatItWrites) {
    for (const auto& row : kFormatNames) {
        if (!can_hold(Container::ktx2, row.value)) continue;
        const Texture texture = patterned_texture(row.value, {13, 7}, 4);
        const auto read = decode_bytes(encode(texture));
        ASSERT_TRUE(read) << row.name << ": " << read.error().message();
        ASSERT_EQ(read->levels.size(), 4u);
        EXPECT_THAT(read->remarks, testing::IsEmpty());
        EXPECT_EQ(read->swizzle_known, row.value == Format::uastc_4x4_unorm) << "its descriptor says RGB";
        for (std::size_t k = 0; k < 4; ++k) {
            EXPECT_EQ(read->levels[k].extent, texture.levels[k].extent);
            if (read->format == texture.format) {
                EXPECT_EQ(read->levels[k].bytes, texture.levels[k].bytes) << row.name;
                continue;
            }
            // In a widened texture, every fourth channel is 1.
            const auto image = decode(*read, static_cast<int>(k));
            EXPECT_EQ(format_info(texture.format).channels, 3) << row.name;
            for (int i = 0; i < image->extent().width; ++i) EXPECT_EQ(image->planes[3].at(i, 0), 1.0f);
        }
    }
}

TEST(Ktx2, CarriesTheSwizzleAndY) {
    for (const auto& row : kEncodingNames) {
        for (const YAxis y : {YAxis::up, YAxis::down}) {
            Texture texture = encoded_texture(row.value, {8, 4}, 1);
            texture.y_axis = y;
            const auto read = decode_bytes(encode(texture));
            ASSERT_TRUE(read);
            EXPECT_TRUE(read->swizzle_known && read->y_known);
            EXPECT_EQ(layout_name(read->swizzle), layout_name(texture.swizzle)) << row.name;
            EXPECT_EQ(read->y_axis, y);
            EXPECT_EQ(read->normal_encoding, "signed");
        }
    }
}

TEST(Ktx2, AlignsLevelsAndStoresTheSmallestFirst) {
    for (const Format format : {Format::rgb8_unorm, Format::r8_unorm, Format::bc3_unorm, Format::rgba16_unorm}) {
        const Bytes file = encode(patterned_texture(format, {13, 7}, 4));
        const std::size_t alignment = std::lcm(format_info(format).block_bytes, std::size_t{4});
        std::size_t last_end = file.size();
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint64_t offset = load_u64(file.data() + kLevel0At + 24 * k);
            const std::uint64_t bytes = load_u64(file.data() + kLevel0At + 24 * k + 8);
            EXPECT_EQ(offset % alignment, 0u);
            EXPECT_LE(last_end - (offset + bytes), alignment - 1);  // only padding between levels
            EXPECT_EQ(bytes, load_u64(file.data() + kLevel0At + 24 * k + 16));
            last_end = offset;
        }
    }
}

TEST(Ktx2, ReadsRowsThatRunUpwards) {
    Bytes file = encode(patterned_texture(Format::rg8_unorm, {3, 5}, 1));
    const auto down = decode_bytes(file);
    set_value(file, "KTXorientation", "ru");
    const auto up = decode_bytes(file);
    ASSERT_TRUE(down && up);
    for (std::size_t j = 0; j < 5; ++j) {
        EXPECT_EQ(std::memcmp(&up->levels[0].bytes[6 * j], &down->levels[0].bytes[6 * (4 - j)], 6), 0);
    }
    Bytes blocks = encode(patterned_texture(Format::bc3_unorm, {4, 4}, 1));
    set_value(blocks, "KTXorientation", "ru");
    EXPECT_EQ(decode_bytes(blocks).error().code, ErrorCode::unsupported);
}

TEST(Ktx2, UnderstandsKtxSwizzle) {
    Texture texture = encoded_texture(Encoding::dxt5nm, {4, 4}, 1);
    Bytes file = encode(texture);
    // The key libtex.normal has 13 letters, KTXswizzle 10. Files with other keys are made by changing a key of ours.
    const std::string ours = "libtex.normal";
    const std::string theirs = std::string("KTXswizzle\0ag01\0", 16);
    for (std::size_t at = field(file, kEntriesAt); at < file.size() - ours.size(); ++at) {
        if (std::memcmp(file.data() + at, ours.data(), ours.size()) != 0) continue;
        set_field(file, at - 4, 16);
        std::memcpy(file.data() + at, theirs.data(), theirs.size());
        set_field(file, kEntriesAt + 4, field(file, kEntriesAt + 4) - 8);
        break;
    }
    const auto read = decode_bytes(file);
    ASSERT_TRUE(read);
    EXPECT_TRUE(read->swizzle_known);
    EXPECT_EQ(to_string(read->swizzle), "_y_x");
}

TEST(Ktx2, RemarksOnDamagedKeysAndReadsTheRest) {
    Bytes file = encode(encoded_texture(Encoding::dxt5nm, {4, 4}, 1));
    Bytes wrong = file;
    set_value(wrong, "libtex.normal", "dxt5mn");
    EXPECT_THAT(decode_bytes(wrong)->remarks, testing::ElementsAre(HasSubstr("libtex.normal was not understood")));
    set_field(file, field(file, kEntriesAt), 0xfffffff0);
    const auto read = decode_bytes(file);
    ASSERT_TRUE(read);
    EXPECT_FALSE(read->swizzle_known);
    EXPECT_THAT(read->remarks, testing::ElementsAre(HasSubstr("key/value data are damaged")));
}

TEST(Ktx2, TellsUnsupportedFromDamaged) {
    const auto code_with = [](std::size_t offset, std::uint32_t value) {
        Bytes file = encode(patterned_texture(Format::bc3_unorm, {8, 8}, 2));
        set_field(file, offset, value);
        const auto texture = decode_bytes(file);
        return texture ? std::string("read") : std::string(name_of(kErrorCodeNames, texture.error().code));
    };
    EXPECT_EQ(code_with(kWidthAt, 8), "read");
    EXPECT_EQ(code_with(kVkFormatAt, 0), "unsupported");    // undefined
    EXPECT_EQ(code_with(kVkFormatAt, 138), "read");         // BC3 as sRGB
    EXPECT_EQ(code_with(kVkFormatAt, 145), "bad-data");     // BC7, but the descriptor says BC3
    EXPECT_EQ(code_with(kVkFormatAt, 147), "unsupported");  // ETC2
    EXPECT_EQ(code_with(kSchemeAt, 1), "bad-data");         // BasisLZ has no VkFormat
    EXPECT_EQ(code_with(kFacesAt, 6), "unsupported");       // no face is chosen
    EXPECT_EQ(code_with(kFacesAt, 0), "bad-data");
    EXPECT_EQ(code_with(kDepthAt, 2), "unsupported");
    EXPECT_EQ(code_with(kLayersAt, 2), "unsupported");
    EXPECT_EQ(code_with(kHeightAt, 0), "unsupported");  // one-dimensional
    EXPECT_EQ(code_with(kWidthAt, 0), "bad-data");
    EXPECT_EQ(code_with(kWidthAt, 16), "bad-data");
    EXPECT_EQ(code_with(kWidthAt, 0x80000000u), "unsupported");
    EXPECT_EQ(code_with(kLevelsAt, 5), "bad-data");
    EXPECT_EQ(code_with(kLevelsAt, 0xffffffffu), "bad-data");
    EXPECT_EQ(code_with(kLevel0At + 4, 0xffffffffu), "bad-data");  // the offset overflows
    EXPECT_EQ(code_with(kLevel0At + 8, 63), "bad-data");
}

TEST(Ktx2, TellsWhatAFileWithoutVkFormatHolds) {
    const auto reason = [](int model, int channel) {
        Bytes file = encode(patterned_texture(Format::bc5_unorm, {8, 8}, 1));
        const auto descriptor = std::to_integer<std::size_t>(file[48]);
        set_field(file, kVkFormatAt, 0);
        file[descriptor + 12] = static_cast<std::byte>(model);
        file[descriptor + 31] = static_cast<std::byte>(channel);
        return decode_bytes(file).error().reason;
    };
    EXPECT_EQ(reason(132, 0),
              "its data format descriptor says BC5, but VkFormat is 0, undefined; export the texture with a VkFormat");
    EXPECT_THAT(reason(99, 0), HasSubstr("colour model 99"));
    EXPECT_THAT(reason(0, 0), HasSubstr("neither VkFormat nor a data format descriptor"));
}

// A file whose descriptor was changed; `at` counts from the first byte of the descriptor.
class Ktx2Descriptors : public testing::Test {
protected:
    explicit Ktx2Descriptors(Format format = Format::bc5_unorm) : file_(encode(patterned_texture(format, {8, 8}, 1))) {}
    std::byte& at(std::size_t offset) { return file_[field(file_, kDescriptorAt) + offset]; }
    [[nodiscard]] std::string refusal() const {
        const auto read = decode_bytes(file_);
        if (read) return "none";
        EXPECT_EQ(read.error().code, ErrorCode::bad_data);
        return read.error().reason;
    }
    [[nodiscard]] std::vector<std::string> remarks() const {
        const auto read = decode_bytes(file_);
        return read ? read->remarks : std::vector<std::string>{read.error().message()};
    }
    void use(Format format) { file_ = encode(patterned_texture(format, {8, 8}, 1)); }

    static constexpr std::size_t kModel = 12, kPrimaries = 13, kTransfer = 14, kFlags = 15, kEdges = 16, kBytes = 20;
    Bytes file_;
};

TEST_F(Ktx2Descriptors, AreRefusedIfTheyContradictTheVkFormat) {
    set_field(file_, kVkFormatAt, 155);
    EXPECT_EQ(refusal(),
              "its data format descriptor says BC5, but VkFormat 155 is eac-rg11-unorm; export the texture again");
    use(Format::astc_6x6_unorm);
    at(kEdges) = at(kEdges + 1) = std::byte{3};
    EXPECT_THAT(refusal(), HasSubstr("blocks of 4x4 texels, but VkFormat 165 is astc-6x6-unorm"));
    use(Format::bc5_unorm);
    at(kBytes) = std::byte{8};
    EXPECT_THAT(refusal(), HasSubstr("8 bytes for each block, but VkFormat 141 is bc5-unorm, with 16"));
    use(Format::rgba8_unorm);
    at(kBytes) = std::byte{3};
    EXPECT_THAT(refusal(), HasSubstr("3 bytes for each texel, but VkFormat 37 is rgba8-unorm, with 4"));
    use(Format::rgba8_unorm);
    at(kModel) = std::byte{134};
    EXPECT_THAT(refusal(), HasSubstr("says BC7, but VkFormat 37 is rgba8-unorm"));
}

// Other writers leave fields open, and get some wrong that say nothing about where texels are.
TEST_F(Ktx2Descriptors, MayLeaveFieldsOpen) {
    for (const Format format : {Format::bc5_unorm, Format::rgba8_unorm}) {
        use(format);
        at(kBytes) = std::byte{0};
        at(kPrimaries) = std::byte{1};
        at(kTransfer) = std::byte{0};
        at(kFlags) = std::byte{1};
        at(30) = std::byte{200};  // the length of a sample
        EXPECT_THAT(remarks(), testing::IsEmpty());
        at(kModel) = std::byte{0};
        at(kEdges) = at(kEdges + 1) = std::byte{0};
        EXPECT_THAT(remarks(), testing::IsEmpty());
    }
    at(kModel) = std::byte{6};  // XYZW: texels all the same
    EXPECT_THAT(remarks(), testing::IsEmpty());
}

TEST_F(Ktx2Descriptors, ThatAreMissingOrDamagedAreTold) {
    const Bytes whole = file_;
    set_field(file_, kDescriptorAt + 4, 0);
    EXPECT_THAT(remarks(), testing::ElementsAre("there is no data format descriptor"));
    EXPECT_EQ(decode_bytes(file_)->trailing_bytes, 0u);
    for (const std::uint32_t offset : {5u, 0xfffffff0u}) {
        file_ = whole;
        set_field(file_, kDescriptorAt, offset);
        EXPECT_THAT(remarks(), testing::ElementsAre("the data format descriptor is damaged and was not read"));
    }
    for (const std::uint32_t bytes : {1u, 27u, 44u, 0xffffffffu}) {
        file_ = whole;
        set_field(file_, kDescriptorAt + 4, bytes);
        EXPECT_THAT(remarks(), testing::ElementsAre("the data format descriptor is damaged and was not read"));
    }
}

TEST_F(Ktx2Descriptors, ThatDisagreeAboutSrgbAreTold) {
    at(kTransfer) = std::byte{2};
    auto read = decode_bytes(file_);
    ASSERT_TRUE(read);
    EXPECT_TRUE(read->srgb);
    EXPECT_THAT(read->remarks, testing::ElementsAre("the data format descriptor says sRGB, but VkFormat 141 does not"));
    use(Format::rgba8_unorm);
    set_field(file_, kVkFormatAt, 43);
    read = decode_bytes(file_);
    ASSERT_TRUE(read);
    EXPECT_TRUE(read->srgb);
    EXPECT_THAT(read->remarks,
                testing::ElementsAre("VkFormat 43 says sRGB, but the data format descriptor says linear"));
    at(kTransfer) = std::byte{2};
    EXPECT_THAT(remarks(), testing::IsEmpty());
}

TEST(Ktx2, TellsASecondSizeThatDiffers) {
    Bytes file = encode(patterned_texture(Format::bc5_unorm, {16, 16}, 3));
    set_field(file, kLevel0At + 24 + 16, 1);
    EXPECT_THAT(decode_bytes(file)->remarks,
                testing::ElementsAre("level 1 claims 1 bytes when uncompressed; without supercompression, it has 64"));
}

TEST(Ktx2, CountsBytesBeyondItsLevels) {
    const Bytes whole = encode(patterned_texture(Format::bc5_unorm, {16, 16}, 4));
    EXPECT_EQ(decode_bytes(whole)->trailing_bytes, 0u);
    Bytes file = whole;
    set_field(file, kLevelsAt, 1);
    const std::uint64_t before =
        load_u64(file.data() + kLevel0At) - field(file, kEntriesAt) - field(file, kEntriesAt + 4);
    EXPECT_EQ(decode_bytes(file)->trailing_bytes, before + 3 * 24);  // three levels, and their entries in the index
    file = whole;
    file.resize(whole.size() + 15, std::byte{1});
    EXPECT_EQ(decode_bytes(file)->trailing_bytes, 0u);
    file.resize(whole.size() + 16, std::byte{1});
    EXPECT_EQ(decode_bytes(file)->trailing_bytes, 16u);
    file.resize(whole.size() + 100000, std::byte{0});
    EXPECT_EQ(decode_bytes(file)->trailing_bytes, 100000u);
}

// Levels that begin at pages are padded, as those of some writers.
TEST(Ktx2, TakesZerosBetweenLevelsForPadding) {
    Bytes file = encode(patterned_texture(Format::bc5_unorm, {16, 16}, 1));
    constexpr std::size_t kPage = 4096;
    const auto level = static_cast<std::ptrdiff_t>(load_u64(file.data() + kLevel0At));
    file.insert(file.begin() + level, kPage, std::byte{0});
    set_field(file, kLevel0At, static_cast<std::uint32_t>(level) + kPage);
    const auto read = decode_bytes(file);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->trailing_bytes, 0u);
    EXPECT_THAT(read->remarks, testing::IsEmpty());
}

TEST(Ktx2, RejectsEveryTruncation) {
    const Bytes file = encode(encoded_texture(Encoding::rgb8, {9, 5}, 4));
    for (std::size_t size = 0; size < file.size(); ++size) {
        const Bytes cut(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size));
        const auto texture = decode_bytes(cut);
        ASSERT_FALSE(texture) << size;
        EXPECT_EQ(texture.error().code, ErrorCode::bad_data) << size;
    }
}

TEST(Ktx2, IsMemorySafeForEveryByteOfItsHeadChanged) {
    const Bytes file = encode(encoded_texture(Encoding::dxt5nm, {9, 5}, 4));
    const std::size_t head = ktx2_layout(head_of(encoded_texture(Encoding::dxt5nm, {9, 5}, 4))).head.size();
    expect_safe_with_any_byte(file, 12, head, [](const Bytes& changed) { return decode_bytes(changed); });
}

}  // namespace
}  // namespace tex
