// SPDX-License-Identifier: Apache-2.0
// Decoding of EAC blocks, compared with blocks computed by hand from the formulas of the specification. (The peers'
// tests compare every code with Mesa.)

#include "blocks/eac.h"

#include <array>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

namespace {

using Block = std::array<std::byte, 8>;

// A block in which texel k, counted by columns, has selector k % 8: 0, 1, 2, ... 7 in 3 bits each, twice.
Block all_selectors(int base, int multiplier, int table) {
    Block block{static_cast<std::byte>(base), static_cast<std::byte>(multiplier << 4 | table)};
    for (const std::size_t half : {0u, 3u}) {  // 000 001 010 011 100 101 110 111
        block[2 + half] = std::byte{0x05};
        block[3 + half] = std::byte{0x39};
        block[4 + half] = std::byte{0x77};
    }
    return block;
}

// The selector of texel k, row-major, in such a block.
constexpr int selector_at(int k) { return (4 * (k % 4) + k / 4) % 8; }

TEST(Eac, UnormAddsMultiplesOfTheModifiers) {
    float values[16];
    tex::decode_eac_unorm(all_selectors(100, 2, 0).data(), values);
    // 8 * 100 + 4 + 16 * {-3, -6, -9, -15, 2, 5, 8, 14}
    const int expected[8] = {756, 708, 660, 564, 836, 884, 932, 1028};
    for (int k = 0; k < 16; ++k) EXPECT_EQ(values[k], static_cast<float>(expected[selector_at(k)]) / 2047.0f) << k;
}

TEST(Eac, MultiplierZeroAddsTheModifierItself) {
    float values[16];
    tex::decode_eac_unorm(all_selectors(100, 0, 13).data(), values);
    const int expected[8] = {803, 802, 801, 794, 804, 805, 806, 813};
    for (int k = 0; k < 16; ++k) EXPECT_EQ(values[k], static_cast<float>(expected[selector_at(k)]) / 2047.0f) << k;
    tex::decode_eac_snorm(all_selectors(-100, 0, 13).data(), values);
    const int negative[8] = {-801, -802, -803, -810, -800, -799, -798, -791};
    for (int k = 0; k < 16; ++k) EXPECT_EQ(values[k], static_cast<float>(negative[selector_at(k)]) / 1023.0f) << k;
}

TEST(Eac, CodesAreClamped) {
    float values[16];
    tex::decode_eac_unorm(all_selectors(2, 15, 1).data(), values);
    // 20 + 120 * {-3, -7, -10, -13, 2, 6, 9, 12}
    const int low[8] = {0, 0, 0, 0, 260, 740, 1100, 1460};
    for (int k = 0; k < 16; ++k) EXPECT_EQ(values[k], static_cast<float>(low[selector_at(k)]) / 2047.0f) << k;
    tex::decode_eac_unorm(all_selectors(250, 15, 1).data(), values);
    const int high[8] = {1644, 1164, 804, 444, 2047, 2047, 2047, 2047};
    for (int k = 0; k < 16; ++k) EXPECT_EQ(values[k], static_cast<float>(high[selector_at(k)]) / 2047.0f) << k;
    tex::decode_eac_snorm(all_selectors(-10, 15, 1).data(), values);
    const int both[8] = {-440, -920, -1023, -1023, 160, 640, 1000, 1023};
    for (int k = 0; k < 16; ++k) EXPECT_EQ(values[k], static_cast<float>(both[selector_at(k)]) / 1023.0f) << k;
}

TEST(Eac, LowestSignedBaseIsTheNextOneToo) {
    float lowest[16], next[16];
    tex::decode_eac_snorm(all_selectors(-128, 3, 7).data(), lowest);
    tex::decode_eac_snorm(all_selectors(-127, 3, 7).data(), next);
    for (int k = 0; k < 16; ++k) EXPECT_EQ(lowest[k], next[k]);
}

// Blocks that are written have the selectors that they are given.
TEST(Eac, WritesWhatItReads) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 2000; ++trial) {
        Block block, again;
        std::int32_t nearest[16];
        for (std::byte& byte : block) byte = static_cast<std::byte>(random());
        std::uint64_t selectors = 0;
        for (std::size_t k = 2; k < 8; ++k) selectors = selectors << 8 | std::to_integer<std::uint64_t>(block[k]);
        for (int k = 0; k < 16; ++k) {
            const int by_columns = 4 * (k % 4) + k / 4;
            nearest[k] = static_cast<std::int32_t>(8 * (random() % 1000) + (selectors >> (45 - 3 * by_columns) & 7));
        }
        const int base = std::to_integer<int>(block[0]);
        const int second = std::to_integer<int>(block[1]);
        tex::write_eac(tex::kEacUnorm, {base, second >> 4, second & 15}, nearest, again.data());
        ASSERT_EQ(again, block);
        tex::write_eac(tex::kEacSnorm, {base, second >> 4, second & 15}, nearest, again.data());
        block[0] = static_cast<std::byte>(base - 127);
        ASSERT_EQ(again, block);
    }
}

}  // namespace
