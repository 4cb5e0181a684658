// SPDX-License-Identifier: Apache-2.0
// uastc_write.h: a block of UASTC from what it holds.

#pragma once

#include <cstddef>
#include <cstdint>

namespace tex::inline v1 {

inline constexpr int kUastcBlockBytes = 16;
inline constexpr unsigned kEtc1Unmoved = 13;  // the bias that leaves mean colours as they are, but for the extremes

// What transcoders do with a block. BC1: take endpoints and weights of the first plane as they are (`bc1_ends`), fit
// endpoints to these weights (`bc1_weights`), or fit both. ETC1: whether the halves are above each other (`flip`) and
// the second base colour is relative to the first one (`diff`); the tables of both; what is added to their means.
struct UastcHints {
    bool bc1_ends = false, bc1_weights = false;
    bool flip = false, diff = false;
    std::uint8_t table[2] = {};
    std::uint8_t bias = kEtc1Unmoved;
    // Modes with alpha: the table of EAC, and 16 times its multiplier.
    std::uint8_t eac = 0x1d;
    // The modifier and the base colour, of blocks of one colour.
    std::uint8_t selector = 0, base[3] = {};
};

// Modes of RGB, of which alpha is 255; or of luminance, which is the first channel, and alpha, the second one.
struct UastcContent {
    int mode = 0;
    unsigned pattern = 0;
    unsigned second_channel = 0;  // of modes with two planes: the channel that has the second one
    // By subset and channel: numbers in the order of their values, from 0. A block of one colour has its codes in the
    // first of these.
    std::uint8_t ends[3][2][3] = {};
    std::uint8_t alpha = 255;          // of a block of one colour
    std::uint8_t weights[2][16] = {};  // by plane
    UastcHints hints;
};

// Exchanges endpoints where a weight would not fit.
void write_uastc(const UastcContent& content, std::byte* block);

// What decoders make of it: codes by channel, of those that it holds. Not for blocks of one colour.
void uastc_texels(const UastcContent& content, std::uint8_t codes[3][16]);

// The code that the endpoint with this number has in a range of kAstcRangeTable.
[[nodiscard]] std::uint8_t uastc_code(int range, int number);

}  // namespace tex::inline v1
