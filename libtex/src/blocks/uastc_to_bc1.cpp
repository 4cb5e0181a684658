// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <cstring>

#include "blocks/uastc.h"
#include "blocks/uastc_parts.h"
#include "blocks/uastc_to.h"

namespace tex::inline v1 {
namespace {

constexpr int kBc1Bytes = 8;
constexpr int kBc1Top[] = {31, 63, 31};

int widened_end(int code, int c) { return c == 1 ? code << 2 | code >> 4 : code << 3 | code >> 2; }

// Two ends of 5, 6 and 5 bits, and which step between them each texel is at, from 0 to 3.
struct Bc1Fit {
    int end[2][3] = {};
    int step[16] = {};

    [[nodiscard]] unsigned packed(int e) const {
        return static_cast<unsigned>(end[e][0] << 11 | end[e][1] << 5 | end[e][2]);
    }
};

void store_bc1(unsigned first, unsigned second, std::uint32_t indices, std::byte* out) {
    for (unsigned k = 0; k < 2; ++k) {
        out[k] = static_cast<std::byte>(first >> (8 * k));
        out[2 + k] = static_cast<std::byte>(second >> (8 * k));
    }
    for (unsigned k = 0; k < 4; ++k) out[4 + k] = static_cast<std::byte>(indices >> (8 * k));
}

// Blocks of three colours are avoided: the first end is the greater one.
void write_bc1_fit(const Bc1Fit& fit, std::byte* out) {
    constexpr std::uint32_t kIndices[] = {0, 2, 3, 1}, kAllOnes = 0x55555555;
    unsigned first = fit.packed(0), second = fit.packed(1);
    if (first == second) {
        if (second > 0) return store_bc1(first, second - 1, 0, out);
        return store_bc1(1, 0, kAllOnes, out);
    }
    std::uint32_t indices = 0;
    for (unsigned k = 0; k < 16; ++k) indices |= kIndices[fit.step[k]] << (2 * k);
    if (first > second) return store_bc1(first, second, indices, out);
    store_bc1(second, first, indices ^ kAllOnes, out);
}

// For each code, the ends whose third at the first one is closest, with a preference for close ones.
struct OneBc1 {
    struct Ends {
        std::uint8_t high, low;
    };
    std::array<Ends, 256> of5{}, of6{};

    OneBc1() {
        fill(of5, 0);
        fill(of6, 1);
    }

    static void fill(std::array<Ends, 256>& table, int c) {
        for (int code = 0; code < 256; ++code) {
            int least = 256;
            for (int low = 0; low <= kBc1Top[c]; ++low) {
                for (int high = 0; high <= kBc1Top[c]; ++high) {
                    const int l = widened_end(low, c), h = widened_end(high, c);
                    const int error = std::abs((2 * h + l) / 3 - code) + std::abs(h - l) * 3 / 100;
                    if (error >= least) continue;
                    least = error;
                    table[static_cast<std::size_t>(code)] = {static_cast<std::uint8_t>(high),
                                                             static_cast<std::uint8_t>(low)};
                }
            }
        }
    }
    [[nodiscard]] Ends of(int code, int c) const { return (c == 1 ? of6 : of5)[static_cast<std::size_t>(code)]; }
};

const OneBc1& one_bc1() {
    static const OneBc1 tables;
    return tables;
}

void write_one_bc1(const int color[3], std::byte* out) {
    constexpr std::uint32_t kAllTwos = 0xaaaaaaaa, kAllOnes = 0x55555555;
    Bc1Fit fit;
    for (int c = 0; c < 3; ++c) {
        const OneBc1::Ends ends = one_bc1().of(color[c], c);
        fit.end[0][c] = ends.high;
        fit.end[1][c] = ends.low;
    }
    const unsigned high = fit.packed(0), low = fit.packed(1);
    if (high == low) {
        if (low > 0) return store_bc1(high, low - 1, 0, out);
        return store_bc1(1, 0, kAllOnes, out);
    }
    if (high > low) return store_bc1(high, low, kAllTwos, out);
    store_bc1(low, high, kAllTwos ^ kAllOnes, out);
}

// The step that is closest to each texel along the line.
void find_bc1_steps(const std::uint8_t codes[4][16], Bc1Fit& fit) {
    int along[4] = {}, axis[3];
    for (int c = 0; c < 3; ++c) {
        const int first = widened_end(fit.end[0][c], c), last = widened_end(fit.end[1][c], c);
        axis[c] = last - first;
        const int colors[4] = {first, (2 * first + last) / 3, (2 * last + first) / 3, last};
        for (int m = 0; m < 4; ++m) along[m] += colors[m] * axis[c];
    }
    for (int k = 0; k < 16; ++k) {
        int twice = 0;
        for (int c = 0; c < 3; ++c) twice += 2 * codes[c][k] * axis[c];
        fit.step[k] =
            3 - ((twice <= along[0] + along[1]) + (twice < along[1] + along[2]) + (twice < along[2] + along[3]));
    }
}

// Ends by least squares for these steps, then steps for these ends.
void fit_bc1_ends(const std::uint8_t codes[4][16], Bc1Fit& fit) {
    constexpr int kSquares[4][3] = {{0, 0, 9}, {1, 2, 4}, {4, 2, 1}, {9, 0, 0}};  // of w w, (1 - w) w, (1 - w)(1 - w)
    int sums[3] = {};
    for (const int step : fit.step) {
        for (int n = 0; n < 3; ++n) sums[n] += kSquares[step][n];
    }
    const auto ww = static_cast<float>(sums[0]), vw = static_cast<float>(sums[1]), vv = static_cast<float>(sums[2]);
    const float determinant = ww * vv - vw * vw;
    for (int c = 0; c < 3; ++c) {
        int all = 0, weighted = 0, least = 255, most = 0;
        for (int k = 0; k < 16; ++k) {
            all += codes[c][k];
            weighted += fit.step[k] * codes[c][k];
            least = std::min<int>(least, codes[c][k]);
            most = std::max<int>(most, codes[c][k]);
        }
        if (std::fabs(determinant) < 1e-8f) {
            const OneBc1::Ends ends = one_bc1().of((all + 8) >> 4, c);
            fit.end[0][c] = ends.high;
            fit.end[1][c] = ends.low;
            continue;
        }
        const float over = 3.0f / determinant;
        const auto q0 = static_cast<float>(weighted);
        const float q1 = static_cast<float>(all) * 3.0f - q0;
        float low = (vv * over) * q0 + (-vw * over) * q1, high = (-vw * over) * q0 + (ww * over) * q1;
        if ((low < 0.0f || high > 255.0f) && least == most) low = high = static_cast<float>(least);
        const float ends[2] = {low, high};
        for (int e = 0; e < 2; ++e) {
            const auto top = static_cast<float>(kBc1Top[c]);
            fit.end[e][c] = std::clamp(static_cast<int>(ends[e] * (top / 255.0f) + 0.5f), 0, kBc1Top[c]);
        }
    }
    find_bc1_steps(codes, fit);
}

// The two texels that are farthest apart on the principal axis.
void find_bc1_ends(const std::uint8_t codes[4][16], Bc1Fit& fit) {
    int mean[3], least[3], most[3], products[3][3] = {};
    for (int c = 0; c < 3; ++c) {
        int sum = 8;
        least[c] = most[c] = codes[c][0];
        for (int k = 0; k < 16; ++k) {
            sum += codes[c][k];
            least[c] = std::min<int>(least[c], codes[c][k]);
            most[c] = std::max<int>(most[c], codes[c][k]);
        }
        mean[c] = sum >> 4;
    }
    for (int k = 0; k < 16; ++k) {
        for (int c = 0; c < 3; ++c) {
            for (int e = 0; e < 3; ++e) products[c][e] += (codes[c][k] - mean[c]) * (codes[e][k] - mean[e]);
        }
    }
    float axis[3], longest = 0.0f;
    for (int c = 0; c < 3; ++c) axis[c] = static_cast<float>(most[c] - least[c]);
    for (int round = 0; round < 4; ++round) {
        float next[3];
        for (int c = 0; c < 3; ++c) {
            float product[3];
            for (int e = 0; e < 3; ++e) product[e] = axis[e] * (static_cast<float>(products[c][e]) * (1.0f / 255.0f));
            next[c] = product[0] + product[1] + product[2];
        }
        std::copy_n(next, 3, axis);
    }
    for (const float value : axis) longest = std::max(longest, std::fabs(value));
    int whole[3] = {306, 601, 117};
    for (int c = 0; c < 3 && longest >= 2.0f; ++c) whole[c] = static_cast<int>(axis[c] * (1024.0f / longest));
    int low = INT_MAX, high = INT_MIN, at[2] = {};
    for (int k = 0; k < 16; ++k) {
        int along = 0;
        for (int c = 0; c < 3; ++c) along += codes[c][k] * whole[c];
        if (along < low) at[0] = k;
        if (along > high) at[1] = k;
        low = std::min(low, along);
        high = std::max(high, along);
    }
    for (int e = 0; e < 2; ++e) {
        for (int c = 0; c < 3; ++c) {
            const int scaled = codes[c][at[e]] * kBc1Top[c] + 128;
            fit.end[e][c] = (scaled + (scaled >> 8)) >> 8;
        }
    }
    find_bc1_steps(codes, fit);
}

// The weights of the first plane as steps.
void take_steps(const UastcParts& parts, Bc1Fit& fit) {
    constexpr int kFirst[6] = {0, 0, 1, 2, 3, 6};  // so many weights at either end are the first and the last step
    const int bits = parts.row().weight_bits, levels = 1 << bits, first = kFirst[bits];
    for (int k = 0; k < 16; ++k) {
        const int weight = parts.weights[0][k];
        fit.step[k] = bits == 1 ? 3 * weight : (weight >= first) + (2 * weight >= levels) + (weight >= levels - first);
    }
}

}  // namespace

void uastc_to_bc1(const std::byte* block, std::byte* out) {
    std::memset(out, 0, kBc1Bytes);
    const std::optional<UastcParts> parts = read_uastc_parts(block);
    if (!parts) return;
    if (parts->mode == kUastcSolid) {
        const int color[3] = {parts->color[0], parts->color[1], parts->color[2]};
        return write_one_bc1(color, out);
    }
    Bc1Fit fit;
    if (parts->hints.bc1_ends) {
        for (int e = 0; e < 2; ++e) {
            for (int c = 0; c < 3; ++c) fit.end[e][c] = (parts->end(0, c, e) * kBc1Top[c] + 127) / 255;
        }
        take_steps(*parts, fit);
        return write_bc1_fit(fit, out);
    }
    std::uint8_t codes[4][16];
    decode_uastc(block, codes);
    if (parts->hints.bc1_weights) {
        take_steps(*parts, fit);
    } else {
        bool is_one = true;
        for (int k = 1; k < 16; ++k) {
            for (int c = 0; c < 3; ++c) is_one = is_one && codes[c][k] == codes[c][0];
        }
        const int color[3] = {codes[0][0], codes[1][0], codes[2][0]};
        if (is_one) return write_one_bc1(color, out);
        find_bc1_ends(codes, fit);
    }
    fit_bc1_ends(codes, fit);
    write_bc1_fit(fit, out);
}

}  // namespace tex::inline v1
