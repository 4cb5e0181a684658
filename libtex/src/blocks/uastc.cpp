// SPDX-License-Identifier: Apache-2.0

#include "blocks/uastc.h"

#include <algorithm>
#include <array>

#include "blocks/astc_ise.h"
#include "blocks/astc_mode.h"
#include "blocks/bptc.h"

namespace tex::inline v1 {
namespace {

constexpr int kUastcTexels = 16;
constexpr int kUastcModes = 19;
constexpr int kUastcSolid = 8;  // the mode of one colour
constexpr int kMostSubsets = 3;
constexpr int kLongestUastcCode = 7;

struct UastcMode {
    std::uint8_t code, code_bits;  // at the start of the block, the lowest bit first
    std::uint8_t hint_bits;
    std::uint8_t subsets, planes;
    std::uint8_t channels;     // with endpoints of their own: luminance and alpha, RGB, RGBA
    std::uint8_t color_range;  // of kAstcRangeTable
    std::uint8_t weight_bits;
};

constexpr UastcMode kUastcModeTable[kUastcModes] = {
    {0x01, 4, 15, 1, 1, 3, 19, 4}, {0x35, 6, 15, 1, 1, 3, 20, 2}, {0x1d, 5, 15, 2, 1, 3, 8, 3},
    {0x03, 5, 15, 3, 1, 3, 7, 2},  {0x13, 5, 15, 2, 1, 3, 12, 2}, {0x0b, 5, 15, 1, 1, 3, 20, 3},
    {0x1b, 5, 15, 1, 2, 3, 18, 2}, {0x07, 5, 15, 2, 1, 3, 12, 2}, {0x17, 5, 0, 0, 0, 4, 0, 0},
    {0x0f, 5, 23, 2, 1, 4, 8, 2},  {0x02, 3, 17, 1, 1, 4, 13, 4}, {0x00, 2, 17, 1, 2, 4, 13, 2},
    {0x06, 3, 17, 1, 1, 4, 19, 3}, {0x1f, 5, 23, 1, 2, 4, 20, 1}, {0x0d, 5, 23, 1, 1, 4, 20, 2},
    {0x05, 7, 23, 1, 1, 2, 20, 4}, {0x15, 6, 23, 2, 1, 2, 20, 2}, {0x25, 6, 23, 1, 2, 2, 20, 2},
    {0x09, 4, 15, 1, 1, 3, 11, 5},
};

// The mode that the lowest bits of a block stand for; kUastcModes for the code that is reserved.
constexpr auto kUastcModeOfBits = [] {
    std::array<std::uint8_t, 1 << kLongestUastcCode> modes{};
    modes.fill(kUastcModes);
    for (int m = 0; m < kUastcModes; ++m) {
        const UastcMode& mode = kUastcModeTable[m];
        for (unsigned bits = mode.code; bits < modes.size(); bits += 1u << mode.code_bits)
            modes[bits] = static_cast<std::uint8_t>(m);
    }
    return modes;
}();

// The partitions of ASTC that patterns stand for: those that BC7 has, too. Mode 7 has two subsets where BC7 has three.
constexpr std::uint16_t kTwoSubsetPatterns[] = {28,  20,  16,  29,  91,  9,   107, 72,  149, 204,
                                                50,  114, 496, 17,  78,  39,  252, 828, 43,  156,
                                                116, 210, 476, 273, 684, 359, 246, 195, 694, 524};
constexpr std::uint16_t kThreeSubsetPatterns[] = {260, 74, 32, 156, 183, 15, 745, 0, 335, 902, 254};
constexpr std::uint16_t kMergedPatterns[] = {36,  48,  61,  137, 161, 183, 226, 281, 302, 307,
                                             479, 495, 593, 594, 605, 799, 812, 988, 993};

struct UastcPattern {
    std::uint8_t subset[kUastcTexels] = {};
    bool is_anchor[kUastcTexels] = {};  // the first texel of its subset: its weight lacks the highest bit
};

UastcPattern make_pattern(int subsets, unsigned partition) {
    UastcPattern pattern;
    astc_partitions({4, 4}, subsets, partition, pattern.subset);
    for (int s = 0; s < subsets; ++s)
        pattern.is_anchor[std::find(pattern.subset, pattern.subset + kUastcTexels, s) - pattern.subset] = true;
    return pattern;
}

struct UastcPatterns {
    UastcPattern one, two[std::size(kTwoSubsetPatterns)], three[std::size(kThreeSubsetPatterns)],
        merged[std::size(kMergedPatterns)];

    UastcPatterns() {
        one.is_anchor[0] = true;
        for (std::size_t k = 0; k < std::size(two); ++k) two[k] = make_pattern(2, kTwoSubsetPatterns[k]);
        for (std::size_t k = 0; k < std::size(three); ++k) three[k] = make_pattern(3, kThreeSubsetPatterns[k]);
        for (std::size_t k = 0; k < std::size(merged); ++k) merged[k] = make_pattern(2, kMergedPatterns[k]);
    }
};

// Null if there is no such pattern.
const UastcPattern* read_pattern(BptcBits& bits, int mode) {
    static const UastcPatterns patterns;
    constexpr int kMergedMode = 7;
    const int subsets = kUastcModeTable[mode].subsets;
    if (subsets == 1) return &patterns.one;
    const unsigned k = bits.take(subsets == 2 ? 5 : 4);
    if (subsets == 3) return k < std::size(patterns.three) ? patterns.three + k : nullptr;
    if (mode == kMergedMode) return k < std::size(patterns.merged) ? patterns.merged + k : nullptr;
    return k < std::size(patterns.two) ? patterns.two + k : nullptr;
}

// The channel that has the second of two planes.
int read_second_channel(BptcBits& bits, const UastcMode& mode) {
    constexpr int kAlpha = 3;
    if (mode.planes == 1) return -1;
    return mode.channels == 2 ? kAlpha : static_cast<int>(bits.take(2));
}

// All trits or quints come first, then the bits of each value.
void read_endpoint_values(BptcBits& bits, int range, int count, std::uint8_t* values) {
    constexpr int kTritBits[] = {0, 2, 4, 5, 7, 8}, kQuintBits[] = {0, 3, 5, 7};
    const AstcRange r = kAstcRangeTable[range];
    std::uint8_t uppers[kAstcMostColors] = {};
    const int group = r.upper == 3 ? 5 : 3;
    for (int first = 0; r.upper > 1 && first < count; first += group) {
        const int in_group = std::min(group, count - first);
        unsigned packed = bits.take(r.upper == 3 ? kTritBits[in_group] : kQuintBits[in_group]);
        const auto upper = static_cast<unsigned>(r.upper);
        for (int k = first; k < first + in_group; ++k, packed /= upper)
            uppers[k] = static_cast<std::uint8_t>(packed % upper);
    }
    for (int k = 0; k < count; ++k) {
        const unsigned stored = bits.take(r.bits) | static_cast<unsigned>(uppers[k]) << r.bits;
        values[k] = kAstcMeanings.color[range][stored];
    }
}

// The codes of one channel between the endpoints of each subset.
struct UastcEnds {
    int begin[kMostSubsets], step[kMostSubsets];

    void set(int subset, int e0, int e1) {
        begin[subset] = 257 * 64 * e0 + 32;
        step[subset] = 257 * (e1 - e0);
    }
};

void interpolate(const UastcEnds& ends, int subsets, const std::uint8_t* subset, const std::uint8_t* weights,
                 std::uint8_t* codes) {
    if (subsets == 1) {
        for (int k = 0; k < kUastcTexels; ++k)
            codes[k] = static_cast<std::uint8_t>((ends.begin[0] + ends.step[0] * weights[k]) >> 14);
        return;
    }
    for (int k = 0; k < kUastcTexels; ++k)
        codes[k] = static_cast<std::uint8_t>((ends.begin[subset[k]] + ends.step[subset[k]] * weights[k]) >> 14);
}

void fill(const std::uint8_t (&color)[4], std::uint8_t channels[4][16]) {
    for (int c = 0; c < 4; ++c) std::fill_n(channels[c], kUastcTexels, color[c]);
}

}  // namespace

void decode_uastc(const std::byte* block, std::uint8_t channels[4][16]) {
    constexpr std::uint8_t kMagenta[4] = {255, 0, 255, 255};
    constexpr int kWeightRanges[] = {0, 0, 2, 5, 8, 11};  // of so many bits
    BptcBits bits(block);
    const int number = kUastcModeOfBits[std::to_integer<unsigned>(block[0]) & ((1u << kLongestUastcCode) - 1)];
    if (number == kUastcModes) return fill(kMagenta, channels);
    const UastcMode& mode = kUastcModeTable[number];
    bits.take(mode.code_bits);
    if (number == kUastcSolid) {
        std::uint8_t color[4];
        for (std::uint8_t& code : color) code = static_cast<std::uint8_t>(bits.take(8));
        return fill(color, channels);
    }
    bits.take(mode.hint_bits);
    const UastcPattern* const pattern = read_pattern(bits, number);
    if (pattern == nullptr) return fill(kMagenta, channels);
    const int second_channel = read_second_channel(bits, mode);
    std::uint8_t ends[kAstcMostColors];
    read_endpoint_values(bits, mode.color_range, 2 * mode.channels * mode.subsets, ends);

    const std::uint8_t* const meaning = kAstcMeanings.weight[kWeightRanges[mode.weight_bits]];
    std::uint8_t weights[2][kUastcTexels];
    for (int k = 0; k < kUastcTexels; ++k) {
        for (int plane = 0; plane < mode.planes; ++plane)
            weights[plane][k] = meaning[bits.take(mode.weight_bits - (pattern->is_anchor[k] ? 1 : 0))];
    }
    for (int c = 0; c < 4; ++c) {
        const int stored = mode.channels == 2 ? c / 3 : c;  // luminance stands for R, G and B
        UastcEnds line = {};
        for (int s = 0; s < mode.subsets; ++s) {
            const std::uint8_t* const e = ends + 2 * (mode.channels * s + stored);
            const bool has_ends = stored < mode.channels;
            line.set(s, has_ends ? e[0] : 255, has_ends ? e[1] : 255);
        }
        interpolate(line, mode.subsets, pattern->subset, weights[c == second_channel ? 1 : 0], channels[c]);
    }
}

}  // namespace tex::inline v1
