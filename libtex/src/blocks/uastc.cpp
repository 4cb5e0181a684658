// SPDX-License-Identifier: Apache-2.0

#include "blocks/uastc.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include "blocks/astc_ise.h"
#include "blocks/astc_mode.h"
#include "blocks/block_entries.h"
#include "blocks/bptc.h"
#include "blocks/uastc_modes.h"
#include "blocks/uastc_parts.h"

namespace tex::inline v1 {
namespace {

constexpr int kLongestUastcCode = 7;

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

// Null if there is no such pattern.
const UastcPattern* read_pattern(BptcBits& bits, int mode) {
    const int subsets = kUastcModeTable[mode].subsets;
    return uastc_pattern(mode, subsets == 1 ? 0 : bits.take(subsets == 2 ? 5 : 4));
}

// The channel that has the second of two planes.
int read_second_channel(BptcBits& bits, const UastcMode& mode) {
    constexpr int kAlpha = 3;
    if (mode.planes == 1) return -1;
    return mode.channels == 2 ? kAlpha : static_cast<int>(bits.take(2));
}

// All trits or quints come first, then the bits of each value: at most 42 and 64.
void read_endpoint_values(BptcBits& bits, int range, int count, std::uint8_t* values) {
    constexpr int kTritBits[] = {0, 2, 4, 5, 7, 8}, kQuintBits[] = {0, 3, 5, 7};
    const AstcRange r = kAstcRangeTable[range];
    std::uint8_t uppers[kAstcMostColors] = {};
    // A division by a constant is a multiplication.
    const auto read_uppers = [&](auto upper, int group, const int* group_bits) {
        for (int first = 0; first < count; first += group) {
            const int in_group = std::min(group, count - first);
            unsigned packed = bits.take(group_bits[in_group]);
            for (int k = first; k < first + in_group; ++k, packed /= upper())
                uppers[k] = static_cast<std::uint8_t>(packed % upper());
        }
    };
    if (r.upper == 3) read_uppers(std::integral_constant<unsigned, 3>(), 5, kTritBits);
    if (r.upper == 5) read_uppers(std::integral_constant<unsigned, 5>(), 3, kQuintBits);
    std::uint64_t rest = bits.next();
    const unsigned mask = (1u << r.bits) - 1;
    for (int k = 0; k < count; ++k, rest >>= r.bits)
        values[k] = kAstcMeanings.color[range][(rest & mask) | static_cast<unsigned>(uppers[k]) << r.bits];
    bits.skip(count * r.bits / 2);
    bits.skip(count * r.bits - count * r.bits / 2);
}

// Adds the highest bits that anchors lack. Then all weights have as many bits: eight texels at most 40.
void read_weights(BptcBits& bits, const UastcMode& mode, const UastcPattern& pattern, const std::uint8_t* meaning,
                  std::uint8_t weights[2][kUastcTexels]) {
    constexpr int kAtOnce = 8;
    const int count = mode.weight_bits, of_texel = count * mode.planes;
    const unsigned mask = (1u << count) - 1;
    for (int first = 0; first < kUastcTexels; first += kAtOnce) {
        std::uint64_t rest = bits.next();
        int lacking = 0;
        for (int s = 0; s < mode.subsets; ++s) {
            const int k = pattern.anchor[s] - first;
            if (k < 0 || k >= kAtOnce) continue;
            for (int plane = 0; plane < mode.planes; ++plane, ++lacking) {
                const std::uint64_t below = rest & ((std::uint64_t{1} << (k * of_texel + (plane + 1) * count - 1)) - 1);
                rest = (rest - below) << 1 | below;
            }
        }
        bits.skip(kAtOnce * of_texel - lacking);
        for (int k = first; k < first + kAtOnce; ++k, rest >>= of_texel) {
            weights[0][k] = meaning[static_cast<unsigned>(rest) & mask];
            weights[1][k] = meaning[static_cast<unsigned>(rest >> count) & mask];  // of use with two planes
        }
    }
}

// A code between two ends, 0 to 255, by a weight, 0 to 64.
std::uint8_t code_between(int e0, int e1, int weight) {
    return static_cast<std::uint8_t>((257 * ((64 - weight) * e0 + weight * e1) + 32) >> 14);
}

// Codes of texels between two ends, 0 to 255, by their weights, 0 to 64: as code_between(), in 16 bits.
void interpolate(int e0, int e1, const std::uint8_t* weights, std::uint8_t* codes) {
    const auto begin = static_cast<std::uint16_t>(64 * e0), step = static_cast<std::uint16_t>(e1 - e0);
#pragma GCC unroll 1  // as a loop, it becomes vectors
    for (int k = 0; k < kUastcTexels; ++k) {
        const auto x = static_cast<std::uint16_t>(begin + step * weights[k]);
        codes[k] = static_cast<std::uint8_t>((x + ((x + 32) >> 8)) >> 6);
    }
}

void fill(const std::uint8_t (&color)[4], std::uint8_t channels[4][16]) {
    for (int c = 0; c < 4; ++c) std::fill_n(channels[c], kUastcTexels, color[c]);
}

}  // namespace

void decode_uastc(const std::byte* block, std::uint8_t channels[4][16]) {
    constexpr std::uint8_t kMagenta[4] = {255, 0, 255, 255};
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

    const std::uint8_t* const meaning = kAstcMeanings.weight[kUastcWeightRanges[mode.weight_bits]];
    std::uint8_t weights[2][kUastcTexels];
    read_weights(bits, mode, *pattern, meaning, weights);
    for (int c = 0; c < 4; ++c) {
        const int stored = mode.channels == 2 ? c / 3 : c;  // luminance stands for R, G and B
        if (stored >= mode.channels) {
            std::fill_n(channels[c], kUastcTexels, std::uint8_t{255});
            continue;
        }
        const std::uint8_t* const w = weights[c == second_channel ? 1 : 0];
        interpolate(ends[2 * stored], ends[2 * stored + 1], w, channels[c]);
        for (int s = 1; s < mode.subsets; ++s) {
            const std::uint8_t* const e = ends + 2 * (mode.channels * s + stored);
            std::uint8_t codes[kUastcTexels];
            interpolate(e[0], e[1], w, codes);
            for (int k = 0; k < kUastcTexels; ++k) channels[c][k] = pattern->subset[k] == s ? codes[k] : channels[c][k];
        }
    }
}

std::optional<UastcParts> read_uastc_parts(const std::byte* block) {
    UastcParts parts;
    parts.mode = kUastcModeOfBits[std::to_integer<unsigned>(block[0]) & ((1u << kLongestUastcCode) - 1)];
    if (parts.mode == kUastcModes) return std::nullopt;
    const UastcMode& mode = parts.row();
    UastcHints& hints = parts.hints;
    BptcBits bits(block);
    bits.take(mode.code_bits);
    if (parts.mode == kUastcSolid) {
        for (std::uint8_t& code : parts.color) code = static_cast<std::uint8_t>(bits.take(8));
        hints.diff = bits.take(1) != 0;
        hints.table[0] = static_cast<std::uint8_t>(bits.take(3));
        hints.selector = static_cast<std::uint8_t>(bits.take(2));
        for (std::uint8_t& code : hints.base) code = static_cast<std::uint8_t>(bits.take(5));
        return parts;
    }
    // Modes 10 to 12 lack a hint and the bias; those with alpha have 8 bits for EAC.
    const bool has_all = mode.hint_bits != 17;
    hints.bc1_ends = bits.take(1) != 0;
    hints.bc1_weights = has_all && bits.take(1) != 0;
    hints.flip = bits.take(1) != 0;
    hints.diff = bits.take(1) != 0;
    for (std::uint8_t& table : hints.table) table = static_cast<std::uint8_t>(bits.take(3));
    if (has_all) hints.bias = static_cast<std::uint8_t>(bits.take(5));
    bits.take(mode.hint_bits - (has_all ? 15 : 9));
    if (mode.subsets > 1) parts.pattern_number = bits.take(mode.subsets == 2 ? 5 : 4);
    parts.pattern = uastc_pattern(parts.mode, parts.pattern_number);
    if (parts.pattern == nullptr) return std::nullopt;
    parts.second_channel = read_second_channel(bits, mode);
    read_endpoint_values(bits, mode.color_range, 2 * mode.channels * mode.subsets, parts.ends);
    for (int k = 0; k < kUastcTexels; ++k) {
        for (int plane = 0; plane < mode.planes; ++plane)
            parts.weights[plane][k] =
                static_cast<std::uint8_t>(bits.take(mode.weight_bits - (parts.pattern->is_anchor[k] ? 1 : 0)));
    }
    return parts;
}

BlockEntries read_uastc_entries(const std::byte* block) {
    BlockEntries entries;
    const std::optional<UastcParts> parts = read_uastc_parts(block);
    if (!parts || parts->mode == kUastcSolid) {
        std::uint8_t first[4][16];
        decode_uastc(block, first);
        for (int c = 0; c < 4; ++c) entries.code[0][c] = first[c][0];
        return entries;
    }
    const UastcMode& mode = parts->row();
    const int pattern_bits = mode.subsets == 1 ? 0 : mode.subsets == 2 ? 5 : 4;
    entries.front = mode.code_bits + mode.hint_bits + pattern_bits + (mode.planes == 2 && mode.channels != 2 ? 2 : 0) +
                    astc_ise_bits(mode.color_range, 2 * mode.channels * mode.subsets);
    for (int plane = 0; plane < mode.planes; ++plane) entries.bits[plane] = mode.weight_bits;
    entries.is_mixed = true;
    entries.subsets = mode.subsets;
    entries.count = 1 << (mode.planes * mode.weight_bits);
    for (int k = 0; k < kUastcTexels; ++k) {
        entries.subset[k] = parts->pattern->subset[k];
        entries.anchors |= parts->pattern->is_anchor[k] ? 1u << k : 0u;
    }
    const std::uint8_t* const meaning = kAstcMeanings.weight[kUastcWeightRanges[mode.weight_bits]];
    for (int n = 0; n < entries.total(); ++n) {
        const int s = n / entries.count, e = n % entries.count;
        for (int c = 0; c < 4; ++c) {
            const int index = c == parts->second_channel ? e >> mode.weight_bits : e & ((1 << mode.weight_bits) - 1);
            entries.code[n][c] = code_between(parts->end(s, c, 0), parts->end(s, c, 1), meaning[index]);
        }
    }
    return entries;
}

}  // namespace tex::inline v1
