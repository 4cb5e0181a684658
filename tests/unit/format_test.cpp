// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>
#include <tex/format.h>

#include <cmath>
#include <set>
#include <string>
#include <string_view>

namespace tex {
namespace {

TEST(Format, HasOneNameAndSoundFactsForEachFormat) {
    std::set<std::string_view> names;
    for (const auto& row : kFormatNames) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        const FormatInfo info = format_info(row.value);
        EXPECT_TRUE(info.channels >= 1 && info.channels <= 4) << row.name;
        if (row.name.substr(0, 5) == "astc-") {
            EXPECT_EQ("astc-" + std::to_string(info.block.width) + "x" + std::to_string(info.block.height) + "-unorm",
                      row.name);
        } else {
            EXPECT_EQ(info.block, info.has_blocks() ? (Extent{4, 4}) : (Extent{1, 1})) << row.name;
        }
        if (!info.has_blocks()) {
            EXPECT_EQ(info.block_bytes * 8, static_cast<std::size_t>(info.channels * info.bits)) << row.name;
        }
    }
    // The table includes the last format of the enum.
    EXPECT_EQ(format_info(Format::etc1s_rgba_unorm).block_bytes, 16u);
    EXPECT_EQ(name_of(kFormatNames, Format::etc1s_rgba_unorm), "etc1s-rgba-unorm");
}

TEST(Format, IsFoundByItsSamples) {
    for (const auto& row : kFormatNames) {
        const FormatInfo info = format_info(row.value);
        if (!info.has_blocks()) {
            EXPECT_EQ(format_of(info.sample, info.bits, info.channels), row.value) << row.name;
        }
    }
    EXPECT_EQ(format_of(SampleKind::snorm, 8, 3), std::nullopt);
    EXPECT_EQ(format_of(SampleKind::floating, 8, 1), std::nullopt);
}

TEST(Format, RoundsBlocksUpAndDoesNotOverflow) {
    EXPECT_EQ(level_bytes(Format::bc3_unorm, {1, 1}), 16u);
    EXPECT_EQ(level_bytes(Format::bc3_unorm, {5, 7}), 4u * 16u);
    EXPECT_EQ(level_bytes(Format::bc1_unorm, {8, 4}), 16u);
    EXPECT_EQ(level_bytes(Format::rgb8_unorm, {5, 7}), 105u);
    EXPECT_EQ(level_bytes(Format::rgba32_float, {kMaxExtent, kMaxExtent}), std::size_t{1} << 44);
}

TEST(Format, EncodingsStoreXAndYAndFillTheRestAsPromised) {
    for (const auto& row : kEncodingNames) {
        const EncodingInfo info = encoding_info(row.value);
        const std::string swizzle = to_string(info.swizzle);
        EXPECT_NE(swizzle.find('x'), std::string::npos) << row.name;
        EXPECT_NE(swizzle.find('y'), std::string::npos) << row.name;
    }
    EXPECT_EQ(to_string(encoding_info(Encoding::dxt5nm).swizzle), "1y1x");
    EXPECT_EQ(to_string(encoding_info(Encoding::ag8).swizzle), "1y1x");
    EXPECT_EQ(to_string(encoding_info(Encoding::bc5).swizzle), "xy01");
    EXPECT_EQ(to_string(encoding_info(Encoding::eac_rg11).swizzle), "xy01");
    EXPECT_EQ(to_string(encoding_info(Encoding::rgb8).swizzle), "xyz1");
    EXPECT_EQ(encoding_info(Encoding::dxt5nm).format, Format::bc3_unorm);
}

TEST(SteepestSlope, IsTheLastOneThatAnEncodingStoresApart) {
    EXPECT_NEAR(steepest_slope(Encoding::dxt5nm), 11.26f, 0.01f);  // x = 1 - 1/255
    EXPECT_NEAR(steepest_slope(Encoding::bc5), 11.26f, 0.01f);
    EXPECT_NEAR(steepest_slope(Encoding::bc5_snorm), 11.24f, 0.01f);
    EXPECT_NEAR(steepest_slope(Encoding::eac_rg11), 31.99f, 0.01f);  // x = 1 - 1/2047
    EXPECT_NEAR(steepest_slope(Encoding::eac_rg11_snorm), 31.98f, 0.01f);
    EXPECT_NEAR(steepest_slope(Encoding::rg8), 11.26f, 0.01f);
    EXPECT_NEAR(steepest_slope(Encoding::rg16), 181.0f, 0.1f);
    EXPECT_EQ(steepest_slope(Encoding::rgba8), 127.5f);  // z = 1/127.5
    EXPECT_EQ(steepest_slope(Encoding::rgb16), 32767.5f);
    EXPECT_TRUE(std::isinf(steepest_slope(Encoding::half)));
    EXPECT_TRUE(std::isinf(steepest_slope(Encoding::float_)));
}

}  // namespace
}  // namespace tex
