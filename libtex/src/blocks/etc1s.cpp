// SPDX-License-Identifier: Apache-2.0

#include "blocks/etc1s.h"

#include <algorithm>

namespace tex::inline v1 {
namespace {

// By the number that a block stores for a texel: its high bit is the sign.
constexpr int kEtc1Modifiers[8][4] = {{2, 8, -2, -8},       {5, 17, -5, -17},    {9, 29, -9, -29},
                                      {13, 42, -13, -42},   {18, 60, -18, -60},  {24, 80, -24, -80},
                                      {33, 106, -33, -106}, {47, 183, -47, -183}};
constexpr unsigned kByBrightness[4] = {3, 2, 0, 1};

constexpr unsigned kDifferential = 2;  // the bit that says that the second colour is an offset from the first one

unsigned byte_of(const std::byte* block, int k) { return std::to_integer<unsigned>(block[k]); }

}  // namespace

void decode_etc1s(const std::byte* block, std::uint8_t* const channels[3]) {
    const unsigned high = byte_of(block, 4) << 8 | byte_of(block, 5), low = byte_of(block, 6) << 8 | byte_of(block, 7);
    std::uint8_t number[16];
    for (unsigned k = 0; k < 16; ++k) {
        const unsigned at = k % 4 * 4 + k / 4;  // columns come first
        number[k] = static_cast<std::uint8_t>((high >> at & 1) << 1 | (low >> at & 1));
    }
    const int* const modifiers = kEtc1Modifiers[byte_of(block, 3) >> 5];
    for (int c = 0; c < 3; ++c) {
        if (channels[c] == nullptr) continue;
        const unsigned five = byte_of(block, c) >> 3;
        const int base = static_cast<int>(five << 3 | five >> 2);
        std::uint8_t palette[4];
        for (int k = 0; k < 4; ++k) palette[k] = static_cast<std::uint8_t>(std::clamp(base + modifiers[k], 0, 255));
        for (int k = 0; k < 16; ++k) channels[c][k] = palette[number[k]];
    }
}

void write_etc1s_color(const std::uint8_t color[3], std::uint8_t table, std::byte* block) {
    for (int c = 0; c < 3; ++c) block[c] = static_cast<std::byte>(color[c] << 3);
    block[3] = static_cast<std::byte>(unsigned{table} << 5 | unsigned{table} << 2 | kDifferential);
}

void write_etc1s_modifiers(const std::uint8_t rows[4], std::byte* bytes) {
    unsigned high = 0, low = 0;
    for (unsigned j = 0; j < 4; ++j) {
        for (unsigned i = 0; i < 4; ++i) {
            const unsigned number = kByBrightness[rows[j] >> (2 * i) & 3u];
            high |= (number >> 1) << (4 * i + j);
            low |= (number & 1) << (4 * i + j);
        }
    }
    bytes[0] = static_cast<std::byte>(high >> 8);
    bytes[1] = static_cast<std::byte>(high & 0xff);
    bytes[2] = static_cast<std::byte>(low >> 8);
    bytes[3] = static_cast<std::byte>(low & 0xff);
}

}  // namespace tex::inline v1
