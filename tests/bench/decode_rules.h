// SPDX-License-Identifier: Apache-2.0
// decode_rules.h: the rules by which processors return DXT5nm with 8 bits, and the least squared error that any block
// can have with such a rule (by an exhaustive search).
//
// If two codes are mixed, with k of n parts of the second one:
//
//     AMD                 (64 - w) a + w b + 32 >> 6, w = 64 k / n rounded: 21 and 43 of green
//     Intel               (256 - w) a + w b + 128 >> 8, w = 256 k / n rounded
//     NVIDIA              green: 256 a + d / 4 + 128 + 80 d, divided by 256, d = b - a, both towards zero, a being the
//                         nearer code;
//                         alpha: the nearest code
//     Mesa and libsquish  (n - k) a + k b divided by n, rounded down
//
// Known: AMD's and NVIDIA's greens are those that rgbcx encodes for (Geldreich, bc7enc_rdo, rgbcx.h: bc1_approx_mode,
// interp_5_6_amd and interp_6_nv; measured by Castano, "GPU DXT Decompression", 2009). AMD's and Intel's mixes, the
// same for green and alpha, are those of Giesen ("GPU BCn decoding", 2021), who found expressions that match all three
// vendors to the last bit. Assumed: NVIDIA's alpha. rgbcx has one BC4 for all processors, with sevenths and fifths
// rounded down, and no formula was found elsewhere. Here it is the nearest code. Processors return BC4 and BC5 with
// more than 8 bits, so these rules apply to BC3.
// BC4 and BC5 with more bits than 8: these rules are for BC3.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace rules {

enum class Rule { amd, intel, nvidia, truncating };
inline constexpr const char* kNames[] = {"AMD", "Intel", "NVIDIA", "Mesa, libsquish"};

inline int mix(Rule rule, int a, int b, int k, int n) {
    const auto weight = [&](int one) { return (2 * one * k + n) / (2 * n); };
    switch (rule) {
        case Rule::amd: return ((64 - weight(64)) * a + weight(64) * b + 32) >> 6;
        case Rule::intel: return ((256 - weight(256)) * a + weight(256) * b + 128) >> 8;
        case Rule::nvidia: {
            const int d = k == 1 ? b - a : a - b;
            return n == 3 ? (256 * (k == 1 ? a : b) + d / 4 + 128 + 80 * d) / 256
                          : (2 * ((n - k) * a + k * b) + n) / (2 * n);
        }
        case Rule::truncating: break;
    }
    return ((n - k) * a + k * b) / n;
}

struct Palette {
    int count = 0;
    int values[8];  // in the order of the indices
};

inline Palette alpha_palette(Rule rule, int e0, int e1) {
    const int n = e0 > e1 ? 7 : 5;
    Palette p{8, {e0, e1}};
    for (int k = 1; k < n; ++k) p.values[k + 1] = mix(rule, e0, e1, k, n);
    if (n == 5) p.values[6] = 0, p.values[7] = 255;
    return p;
}

inline Palette green_palette(Rule rule, int c0, int c1) {  // 6 bits each
    const int a = c0 << 2 | c0 >> 4;
    const int b = c1 << 2 | c1 >> 4;
    return {4, {a, b, mix(rule, a, b, 1, 3), mix(rule, a, b, 2, 3)}};
}

// The squared errors of a block's 16 texels, in codes: with the indices as written, and with the nearest values (or any
// number that is at least `limit`, once it is reached).
inline double written_error(const Palette& palette, std::uint64_t indices, int bits, const float texels[16]) {
    double sum = 0;
    for (int k = 0; k < 16; ++k) {
        const double off = static_cast<double>(texels[k]) - palette.values[indices >> (bits * k) & ((1u << bits) - 1)];
        sum += off * off;
    }
    return sum;
}
inline float nearest_error(const Palette& palette, const float texels[16], float limit) {
    float sum = 0;
    for (int k = 0; k < 16 && sum < limit; ++k) {
        float least = 1e9f;
        for (int i = 0; i < palette.count; ++i) {
            const float off = texels[k] - static_cast<float>(palette.values[i]);
            least = std::min(least, off * off);
        }
        sum += least;
    }
    return sum;
}

inline float least_alpha_error(Rule rule, const float texels[16]) {
    float least = 1e9f;
    for (int e0 = 0; e0 < 256; ++e0) {
        for (int e1 = 0; e1 < 256; ++e1)
            least = std::min(least, nearest_error(alpha_palette(rule, e0, e1), texels, least));
    }
    return least;
}
inline float least_green_error(Rule rule, const float texels[16]) {
    float least = 1e9f;
    for (int c0 = 0; c0 < 64; ++c0) {
        for (int c1 = 0; c1 < 64; ++c1)
            least = std::min(least, nearest_error(green_palette(rule, c0, c1), texels, least));
    }
    return least;
}

inline std::uint64_t bytes(const std::byte* from, int count) {
    std::uint64_t value = 0;
    for (int k = 0; k < count; ++k) value |= std::to_integer<std::uint64_t>(from[k]) << (8 * k);
    return value;
}
inline double alpha_error(Rule rule, const std::byte* block, const float texels[16]) {
    return written_error(alpha_palette(rule, std::to_integer<int>(block[0]), std::to_integer<int>(block[1])),
                         bytes(block + 2, 6), 3, texels);
}
inline double green_error(Rule rule, const std::byte* block, const float texels[16]) {
    const auto colors = static_cast<int>(bytes(block + 8, 4));
    return written_error(green_palette(rule, colors >> 5 & 63, colors >> 21 & 63), bytes(block + 12, 4), 2, texels);
}

}  // namespace rules
