// SPDX-License-Identifier: Apache-2.0
// uastc_modes.h: the modes of UASTC and its patterns of subsets.

#pragma once

#include <cstdint>

namespace tex::inline v1 {

inline constexpr int kUastcTexels = 16;
inline constexpr int kUastcModes = 19;
inline constexpr int kUastcSolid = 8;  // the mode of one colour

struct UastcMode {
    std::uint8_t code, code_bits;  // at the start of the block, the lowest bit first
    std::uint8_t hint_bits;
    std::uint8_t subsets, planes;
    std::uint8_t channels;     // with endpoints of their own: luminance and alpha, RGB, RGBA
    std::uint8_t color_range;  // of kAstcRangeTable
    std::uint8_t weight_bits;
};

inline constexpr UastcMode kUastcModeTable[kUastcModes] = {
    {0x01, 4, 15, 1, 1, 3, 19, 4}, {0x35, 6, 15, 1, 1, 3, 20, 2}, {0x1d, 5, 15, 2, 1, 3, 8, 3},
    {0x03, 5, 15, 3, 1, 3, 7, 2},  {0x13, 5, 15, 2, 1, 3, 12, 2}, {0x0b, 5, 15, 1, 1, 3, 20, 3},
    {0x1b, 5, 15, 1, 2, 3, 18, 2}, {0x07, 5, 15, 2, 1, 3, 12, 2}, {0x17, 5, 0, 0, 0, 4, 0, 0},
    {0x0f, 5, 23, 2, 1, 4, 8, 2},  {0x02, 3, 17, 1, 1, 4, 13, 4}, {0x00, 2, 17, 1, 2, 4, 13, 2},
    {0x06, 3, 17, 1, 1, 4, 19, 3}, {0x1f, 5, 23, 1, 2, 4, 20, 1}, {0x0d, 5, 23, 1, 1, 4, 20, 2},
    {0x05, 7, 23, 1, 1, 2, 20, 4}, {0x15, 6, 23, 2, 1, 2, 20, 2}, {0x25, 6, 23, 1, 2, 2, 20, 2},
    {0x09, 4, 15, 1, 1, 3, 11, 5},
};

// The ranges of weights of so many bits, of kAstcRangeTable.
inline constexpr int kUastcWeightRanges[] = {0, 0, 2, 5, 8, 11};

struct UastcPattern {
    std::uint8_t subset[kUastcTexels] = {};
    bool is_anchor[kUastcTexels] = {};  // the first texel of its subset: its weight lacks the highest bit
    std::uint8_t anchor[3] = {};        // these texels, in their order
    std::uint16_t texels[3] = {};       // of each subset: bit k is texel k
};

// The patterns of a mode, and one of them; null if there is no such pattern.
[[nodiscard]] unsigned uastc_patterns(int mode);
[[nodiscard]] const UastcPattern* uastc_pattern(int mode, unsigned number);

[[nodiscard]] inline unsigned uastc_texels(int mode, unsigned number, int subset) {
    return uastc_pattern(mode, number)->texels[subset];
}

}  // namespace tex::inline v1
