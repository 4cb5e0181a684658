// SPDX-License-Identifier: Apache-2.0
// Blocks of ASTC: single blocks made by hand from the specification, and how near our encodings come to the normals.
// (The peers' tests compare blocks with Mesa, and files with astcenc.)

#include "blocks/astc_decode.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>
#include <tex/check.h>
#include <tex/pack.h>

#include "reference/astc_block.h"

namespace tex {
namespace {

using reference::one_color;

std::array<float, 4> first_texel(Format format, const reference::AstcBlock& block) {
    const Extent extent = format_info(format).block;
    const auto count = static_cast<std::size_t>(extent.texels());
    std::vector<float> rgba(4 * count, -1.0f);
    decode_astc(extent, block.data(), {{&rgba[0], &rgba[count], &rgba[2 * count], &rgba[3 * count]}});
    for (std::size_t k = 0; k < rgba.size(); ++k) EXPECT_EQ(rgba[k], rgba[k / count * count]) << k;
    return {rgba[0], rgba[count], rgba[2 * count], rgba[3 * count]};
}

TEST(Astc, BlocksOfOneColorAreThatColor) {
    const std::array<float, 4> texel =
        first_texel(Format::astc_6x5_unorm, one_color(false, {0, 0xffff, 0x8000, 0x4000}));
    EXPECT_EQ(texel, (std::array<float, 4>{0.0f, 1.0f, 0.5f, 0.25f}));
}

TEST(Astc, BlocksThatAreNotValidOrOfHighRangeAreMagenta) {
    constexpr std::array<float, 4> kMagenta = {1.0f, 0.0f, 1.0f, 1.0f};
    EXPECT_EQ(first_texel(Format::astc_4x4_unorm, reference::AstcBlock{}), kMagenta);
    EXPECT_EQ(first_texel(Format::astc_12x12_unorm, one_color(true, {0x3c00, 0x3c00, 0x3c00, 0x3c00})), kMagenta);
}

// A wave of slopes up to 1.
NormalMap wave(Extent extent) {
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double p = 0.7 * std::sin(0.11 * i + 0.05 * j), q = 0.6 * std::cos(0.08 * j - 0.03 * i);
            const double length = std::sqrt(p * p + q * q + 1.0);
            map.x.at(i, j) = static_cast<float>(-p / length);
            map.y.at(i, j) = static_cast<float>(-q / length);
            map.z.at(i, j) = static_cast<float>(1.0 / length);
        }
    }
    return map;
}

double mean_angle(Encoding encoding, Effort effort, YAxis y) {
    const Extent extent{61, 47};
    MipChain chain;
    chain.levels.push_back(wave(extent));
    PackOptions options;
    options.encoding = encoding;
    options.effort = effort;
    options.y_axis = y;
    const auto texture = pack(chain, options);
    EXPECT_TRUE(texture);
    const auto unpacked = unpack(*texture);
    EXPECT_TRUE(unpacked);
    const auto compared = compare(chain.levels.front(), unpacked->levels.front());
    EXPECT_TRUE(compared);
    return compared->error.mean;
}

TEST(Astc, StaysNearTheNormals) {
    const struct {
        Encoding encoding;
        double degrees;
    } bounds[] = {{Encoding::astc_4x4, 0.3},  {Encoding::astc_5x4, 0.4}, {Encoding::astc_5x5, 0.45},
                  {Encoding::astc_6x5, 0.5},  {Encoding::astc_6x6, 0.6}, {Encoding::astc_8x5, 0.8},
                  {Encoding::astc_8x6, 0.85}, {Encoding::astc_8x8, 1.2}};
    for (const auto& [encoding, degrees] : bounds) {
        const double normal = mean_angle(encoding, Effort::normal, YAxis::up);
        EXPECT_LT(normal, degrees) << name_of(kEncodingNames, encoding);
        EXPECT_GT(normal, 0.0);
        EXPECT_LE(mean_angle(encoding, Effort::best, YAxis::up), 1.02 * normal) << name_of(kEncodingNames, encoding);
        EXPECT_LT(mean_angle(encoding, Effort::normal, YAxis::down), degrees) << name_of(kEncodingNames, encoding);
    }
}

TEST(Astc, FlatMapsStayFlat) {
    MipChain chain;
    chain.levels.emplace_back(Extent{13, 7});
    for (Plane<float>* plane : {&chain.levels[0].x, &chain.levels[0].y, &chain.levels[0].z}) {
        for (int j = 0; j < 7; ++j) std::fill_n(plane->row(j), 13, plane == &chain.levels[0].z ? 1.0f : 0.0f);
    }
    PackOptions options;
    options.encoding = Encoding::astc_6x6;
    const auto texture = pack(chain, options);
    ASSERT_TRUE(texture);
    const auto image = decode(*texture, 0);
    ASSERT_TRUE(image);
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(image->planes[c].at(12, 6), 0.5f, 0.001f) << c;
}

}  // namespace
}  // namespace tex
