// SPDX-License-Identifier: Apache-2.0

#include "blocks/uastc_write.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "blocks/astc_ise.h"
#include "blocks/uastc_modes.h"

namespace tex::inline v1 {
namespace {

// The stored values of each range of colours in the order of what they mean.
struct UastcOrders {
    std::uint8_t stored[kAstcRanges][256] = {};

    UastcOrders() {
        for (int range = kAstcLeastColorRange; range < kAstcRanges; ++range) {
            std::uint8_t* const begin = stored[range];
            std::uint8_t* const end = begin + kAstcRangeTable[range].levels;
            std::iota(begin, end, std::uint8_t{0});
            const std::uint8_t* const meaning = kAstcMeanings.color[range];
            std::sort(begin, end, [&](std::uint8_t a, std::uint8_t b) { return meaning[a] < meaning[b]; });
        }
    }
};

const UastcOrders& orders() {
    static const UastcOrders all;
    return all;
}

// The bits of a block, from the lowest one.
class UastcBits {
public:
    void put(unsigned value, int count) {
        if (count > 0) bits_.put(at_, count, value);
        at_ += count;
    }
    void store(std::byte* block) const { write_astc_bits(bits_, block); }

private:
    AstcBits bits_;
    int at_ = 0;
};

// Makes the weight of the first texel of a subset fit into one bit less.
void turn(UastcContent& content, const UastcMode& mode, const UastcPattern& pattern, int subset, int plane) {
    const auto* const first = std::find(pattern.subset, pattern.subset + kUastcTexels, subset);
    std::uint8_t* const weights = content.weights[plane];
    if (weights[first - pattern.subset] >> (mode.weight_bits - 1) == 0) return;
    for (int k = 0; k < kUastcTexels; ++k) {
        if (pattern.subset[k] == subset)
            weights[k] = static_cast<std::uint8_t>((1 << mode.weight_bits) - 1 - weights[k]);
    }
    for (unsigned c = 0; c < mode.channels; ++c) {
        const int its_plane = mode.planes == 2 && c == content.second_channel ? 1 : 0;
        if (its_plane == plane) std::swap(content.ends[subset][0][c], content.ends[subset][1][c]);
    }
}

// All trits or quints come first, then the bits of each value.
void put_ends(UastcBits& to, int range, const std::uint8_t* values, int count) {
    constexpr int kTritBits[] = {0, 2, 4, 5, 7, 8}, kQuintBits[] = {0, 3, 5, 7};
    const AstcRange r = kAstcRangeTable[range];
    const int group = r.upper == 3 ? 5 : 3;
    for (int first = 0; r.upper > 1 && first < count; first += group) {
        const int in_group = std::min(group, count - first);
        unsigned packed = 0;
        for (int k = in_group; k-- > 0;)
            packed = packed * static_cast<unsigned>(r.upper) + (values[first + k] >> r.bits);
        to.put(packed, r.upper == 3 ? kTritBits[in_group] : kQuintBits[in_group]);
    }
    for (int k = 0; k < count; ++k) to.put(values[k] & ((1u << r.bits) - 1), r.bits);
}

void put_solid(UastcBits& to, const UastcContent& content) {
    const UastcHints& hints = content.hints;
    for (const std::uint8_t code : content.ends[0][0]) to.put(code, 8);
    to.put(content.alpha, 8);
    to.put(hints.diff ? 1 : 0, 1);
    to.put(hints.table[0], 3);
    to.put(hints.selector, 2);
    for (const std::uint8_t code : hints.base) to.put(code, 5);
}

void put_hints(UastcBits& to, const UastcMode& mode, const UastcHints& hints) {
    to.put(hints.bc1_ends ? 1 : 0, 1);
    to.put(hints.bc1_weights ? 1 : 0, 1);
    to.put(hints.flip ? 1 : 0, 1);
    to.put(hints.diff ? 1 : 0, 1);
    to.put(hints.table[0], 3);
    to.put(hints.table[1], 3);
    to.put(hints.bias, 5);
    if (mode.channels != 3) to.put(hints.eac, 8);
}

}  // namespace

std::uint8_t uastc_code(int range, int number) { return kAstcMeanings.color[range][orders().stored[range][number]]; }

void uastc_texels(const UastcContent& content, std::uint8_t codes[3][16]) {
    const UastcMode& mode = kUastcModeTable[content.mode];
    const UastcPattern& pattern = *uastc_pattern(content.mode, content.pattern);
    const std::uint8_t* const meaning = kAstcMeanings.weight[kUastcWeightRanges[mode.weight_bits]];
    for (unsigned c = 0; c < mode.channels; ++c) {
        const std::uint8_t* const weights = content.weights[mode.planes == 2 && c == content.second_channel ? 1 : 0];
        int begin[3] = {}, step[3] = {};
        for (int s = 0; s < mode.subsets; ++s) {
            const int e0 = uastc_code(mode.color_range, content.ends[s][0][c]);
            begin[s] = 257 * 64 * e0 + 32;
            step[s] = 257 * (uastc_code(mode.color_range, content.ends[s][1][c]) - e0);
        }
        for (int k = 0; k < kUastcTexels; ++k) {
            const int s = pattern.subset[k];
            codes[c][k] = static_cast<std::uint8_t>((begin[s] + step[s] * meaning[weights[k]]) >> 14);
        }
    }
}

void write_uastc(const UastcContent& given, std::byte* block) {
    UastcContent content = given;
    const UastcMode& mode = kUastcModeTable[content.mode];
    UastcBits to;
    to.put(mode.code, mode.code_bits);
    if (content.mode == kUastcSolid) {
        put_solid(to, content);
        return to.store(block);
    }
    const UastcPattern& pattern = *uastc_pattern(content.mode, content.pattern);
    for (int subset = 0; subset < mode.subsets; ++subset) {
        for (int plane = 0; plane < mode.planes; ++plane) turn(content, mode, pattern, subset, plane);
    }
    put_hints(to, mode, content.hints);
    if (mode.subsets > 1) to.put(content.pattern, mode.subsets == 2 ? 5 : 4);
    if (mode.planes > 1 && mode.channels == 3) to.put(content.second_channel, 2);
    std::uint8_t values[kUastcTexels + 2];
    int count = 0;
    for (int subset = 0; subset < mode.subsets; ++subset) {
        for (int c = 0; c < mode.channels; ++c) {
            for (int e = 0; e < 2; ++e) values[count++] = orders().stored[mode.color_range][content.ends[subset][e][c]];
        }
    }
    put_ends(to, mode.color_range, values, count);
    for (int k = 0; k < kUastcTexels; ++k) {
        for (int plane = 0; plane < mode.planes; ++plane)
            to.put(content.weights[plane][k], mode.weight_bits - (pattern.is_anchor[k] ? 1 : 0));
    }
    to.store(block);
}

}  // namespace tex::inline v1
