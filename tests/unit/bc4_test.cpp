// SPDX-License-Identifier: Apache-2.0
// Decoding of BC4 blocks, compared with blocks computed by hand and with libsquish.

#include "blocks/bc4.h"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <squish.h>

namespace {

using Block = std::array<std::byte, 8>;

// A block in which texel k has index k % 8.
Block all_indices(int e0, int e1) {
    Block block{static_cast<std::byte>(e0), static_cast<std::byte>(e1)};
    for (const std::size_t half : {0u, 3u}) {  // 0, 1, 2, ... 7 in 3 bits each is 0xFAC688
        block[2 + half] = std::byte{0x88};
        block[3 + half] = std::byte{0xC6};
        block[4 + half] = std::byte{0xFA};
    }
    return block;
}

TEST(Bc4, EightValuesAreExactSevenths) {
    float values[16];
    tex::decode_bc4_unorm(all_indices(255, 3).data(), values);
    const float expected[8] = {255 / 255.f,   3 / 255.f,    1533 / 1785.f, 1281 / 1785.f,
                               1029 / 1785.f, 777 / 1785.f, 525 / 1785.f,  273 / 1785.f};
    for (int texel = 0; texel < 16; ++texel) EXPECT_EQ(values[texel], expected[texel % 8]) << texel;
}

TEST(Bc4, SixValuesAreExactFifthsAndTheExtremes) {
    float values[16];
    tex::decode_bc4_unorm(all_indices(10, 200).data(), values);
    const float expected[8] = {10 / 255.f,   200 / 255.f,  240 / 1275.f, 430 / 1275.f,
                               620 / 1275.f, 810 / 1275.f, 0.f,          1.f};
    for (int texel = 0; texel < 16; ++texel) EXPECT_EQ(values[texel], expected[texel % 8]) << texel;
}

TEST(Bc4, EqualEndpointsMeanSixValues) {
    float values[16];
    tex::decode_bc4_unorm(all_indices(77, 77).data(), values);
    EXPECT_EQ(values[5], 77 / 255.f);
    EXPECT_EQ(values[6], 0.f);
    EXPECT_EQ(values[7], 1.f);
}

TEST(Bc4, SnormComparesSignedEndpoints) {
    float values[16];
    tex::decode_bc4_snorm(all_indices(1, -1).data(), values);
    const float eight[8] = {1 / 127.f, -1 / 127.f, 5 / 889.f, 3 / 889.f, 1 / 889.f, -1 / 889.f, -3 / 889.f, -5 / 889.f};
    for (int texel = 0; texel < 16; ++texel) EXPECT_EQ(values[texel], eight[texel % 8]) << texel;
    tex::decode_bc4_snorm(all_indices(-127, 127).data(), values);
    const float six[8] = {-1.f, 1.f, -381 / 635.f, -127 / 635.f, 127 / 635.f, 381 / 635.f, -1.f, 1.f};
    for (int texel = 0; texel < 16; ++texel) EXPECT_EQ(values[texel], six[texel % 8]) << texel;
}

TEST(Bc4, LowestSnormCodeIsMinusOneToo) {
    float values[16];
    tex::decode_bc4_snorm(all_indices(-128, 0).data(), values);
    EXPECT_EQ(values[0], -1.f);
    EXPECT_EQ(values[2], -508 / 635.f);
    tex::decode_bc4_snorm(all_indices(127, -128).data(), values);
    EXPECT_EQ(values[1], -1.f);
    EXPECT_EQ(values[2], 635 / 889.f);
}

// libsquish computes in integer codes and truncates.
TEST(Bc4, AgreesWithLibsquishOnRandomBlocks) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 5000; ++trial) {
        std::array<std::byte, 16> bc3{};
        for (int k = 0; k < 8; ++k) bc3[static_cast<std::size_t>(k)] = static_cast<std::byte>(random());
        float values[16];
        tex::decode_bc4_unorm(bc3.data(), values);
        squish::u8 rgba[64];
        squish::Decompress(rgba, bc3.data(), squish::kDxt5);
        for (int texel = 0; texel < 16; ++texel) {
            EXPECT_EQ(rgba[4 * texel + 3], static_cast<int>(std::floor(values[texel] * 255 + 1e-3f))) << trial;
        }
    }
}

}  // namespace
