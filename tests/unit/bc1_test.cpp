// SPDX-License-Identifier: Apache-2.0
// Decoding of BC1 blocks and BC2 alpha, compared with blocks computed by hand and with libsquish.

#include "blocks/bc1.h"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <squish.h>

namespace {

using tex::Bc1Mode;
using Block = std::array<std::byte, 8>;

struct Texels {
    float r[16], g[16], b[16], a[16];
};

// A block with two 5:6:5 colours, in which texel k has index k % 4.
Block all_indices(unsigned c0, unsigned c1) {
    Block block{static_cast<std::byte>(c0), static_cast<std::byte>(c0 >> 8), static_cast<std::byte>(c1),
                static_cast<std::byte>(c1 >> 8)};
    for (std::size_t k = 4; k < 8; ++k) block[k] = std::byte{0xE4};
    return block;
}

Texels decode(const std::byte* block, Bc1Mode mode) {
    Texels t;
    tex::decode_bc1(block, mode, t.r, t.g, t.b, t.a);
    return t;
}

TEST(Bc1, WidensByBitReplicationAndInterpolatesExactThirds) {
    // c0 = (17, 40, 3), c1 = (2, 21, 30) in 5:6:5 bits; in 8 bits (140, 162, 24) and (16, 85, 247).
    const Texels t =
        decode(all_indices(17u << 11 | 40u << 5 | 3u, 2u << 11 | 21u << 5 | 30u).data(), Bc1Mode::standard);
    const float r[4] = {140 / 255.f, 16 / 255.f, 296 / 765.f, 172 / 765.f};
    const float g[4] = {162 / 255.f, 85 / 255.f, 409 / 765.f, 332 / 765.f};
    const float b[4] = {24 / 255.f, 247 / 255.f, 295 / 765.f, 518 / 765.f};
    for (int texel = 0; texel < 16; ++texel) {
        EXPECT_EQ(t.r[texel], r[texel % 4]);
        EXPECT_EQ(t.g[texel], g[texel % 4]);
        EXPECT_EQ(t.b[texel], b[texel % 4]);
        EXPECT_EQ(t.a[texel], 1.f);
    }
}

TEST(Bc1, SmallerFirstColourMeansThreeColoursAndTransparentBlack) {
    const Texels t = decode(all_indices(0x0000, 0xFFFF).data(), Bc1Mode::standard);
    const float r[4] = {0.f, 1.f, 0.5f, 0.f};
    const float a[4] = {1.f, 1.f, 1.f, 0.f};
    for (int texel = 0; texel < 16; ++texel) {
        EXPECT_EQ(t.r[texel], r[texel % 4]);
        EXPECT_EQ(t.a[texel], a[texel % 4]);
    }
}

TEST(Bc1, EqualColoursMeanThreeColoursToo) {
    const Texels t = decode(all_indices(0xFFFF, 0xFFFF).data(), Bc1Mode::standard);
    EXPECT_EQ(t.g[2], 1.f);
    EXPECT_EQ(t.g[3], 0.f);
    EXPECT_EQ(t.a[3], 0.f);
}

TEST(Bc1, FourColoursModeIgnoresTheOrder) {
    const Texels t = decode(all_indices(0x0000, 0xFFFF).data(), Bc1Mode::four_colors);
    const float r[4] = {0.f, 1.f, 255 / 765.f, 510 / 765.f};
    for (int texel = 0; texel < 16; ++texel) {
        EXPECT_EQ(t.r[texel], r[texel % 4]);
        EXPECT_EQ(t.a[texel], 1.f);
    }
}

TEST(Bc1, Bc2AlphaIsFourBits) {
    Block block;
    for (std::size_t k = 0; k < 8; ++k) block[k] = static_cast<std::byte>((2 * k) | (2 * k + 1) << 4);
    float a[16];
    tex::decode_bc2_alpha(block.data(), a);
    for (int texel = 0; texel < 16; ++texel) EXPECT_EQ(a[texel], static_cast<float>(texel) / 15.f);
}

void expect_squish(const squish::u8* rgba, const Texels& t, int texel) {
    // libsquish computes in integer codes and truncates.
    const auto code = [](float value) { return static_cast<int>(std::floor(value * 255 + 1e-3f)); };
    EXPECT_EQ(rgba[4 * texel + 0], code(t.r[texel]));
    EXPECT_EQ(rgba[4 * texel + 1], code(t.g[texel]));
    EXPECT_EQ(rgba[4 * texel + 2], code(t.b[texel]));
    EXPECT_EQ(rgba[4 * texel + 3], code(t.a[texel]));
}

TEST(Bc1, AgreesWithLibsquishOnRandomBlocks) {
    std::mt19937 random(2);
    for (int trial = 0; trial < 5000; ++trial) {
        std::array<std::byte, 16> block{};
        for (std::byte& byte : block) byte = static_cast<std::byte>(random());
        squish::u8 rgba[64];
        Texels t = decode(block.data(), Bc1Mode::standard);
        squish::Decompress(rgba, block.data(), squish::kDxt1);
        for (int texel = 0; texel < 16; ++texel) expect_squish(rgba, t, texel);
        t = decode(block.data() + 8, Bc1Mode::four_colors);
        tex::decode_bc2_alpha(block.data(), t.a);
        squish::Decompress(rgba, block.data(), squish::kDxt3);
        for (int texel = 0; texel < 16; ++texel) expect_squish(rgba, t, texel);
    }
}

}  // namespace
