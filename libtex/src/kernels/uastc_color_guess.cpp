// SPDX-License-Identifier: Apache-2.0

#include "kernels/uastc_color_guess.h"

#include <algorithm>
#include <cmath>

#include "blocks/astc_ise.h"
#include "blocks/uastc_modes.h"

namespace tex::inline v1 {
namespace {

// Sums over texels of a block: 1, R, G, B, RR, GG, BB, RG, RB, GB.
constexpr int kColorMoments = 10;
struct ColorMoments {
    float sum[kColorMoments] = {};

    void add(const ColorMoments& other) {
        for (int n = 0; n < kColorMoments; ++n) sum[n] += other.sum[n];
    }
    void take(const ColorMoments& other) {
        for (int n = 0; n < kColorMoments; ++n) sum[n] -= other.sum[n];
    }
};

// Products of differences from the mean, in the order above.
struct ColorSpread {
    float rr, gg, bb, rg, rb, gb;

    explicit ColorSpread(const ColorMoments& moments) {
        const float* const s = moments.sum;
        const float over = 1.0f / std::max(s[0], 1.0f);
        rr = std::max(0.0f, s[4] - s[1] * s[1] * over);
        gg = std::max(0.0f, s[5] - s[2] * s[2] * over);
        bb = std::max(0.0f, s[6] - s[3] * s[3] * over);
        rg = s[7] - s[1] * s[2] * over;
        rb = s[8] - s[1] * s[3] * over;
        gb = s[9] - s[2] * s[3] * over;
    }

    [[nodiscard]] ColorSpread squared() const {
        ColorSpread next = *this;
        next.rr = rr * rr + rg * rg + rb * rb;
        next.gg = rg * rg + gg * gg + gb * gb;
        next.bb = rb * rb + gb * gb + bb * bb;
        next.rg = rr * rg + rg * gg + rb * gb;
        next.rb = rr * rb + rg * gb + rb * bb;
        next.gb = rg * rb + gg * gb + gb * bb;
        return next;
    }
    [[nodiscard]] float all() const { return rr + gg + bb; }
    // What lies on the principal axis: the sum of the fifth powers of the eigenvalues over that of their fourth ones.
    [[nodiscard]] float on_axis() const {
        const ColorSpread four = squared().squared();
        const float fifth =
            four.rr * rr + four.gg * gg + four.bb * bb + 2.0f * (four.rg * rg + four.rb * rb + four.gb * gb);
        return four.all() > 0.0f ? fifth / four.all() : 0.0f;
    }
};

struct ColorSums {
    ColorMoments of[16], total;

    explicit ColorSums(const UastcColors& colors) {
        float mean[3] = {};
        for (int c = 0; c < 3; ++c) {
            for (const float code : colors.code[c]) mean[c] += 0.0625f * code;
        }
        for (int k = 0; k < 16; ++k) {
            const float r = colors.code[0][k] - mean[0], g = colors.code[1][k] - mean[1];
            const float b = colors.code[2][k] - mean[2];
            of[k] = {{1.0f, r, g, b, r * r, g * g, b * b, r * g, r * b, g * b}};
            total.add(of[k]);
        }
    }

    [[nodiscard]] ColorMoments over(unsigned texels) const {
        ColorMoments moments;
        for (int k = 0; k < 16; ++k) {
            if (texels >> k & 1) moments.add(of[k]);
        }
        return moments;
    }
};

// The square of the distance between weights, for a spread of 1: that of evenly spread values over these steps.
float step_of(int weight_bits) {
    const auto steps = static_cast<float>((1 << weight_bits) - 1);
    return 1.0f / (steps * steps);
}

// The error of endpoints in a range, in each channel of a texel; a half, since a fit makes up for some of it.
float rounding_of(int range) {
    const float step = 255.0f / static_cast<float>(kAstcRangeTable[range].levels - 1) - 1.0f;
    return step * step / 24.0f;
}

}  // namespace

int guess_uastc_colors(const UastcColors& colors, bool three, int most, UastcColorGuess* guesses) {
    const ColorSums sums(colors);
    UastcColorGuess* end = guesses;
    const auto add = [&](int mode, unsigned pattern, float off, float on, int channels) {
        const UastcMode& row = kUastcModeTable[mode];
        const float rounding = 16.0f * static_cast<float>(channels) * rounding_of(row.color_range);
        *end++ = {off + on * step_of(row.weight_bits) + rounding, static_cast<std::uint8_t>(mode),
                  static_cast<std::uint8_t>(pattern), 0};
    };
    const int channels = colors.is_grey ? 1 : 3;
    for (const int mode : {2, 7, 3}) {
        const int subsets = kUastcModeTable[mode].subsets;
        if (subsets == 3 && !three) continue;
        for (unsigned pattern = 0; pattern < uastc_patterns(mode); ++pattern) {
            float off = 0.0f, on = 0.0f;
            ColorMoments rest = sums.total;
            for (int s = 0; s < subsets; ++s) {
                const ColorMoments its = s + 1 < subsets ? sums.over(uastc_texels(mode, pattern, s)) : rest;
                if (s + 1 < subsets) rest.take(its);
                const ColorSpread spread(its);
                const float along = spread.on_axis();
                on += along;
                off += std::max(0.0f, spread.all() - along);
            }
            add(mode, pattern, off, on, channels);
            if (mode != 2) continue;
            add(4, pattern, off, on, channels);
            if (colors.is_grey) add(16, pattern, off, on, channels);
        }
    }
    const int found = std::min(most, static_cast<int>(end - guesses));
    std::partial_sort(guesses, guesses + found, end, [](const UastcColorGuess& a, const UastcColorGuess& b) {
        if (a.error != b.error) return a.error < b.error;
        return a.mode != b.mode ? a.mode < b.mode : a.pattern < b.pattern;
    });
    return found;
}

void guess_uastc_color_planes(const UastcColors& colors, UastcColorGuess guesses[3]) {
    constexpr int kPlanesMode = 6;
    const ColorSpread spread(ColorSums(colors).total);
    const float own[3] = {spread.rr, spread.gg, spread.bb};
    const float product[3] = {spread.gb, spread.rb, spread.rg};  // of the other two
    for (int c = 0; c < 3; ++c) {
        const float a = own[(c + 1) % 3], b = own[(c + 2) % 3];
        const float along = 0.5f * (a + b + std::sqrt((a - b) * (a - b) + 4.0f * product[c] * product[c]));
        const float off = std::max(0.0f, a + b - along);
        guesses[c] = {off + (along + own[c]) * step_of(kUastcModeTable[kPlanesMode].weight_bits), kPlanesMode, 0,
                      static_cast<std::uint8_t>(c)};
    }
    std::stable_sort(guesses, guesses + 3,
                     [](const UastcColorGuess& a, const UastcColorGuess& b) { return a.error < b.error; });
}

}  // namespace tex::inline v1
