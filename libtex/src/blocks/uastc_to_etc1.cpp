// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cstring>

#include "blocks/astc_ise.h"
#include "blocks/uastc.h"
#include "blocks/uastc_parts.h"
#include "blocks/uastc_to.h"

namespace tex::inline v1 {
namespace {

constexpr int kEtc1Sizes[8][2] = {{2, 8}, {5, 17}, {9, 29}, {13, 42}, {18, 60}, {24, 80}, {33, 106}, {47, 183}};

// What a bias adds to a channel of the base colour of a half.
int bias_of(unsigned bias, int half, int c) {
    constexpr int kPowers[] = {1, 3, 9};
    // Biases of one channel of one half: the channel + 3 * half + 6 if it is added.
    constexpr int kNone = -1;
    constexpr int kOnes[32] = {kNone, kNone, 0,     kNone, kNone, 1,     2,     6,     11,    kNone, kNone,
                               7,     kNone, kNone, kNone, 8,     kNone, kNone, 3,     4,     5,     9,
                               kNone, kNone, 10,    kNone, kNone, kNone, kNone, kNone, kNone, kNone};
    switch (bias) {
        case 10: return -2;
        case 27: return half == 0 ? -1 : 0;
        case 28: return half == 0 ? 1 : -1;
        case 29: return half == 0 ? 0 : 1;
        case 30: return half == 0 ? 0 : -1;
        case 31: return half == 0 ? 1 : 0;
        default: break;
    }
    if (kOnes[bias] == kNone) return static_cast<int>(bias) / kPowers[c] % 3 - 1;
    if (kOnes[bias] % 6 != c + 3 * half) return 0;
    return kOnes[bias] < 6 ? -1 : 1;
}

int with_bias(int code, int bias, int limit) {
    if (code == 0) return bias == -2 ? 3 : bias + 1;
    if (code == limit) return code + bias - 1;
    const int moved = code + bias;
    return moved < 0 || moved > limit ? code - bias : moved;
}

// A base colour of 4 or 5 bits a channel as one of 8.
int widened_base(int code, bool is_diff) { return is_diff ? code << 3 | code >> 2 : 17 * code; }

struct Etc1Half {
    int base[3];
    int table;

    [[nodiscard]] int color(int modifier, int c) const {  // 0: the darkest one
        const int size = kEtc1Sizes[table][modifier == 0 || modifier == 3 ? 1 : 0];
        return std::clamp(base[c] + (modifier < 2 ? -size : size), 0, 255);
    }
};

int etc1_half_of(int texel, bool flip) { return (flip ? texel / 4 : texel % 4) / 2; }

}  // namespace

void uastc_etc1_bases(const std::uint8_t codes[][16], const UastcHints& hints, bool has_bias, int bases[2][3]) {
    const int limit = hints.diff ? 31 : 15;
    for (int c = 0; c < 3; ++c) {
        int base[2];
        for (int half = 0; half < 2; ++half) {
            int sum = 0;
            for (int k = 0; k < 16; ++k) sum += etc1_half_of(k, hints.flip) == half ? codes[c][k] : 0;
            base[half] = (sum * limit + 1020) / (8 * 255);
            if (has_bias) base[half] = with_bias(base[half], bias_of(hints.bias, half, c), limit);
        }
        if (hints.diff) base[1] = base[0] + std::clamp(base[1] - base[0], -4, 3);
        for (int half = 0; half < 2; ++half) bases[half][c] = widened_base(base[half], hints.diff);
    }
}

void uastc_to_etc1(const std::byte* block, std::uint8_t rgb[16][3]) {
    std::memset(rgb, 0, 16 * 3);
    const std::optional<UastcParts> parts = read_uastc_parts(block);
    if (!parts) return;
    Etc1Half halves[2];
    if (parts->mode == kUastcSolid) {
        const UastcHints& hints = parts->hints;
        for (int half = 0; half < 2; ++half) {
            halves[half].table = hints.table[0];
            for (int c = 0; c < 3; ++c) {
                // What is above 4 bits falls into the first half.
                const int four = (hints.base[c] & 15) | (half == 0 ? hints.base[c] >> 4 : 0);
                halves[half].base[c] = widened_base(hints.diff ? hints.base[c] : four, hints.diff);
            }
        }
        for (int k = 0; k < 16; ++k) {
            for (int c = 0; c < 3; ++c)
                rgb[k][c] = static_cast<std::uint8_t>(halves[etc1_half_of(k, false)].color(hints.selector, c));
        }
        return;
    }
    std::uint8_t codes[4][16];
    decode_uastc(block, codes);
    int bases[2][3];
    uastc_etc1_bases(codes, parts->hints, parts->mode < 10 || parts->mode > 12, bases);
    for (int half = 0; half < 2; ++half) {
        std::copy_n(bases[half], 3, halves[half].base);
        halves[half].table = parts->hints.table[half];
    }
    constexpr int kLight[] = {54, 183, 19};
    int light[2][4] = {};
    for (int half = 0; half < 2; ++half) {
        for (int m = 0; m < 4; ++m) {
            for (int c = 0; c < 3; ++c) light[half][m] += kLight[c] * halves[half].color(m, c);
        }
    }
    for (int k = 0; k < 16; ++k) {
        const int half = etc1_half_of(k, parts->hints.flip);
        int twice = 0;
        for (int c = 0; c < 3; ++c) twice += 2 * kLight[c] * codes[c][k];
        int m = 0;
        while (m < 3 && twice >= light[half][m] + light[half][m + 1]) ++m;
        for (int c = 0; c < 3; ++c) rgb[k][c] = static_cast<std::uint8_t>(halves[half].color(m, c));
    }
}

void uastc_to_astc(const std::byte* block, std::uint16_t rgba[16][4]) {
    std::memset(rgba, 0, 16 * 4 * sizeof(std::uint16_t));
    const std::optional<UastcParts> parts = read_uastc_parts(block);
    if (!parts) return;
    for (int k = 0; k < 16; ++k) {
        for (int c = 0; c < 4; ++c) {
            if (parts->mode == kUastcSolid) {
                rgba[k][c] = static_cast<std::uint16_t>(257 * parts->color[c]);
                continue;
            }
            const std::uint8_t* const meaning = kAstcMeanings.weight[kUastcWeightRanges[parts->row().weight_bits]];
            const int weight = meaning[parts->weights[c == parts->second_channel ? 1 : 0][k]];
            const int s = parts->pattern->subset[k];
            const int e0 = parts->end(s, c, 0), e1 = parts->end(s, c, 1);
            rgba[k][c] = static_cast<std::uint16_t>((257 * (e0 * (64 - weight) + e1 * weight) + 32) >> 6);
        }
    }
}

}  // namespace tex::inline v1
