// SPDX-License-Identifier: Apache-2.0

#include <tex/pack.h>

#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "blocks/bc1.h"
#include "blocks/bc4.h"
#include "blocks/eac.h"
#include "kernels/decode.h"
#include "unit/fields.h"
#include "unit/textures.h"

namespace tex {
namespace {

template <class T>
Texture texture_of(Format format, Extent extent, const std::vector<T>& values) {
    Texture texture;
    texture.format = format;
    Level level{extent, std::vector<std::byte>(level_bytes(format, extent))};
    EXPECT_EQ(level.bytes.size(), values.size() * sizeof(T));
    std::memcpy(level.bytes.data(), values.data(), level.bytes.size());
    texture.levels.push_back(std::move(level));
    return texture;
}

Swizzle swizzle_from(const std::string& text) {
    Swizzle swizzle;
    for (std::size_t c = 0; c < 4; ++c) swizzle[c] = *find_by_name(kComponentNames, text.substr(c, 1));
    return swizzle;
}

struct Vector {
    float x, y, z;
};

Vector at(const NormalMap& map, int i, int j) { return {map.x.at(i, j), map.y.at(i, j), map.z.at(i, j)}; }

Vector first_of(const Texture& texture, const UnpackOptions& options = {}) {
    const auto chain = unpack(texture, options);
    EXPECT_TRUE(chain) << chain.error().message();
    return chain ? at(chain->levels[0], 0, 0) : Vector{};
}

void expect_near(Vector n, Vector expected, float tolerance = 1e-6f) {
    EXPECT_NEAR(n.x, expected.x, tolerance);
    EXPECT_NEAR(n.y, expected.y, tolerance);
    EXPECT_NEAR(n.z, expected.z, tolerance);
}

// -- decode --------------------------------------------------------------------------------------------------

TEST(Decode, DividesCodesByTheirGreatest) {
    const auto r8 = decode(texture_of<std::uint8_t>(Format::r8_unorm, {3, 1}, {0, 51, 255}), 0);
    EXPECT_EQ(r8->planes[0].at(0, 0), 0.0f);
    EXPECT_EQ(r8->planes[0].at(1, 0), 0.2f);
    EXPECT_EQ(r8->planes[0].at(2, 0), 1.0f);
    const auto r16 = decode(texture_of<std::uint16_t>(Format::r16_unorm, {2, 1}, {13107, 65535}), 0);
    EXPECT_EQ(r16->planes[0].at(0, 0), 0.2f);
    EXPECT_EQ(r16->planes[0].at(1, 0), 1.0f);
    const auto snorm = decode(texture_of<std::int8_t>(Format::rg8_snorm, {2, 1}, {-128, -127, 127, 0}), 0);
    EXPECT_EQ(snorm->planes[0].at(0, 0), -1.0f);
    EXPECT_EQ(snorm->planes[1].at(0, 0), -1.0f);
    EXPECT_EQ(snorm->planes[0].at(1, 0), 1.0f);
    EXPECT_EQ(snorm->planes[1].at(1, 0), 0.0f);
    const auto half = decode(texture_of<std::uint16_t>(Format::r16_float, {2, 1}, {0x3c00, 0xb800}), 0);
    EXPECT_EQ(half->planes[0].at(0, 0), 1.0f);
    EXPECT_EQ(half->planes[0].at(1, 0), -0.5f);
}

TEST(Decode, NamesPlanesByChannelsAndTellsTheirKind) {
    for (const auto& row : kFormatNames) {
        const auto image = decode(patterned_texture(row.value, {5, 3}, 1), 0);
        ASSERT_TRUE(image);
        const FormatInfo info = format_info(row.value);
        ASSERT_EQ(image->planes.size(), static_cast<std::size_t>(info.channels));
        EXPECT_EQ(image->names.front(), "R");
        EXPECT_EQ(image->names.size(), image->planes.size());
        EXPECT_EQ(image->sample, info.sample);
        EXPECT_EQ(image->bits, info.bits);
        EXPECT_EQ(image->extent(), (Extent{5, 3}));
    }
}

// Compares every texel of every block with the blocks' own decoders, to the last bit, at sizes near the widths of
// vectors.
TEST(Decode, AgreesWithTheBlockDecodersToTheLastBit) {
    for (const Format format : {Format::bc1_unorm, Format::bc2_unorm, Format::bc3_unorm, Format::bc4_unorm,
                                Format::bc4_snorm, Format::bc5_unorm, Format::bc5_snorm, Format::eac_r11_unorm,
                                Format::eac_r11_snorm, Format::eac_rg11_unorm, Format::eac_rg11_snorm}) {
        for (const Extent extent : {Extent{1, 1}, {2, 5}, {15, 4}, {16, 3}, {17, 9}, {33, 1}, {257, 66}}) {
            const Texture texture = patterned_texture(format, extent, 1);
            const auto image = decode(texture, 0);
            ASSERT_TRUE(image);
            const std::size_t block_bytes = format_info(format).block_bytes;
            for (int j = 0; j < extent.height; ++j) {
                for (int i = 0; i < extent.width; ++i) {
                    const std::size_t index = static_cast<std::size_t>(j / 4 * ((extent.width + 3) / 4) + i / 4);
                    const std::byte* block = texture.levels[0].bytes.data() + index * block_bytes;
                    float channel[4][16];
                    const bool color =
                        format == Format::bc1_unorm || format == Format::bc2_unorm || format == Format::bc3_unorm;
                    if (color) {
                        decode_bc1(block + block_bytes - 8,
                                   format == Format::bc1_unorm ? Bc1Mode::standard : Bc1Mode::four_colors, channel[0],
                                   channel[1], channel[2], channel[3]);
                        if (format == Format::bc2_unorm) decode_bc2_alpha(block, channel[3]);
                        if (format == Format::bc3_unorm) decode_bc4_unorm(block, channel[3]);
                    } else {
                        const bool is_signed = format_info(format).sample == SampleKind::snorm;
                        const bool is_eac = format_info(format).bits == 11;
                        for (std::size_t c = 0; c < block_bytes / 8; ++c) {
                            if (is_eac)
                                (is_signed ? decode_eac_snorm : decode_eac_unorm)(block + 8 * c, channel[c]);
                            else
                                (is_signed ? decode_bc4_snorm : decode_bc4_unorm)(block + 8 * c, channel[c]);
                        }
                    }
                    for (std::size_t c = 0; c < image->planes.size(); ++c) {
                        ASSERT_EQ(image->planes[c].at(i, j), channel[c][j % 4 * 4 + i % 4])
                            << name_of(kFormatNames, format) << " " << i << "," << j << " channel " << c;
                    }
                }
            }
        }
    }
}

// -- unpack --------------------------------------------------------------------------------------------------

TEST(Unpack, ReadsComponentsWhereTheSwizzleHasThem) {
    Texture texture = texture_of<std::uint8_t>(Format::rgba8_unorm, {1, 1}, {255, 128, 255, 0});
    texture.swizzle = swizzle_from("xyz_");
    const float length = std::sqrt(2.0f + 1.0f / 255 / 255);
    expect_near(first_of(texture), {1 / length, 1 / 255.0f / length, 1 / length});
    UnpackOptions options;
    options.swizzle = swizzle_from("1y1x");
    const float xy = std::sqrt(1 + 1.0f / 255 / 255);
    expect_near(first_of(texture, options), {-1 / xy, 1 / 255.0f / xy, 0});
    options.swizzle = swizzle_from("yyyx");  // y three times: the first one is used
    expect_near(first_of(texture, options), {-std::sqrt(0.5f), std::sqrt(0.5f), 0});
}

TEST(Unpack, ReconstructsZWithTheClamp) {
    Texture texture = texture_of<float>(Format::rg32_float, {3, 1}, {0.6f, 0.0f, 0.6f, -0.8f, 3.0f, 4.0f});
    texture.swizzle = swizzle_from("xy01");
    const auto chain = unpack(texture);
    ASSERT_TRUE(chain);
    expect_near(at(chain->levels[0], 0, 0), {0.6f, 0.0f, 0.8f});
    expect_near(at(chain->levels[0], 1, 0), {0.6f, -0.8f, 0.0f}, 4e-4f);
    expect_near(at(chain->levels[0], 2, 0), {0.6f, 0.8f, 0.0f});
}

TEST(Unpack, FlipsYOfTexturesThatPointDown) {
    Texture texture = texture_of<float>(Format::rg32_float, {1, 1}, {0.0f, -0.6f});
    texture.swizzle = swizzle_from("xy01");
    expect_near(first_of(texture), {0, -0.6f, 0.8f});
    texture.y_axis = YAxis::down;
    expect_near(first_of(texture), {0, 0.6f, 0.8f});
    UnpackOptions options;
    options.y_axis = YAxis::up;
    expect_near(first_of(texture, options), {0, -0.6f, 0.8f});
}

TEST(Unpack, SnapsFlatCodesOnlyWhenAsked) {
    for (const std::uint8_t code : {std::uint8_t{127}, std::uint8_t{128}}) {
        Texture texture = texture_of<std::uint8_t>(Format::rg8_unorm, {1, 1}, {code, code});
        texture.swizzle = swizzle_from("xy01");
        EXPECT_NEAR(first_of(texture).x, code == 127 ? -1 / 255.0f : 1 / 255.0f, 1e-6f);
        UnpackOptions options;
        options.snap_flat = true;
        const Vector n = first_of(texture, options);
        EXPECT_EQ(n.x, 0.0f);
        EXPECT_EQ(n.y, 0.0f);
        EXPECT_EQ(n.z, 1.0f);
    }
    UnpackOptions options;
    options.snap_flat = true;
    Texture next = texture_of<std::uint8_t>(Format::rg8_unorm, {1, 1}, {126, 129});
    next.swizzle = swizzle_from("xy01");
    EXPECT_NE(first_of(next, options).x, 0.0f);
    EXPECT_NE(first_of(next, options).y, 0.0f);
    Texture wide = texture_of<std::uint16_t>(Format::rg16_unorm, {1, 1}, {32767, 32768});
    wide.swizzle = swizzle_from("xy01");
    EXPECT_NE(first_of(wide, options).x, 0.0f);
}

TEST(Unpack, NormalisesUnlessAskedNotTo) {
    Texture texture = texture_of<float>(Format::rgb32_float, {2, 1}, {0.0f, -3.0f, 4.0f, 1e-7f, 0.0f, -1e-7f});
    texture.swizzle = swizzle_from("xyz1");
    const auto chain = unpack(texture);
    expect_near(at(chain->levels[0], 0, 0), {0, -0.6f, 0.8f});
    expect_near(at(chain->levels[0], 1, 0), {0, 0, 1});  // too short to have a direction
    UnpackOptions options;
    options.keep_length = true;
    const auto kept = unpack(texture, options);
    expect_near(at(kept->levels[0], 0, 0), {0, -3, 4}, 0);
    expect_near(at(kept->levels[0], 1, 0), {1e-7f, 0, -1e-7f}, 0);
}

TEST(Unpack, KeepsZBelowZeroAsStored) {
    Texture texture = texture_of<float>(Format::rgb32_float, {1, 1}, {0.6f, 0.0f, -0.8f});
    texture.swizzle = swizzle_from("xyz1");
    expect_near(first_of(texture), {0.6f, 0, -0.8f});
}

TEST(Unpack, MakesFlatWhatIsNotFinite) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const bool has_z : {false, true}) {
        for (const bool keep_length : {false, true}) {
            Texture texture = texture_of<float>(Format::rgb32_float, {3, 1},
                                                {kNan, 0.0f, 1.0f, 0.0f, -kInfinity, 1.0f, 1e30f, 0.0f, 1.0f});
            texture.swizzle = swizzle_from(has_z ? "xyz1" : "xy_1");
            UnpackOptions options;
            options.keep_length = keep_length;
            const auto chain = unpack(texture, options);
            ASSERT_TRUE(chain);
            for (int i = 0; i < 3; ++i) expect_near(at(chain->levels[0], i, 0), {0, 0, 1}, 0);
            options.keep_invalid = true;
            const auto kept = unpack(texture, options);
            ASSERT_TRUE(kept);
            for (int i = 0; i < 3; ++i) EXPECT_TRUE(std::isnan(kept->levels[0].z.at(i, 0))) << i;
        }
    }
}

TEST(Unpack, TellsSignedFloatsFromUnsignedOnes) {
    const auto rgb = [](std::vector<float> values) {
        Texture texture = texture_of<float>(Format::rgb32_float, {static_cast<int>(values.size()) / 3, 1}, values);
        texture.swizzle = swizzle_from("xyz1");
        return texture;
    };
    expect_near(first_of(rgb({0.5f, 0.5f, 1.0f})), {0, 0, 1});        // unsigned flat
    expect_near(first_of(rgb({0.0f, 0.0f, 1.0f})), {0, 0, 1});        // signed flat
    expect_near(first_of(rgb({0.6f, 0.0f, 0.8f})), {0.6f, 0, 0.8f});  // leans to the right only
    expect_near(first_of(rgb({0.8f, 0.5f, 0.9f})), {0.6f, 0, 0.8f});  // the same, unsigned
    expect_near(first_of(rgb({0.5f, 0.5f, 0.5f, -0.1f, 0.0f, 1.0f})), {0.57735f, 0.57735f, 0.57735f}, 1e-5f);
    Texture told = rgb({0.0f, 0.0f, 1.0f});
    told.normal_encoding = "unsigned";
    expect_near(first_of(told), {-0.57735f, -0.57735f, 0.57735f}, 1e-5f);
    UnpackOptions options;
    options.range = ValueRange::signed_;
    expect_near(first_of(told, options), {0, 0, 1});
    Texture xy = texture_of<float>(Format::rg32_float, {1, 1}, {0.0f, 0.0f});
    xy.swizzle = swizzle_from("xy01");
    expect_near(first_of(xy), {0, 0, 1});
}

TEST(Unpack, RefusesSwizzlesWithoutXOrY) {
    const Texture texture = texture_of<std::uint8_t>(Format::rg8_unorm, {1, 1}, {128, 128});
    UnpackOptions options;
    for (const char* swizzle : {"_y01", "x_z1", "1y1x", "xyz1"}) {
        options.swizzle = swizzle_from(swizzle);
        const auto chain = unpack(texture, options);
        ASSERT_FALSE(chain) << swizzle;
        EXPECT_EQ(chain.error().code, ErrorCode::bad_option);
    }
}

TEST(Unpack, ReadsPicturesByTheNamesOfTheirPlanes) {
    const auto picture = [](std::vector<std::string> names, std::vector<float> values) {
        Image image;
        image.names = std::move(names);
        for (const float value : values) image.planes.emplace_back(Extent{1, 1}, value);
        return image;
    };
    const auto first = [](const Image& image, const UnpackOptions& options = {}) {
        const auto map = unpack(image, options);
        EXPECT_TRUE(map) << map.error().message();
        return map ? at(*map, 0, 0) : Vector{};
    };
    expect_near(first(picture({"R", "G", "B"}, {0.8f, 0.5f, 0.9f})), {0.6f, 0, 0.8f});
    expect_near(first(picture({"A", "B", "G", "R"}, {0.1f, 0.9f, 0.5f, 0.8f})), {0.6f, 0, 0.8f});
    expect_near(first(picture({"X", "Y_"}, {0.8f, 0.5f})), {0.6f, 0, 0.8f});
    expect_near(first(picture({"nx", "ny", "nz"}, {0.8f, 0.5f, 0.9f})), {0.6f, 0, 0.8f});
    UnpackOptions options;
    options.swizzle = swizzle_from("yyyx");
    expect_near(first(picture({"Y", "A"}, {0.5f, 0.8f}), options), {0.6f, 0, 0.8f});  // grey and alpha
    EXPECT_EQ(unpack(picture({"Y"}, {0.5f}), options).error().code, ErrorCode::bad_option);
    Image half = picture({"R", "G", "B"}, {0.0f, 0.0f, 1.0f});
    half.sample = SampleKind::floating;
    half.normal_encoding = "unsigned";
    expect_near(first(half), {-0.57735f, -0.57735f, 0.57735f}, 1e-5f);
}

// Equal bytes on every target, with every number of threads and with every kind of row end.
TEST(Unpack, GivesTheSameBytesEverywhere) {
    for (const auto& row : kFormatNames) {
        if (format_info(row.value).channels < 2) continue;
        for (const int width : {1, 2, 15, 16, 17, 33, 257}) {
            Texture texture = patterned_texture(row.value, {width, 19}, 3);
            texture.swizzle = swizzle_from(format_info(row.value).channels == 2 ? "xy01" : "xyz_");
            UnpackOptions options;
            options.snap_flat = true;
            std::optional<std::uint64_t> expected;
            for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
                hwy::SetSupportedTargetsForTest(target);
                for (const int threads : {1, 3}) {
                    Execution execution;
                    execution.threads = threads;
                    const auto chain = unpack(texture, options, execution);
                    ASSERT_TRUE(chain);
                    if (!expected) expected = fields::hash_of(*chain);
                    EXPECT_EQ(fields::hash_of(*chain), *expected) << row.name << " " << hwy::TargetName(target);
                }
            }
            hwy::SetSupportedTargetsForTest(0);
        }
    }
}

TEST(Unpack, StopsWhenItIsCancelled) {
    Execution execution;
    execution.progress = [](double) { return false; };
    Texture texture = patterned_texture(Format::bc3_unorm, {64, 64}, 7);
    texture.swizzle = swizzle_from("1y1x");
    EXPECT_EQ(unpack(texture, {}, execution).error().code, ErrorCode::cancelled);
    EXPECT_EQ(decode(texture, 0, execution).error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace tex
