// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "blocks/bc7_modes.h"
#include "blocks/bc7_write.h"
#include "blocks/bptc.h"
#include "blocks/uastc_parts.h"
#include "blocks/uastc_to.h"

namespace tex::inline v1 {
namespace {

// The partitions of BC7 that the patterns of UASTC are; of mode 7, those whose three subsets are its two, one divided.
constexpr std::uint8_t kBc7TwoSubsets[] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14,
                                           15, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 29, 32, 33, 52};
constexpr std::uint8_t kBc7ThreeSubsets[] = {4, 8, 9, 10, 11, 12, 13, 20, 35, 36, 57};
constexpr std::uint8_t kBc7Divided[] = {10, 11, 0, 2, 8, 13, 1, 33, 40, 20, 21, 58, 3, 32, 59, 34, 20, 14, 31};

// The mode of BC7 for each mode of UASTC.
constexpr std::uint8_t kBc7OfUastc[kUastcModes] = {6, 3, 1, 2, 3, 6, 5, 2, 6, 7, 6, 5, 6, 5, 6, 6, 7, 5, 6};

// Indices of 4 bits for those of 5, 3, 2 bits.
constexpr std::uint8_t kFourOfFive[32] = {0, 0, 1, 1, 2,  2,  3,  3,  4,  4,  5,  5,  6,  6,  6,  7,
                                          8, 9, 9, 9, 10, 10, 11, 11, 12, 12, 13, 13, 14, 14, 15, 15};
constexpr std::uint8_t kFourOfThree[8] = {0, 2, 4, 6, 9, 11, 13, 15};
constexpr std::uint8_t kFourOfTwo[4] = {0, 5, 10, 15};

// The code of `bits` bits, the lowest of which is p, that is closest to a code of 8 bits; and what it means.
struct LowestBit {
    int code[4];
    float error;
};

int code_with_lowest(float value, int bits, int p) {
    const int top = (1 << bits) - 1;
    const int code = static_cast<int>((value * static_cast<float>(top) - static_cast<float>(p)) / 2.0f + 0.5f) * 2 + p;
    return std::clamp(code, p, top - 1 + p);
}

float meaning_of(int code, int bits) {
    const int high = code << (8 - bits);
    return static_cast<float>(high | high >> bits);
}

// Sets both ends of a subset, with the lowest bits that suit them best.
void set_bc7_ends(Bc7Content& content, int subset, const int codes[2][4], int channels) {
    const Bc7Mode& mode = kBc7Modes[content.mode];
    const int bits = mode.color + 1;
    LowestBit tried[2][2] = {};  // by end and lowest bit
    for (int p = 0; p < 2; ++p) {
        for (int c = 0; c < 4; ++c) {
            for (int e = 0; e < 2; ++e) {
                LowestBit& to = tried[e][p];
                const float value = static_cast<float>(codes[e][c]) / 255.0f;
                to.code[c] = code_with_lowest(value, bits, p);
                if (c >= channels) continue;
                const float meaning = meaning_of(to.code[c], bits);
                const float off = mode.shared_p != 0 ? meaning / 255.0f - value : meaning - value * 255.0f;
                to.error += off * off;
            }
        }
    }
    int lowest[2];
    for (int e = 0; e < 2; ++e) lowest[e] = tried[e][1].error < tried[e][0].error ? 1 : 0;
    if (mode.shared_p != 0) {
        float both[2] = {};  // summed in the order of the channels, as the roundings are
        for (int p = 0; p < 2; ++p) {
            for (int c = 0; c < channels; ++c) {
                float off[2];
                for (int e = 0; e < 2; ++e)
                    off[e] = meaning_of(tried[e][p].code[c], bits) / 255.0f - static_cast<float>(codes[e][c]) / 255.0f;
                both[p] += off[0] * off[0] + off[1] * off[1];
            }
        }
        lowest[0] = lowest[1] = both[1] < both[0] ? 1 : 0;
    }
    for (int e = 0; e < 2; ++e) {
        for (int c = 0; c < 4; ++c) {
            const int code = c < channels ? tried[e][lowest[e]].code[c] : 254 + lowest[e];
            content.ends[subset][e][c] = static_cast<std::uint8_t>(code);
        }
    }
}

// Ends for one colour: those whose entry of a fixed index is closest, by code.
struct OneColor {
    struct Ends {
        int error = 1 << 20;
        std::uint8_t end[2] = {};
    };
    static constexpr int kIndex6 = 5, kIndex5 = 1, kWeight = 21;
    std::array<std::array<Ends, 256>, 2> mode6;
    std::array<Ends, 256> mode5;

    OneColor() {
        for (int lowest = 0; lowest < 2; ++lowest)
            fill(mode6[static_cast<std::size_t>(lowest)], [=](int n) { return 2 * n + lowest; });
        fill(mode5, [](int n) { return n << 1 | n >> 6; });
    }

    template <class Meaning>
    static void fill(std::array<Ends, 256>& table, const Meaning& meaning) {
        for (int low = 0; low < 128; ++low) {
            for (int high = 0; high < 128; ++high) {
                const int value = bptc_between(meaning(low), meaning(high), kWeight);
                for (int code = std::max(0, value - 2); code <= std::min(255, value + 2); ++code) {
                    Ends& ends = table[static_cast<std::size_t>(code)];
                    const int error = (value - code) * (value - code);
                    if (error < ends.error)
                        ends = {error, {static_cast<std::uint8_t>(low), static_cast<std::uint8_t>(high)}};
                }
            }
        }
    }
};

const OneColor& one_color() {
    static const OneColor tables;
    return tables;
}

void write_one_color(const std::uint8_t color[4], std::byte* out) {
    const OneColor& tables = one_color();
    int errors[2] = {};
    for (std::size_t p = 0; p < 2; ++p) {
        for (int c = 0; c < 4; ++c) errors[p] += tables.mode6[p][color[c]].error;
    }
    Bc7Content content = {};
    const bool is_mode5 = errors[0] > 0 && errors[1] > 0;
    const std::size_t lowest = errors[1] < errors[0] ? 1 : 0;
    content.mode = is_mode5 ? 5 : 6;
    for (int c = 0; c < 4; ++c) {
        const OneColor::Ends& ends = is_mode5 ? tables.mode5[color[c]] : tables.mode6[lowest][color[c]];
        for (int e = 0; e < 2; ++e) {
            const unsigned stored = is_mode5 ? ends.end[e] : 2u * ends.end[e] + static_cast<unsigned>(lowest);
            content.ends[0][e][c] = is_mode5 && c == 3 ? color[3] : static_cast<std::uint8_t>(stored);
        }
    }
    std::fill_n(content.color, 16, static_cast<std::uint8_t>(is_mode5 ? OneColor::kIndex5 : OneColor::kIndex6));
    write_bc7(content, out);
}

void set_bc7_planes(const UastcParts& parts, Bc7Content& content) {
    const int second = std::clamp(parts.second_channel, 0, 3);
    content.rotation = (static_cast<unsigned>(second) + 1u) & 3u;
    for (int c = 0; c < 4; ++c) {
        const int to = c == second ? 3 : c == 3 ? second : c;
        for (int e = 0; e < 2; ++e) {
            const int code = parts.end(0, c, e);
            content.ends[0][e][to] = static_cast<std::uint8_t>(to < 3 ? (code * 127 + 127) / 255 : code);
        }
    }
    const int factor = parts.row().weight_bits == 1 ? 3 : 1;
    for (int k = 0; k < 16; ++k) {
        content.color[k] = static_cast<std::uint8_t>(factor * parts.weights[0][k]);
        content.alpha[k] = static_cast<std::uint8_t>(factor * parts.weights[1][k]);
    }
}

unsigned partition_of(const UastcParts& parts) {
    if (parts.row().subsets == 1) return 0;
    if (parts.row().subsets == 3) return kBc7ThreeSubsets[parts.pattern_number];
    return parts.mode == 7 ? kBc7Divided[parts.pattern_number] : kBc7TwoSubsets[parts.pattern_number];
}

void set_bc7_lines(const UastcParts& parts, Bc7Content& content) {
    const Bc7Mode& mode = kBc7Modes[content.mode];
    content.partition = partition_of(parts);
    for (int to = 0; to < mode.subsets; ++to) {
        // One line in two subsets is both.
        const unsigned texels = mode.subsets == 1 ? 1u : bptc_texels(mode.subsets, content.partition, to);
        const int from = parts.pattern->subset[std::countr_zero(texels)];
        int codes[2][4];
        for (int e = 0; e < 2; ++e) {
            for (int c = 0; c < 4; ++c) codes[e][c] = parts.end(from, c, e);
        }
        if (mode.own_p + mode.shared_p != 0) {
            set_bc7_ends(content, to, codes, parts.row().channels == 3 ? 3 : 4);
            continue;
        }
        for (int e = 0; e < 2; ++e) {
            for (int c = 0; c < 3; ++c)
                content.ends[to][e][c] = static_cast<std::uint8_t>((codes[e][c] * 31 + 127) / 255);
        }
    }
    for (int k = 0; k < 16; ++k) {
        const std::uint8_t weight = parts.weights[0][k];
        const int bits = parts.row().weight_bits;
        content.color[k] = mode.index != 4 || bits == 4 ? weight
                           : bits == 5                  ? kFourOfFive[weight]
                           : bits == 3                  ? kFourOfThree[weight]
                                                        : kFourOfTwo[weight];
    }
}

}  // namespace

void uastc_to_bc7(const std::byte* block, std::byte* out) {
    const std::optional<UastcParts> parts = read_uastc_parts(block);
    std::memset(out, 0, kBc7BlockBytes);
    if (!parts) return;
    if (parts->mode == kUastcSolid) return write_one_color(parts->color, out);
    Bc7Content content = {};
    content.mode = kBc7OfUastc[parts->mode];
    parts->row().planes == 2 ? set_bc7_planes(*parts, content) : set_bc7_lines(*parts, content);
    write_bc7(content, out);
}

}  // namespace tex::inline v1
