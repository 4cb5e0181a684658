// SPDX-License-Identifier: Apache-2.0

#include "kernels/uastc_color_hints.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "blocks/bc1.h"
#include "blocks/uastc_modes.h"
#include "blocks/uastc_to.h"

namespace tex::inline v1 {
namespace {

constexpr int kColorModifiers[8][2] = {{2, 8}, {5, 17}, {9, 29}, {13, 42}, {18, 60}, {24, 80}, {33, 106}, {47, 183}};
constexpr int kColorLight[3] = {54, 183, 19};  // by which transcoders choose modifiers
constexpr int kColorBiases = 32, kAllTables = 7;

// Eight texels of a block: what is wanted, and twice the luminance of what the block has.
struct ColorHalf {
    float wanted[3][8];
    float light[8];
};

// The least error of a half around a base, over tables that are so near to the given one.
float best_color_table(const ColorHalf& texels, const int base[3], int reach, std::uint8_t& table) {
    float least = std::numeric_limits<float>::max();
    const int first = std::max(0, table - reach), last = std::min(7, table + reach);
    for (int t = first; t <= last; ++t) {
        const int small = kColorModifiers[t][0], large = kColorModifiers[t][1];
        const int modifiers[4] = {-large, -small, small, large};
        int light[4] = {};
        for (int m = 0; m < 4; ++m) {
            for (int c = 0; c < 3; ++c) light[m] += kColorLight[c] * std::clamp(base[c] + modifiers[m], 0, 255);
        }
        float modifier[8], sum[8] = {};
        std::fill_n(modifier, 8, static_cast<float>(-large));
        for (int m = 0; m < 3; ++m) {
            const auto limit = static_cast<float>(light[m] + light[m + 1]), next = static_cast<float>(modifiers[m + 1]);
            for (int k = 0; k < 8; ++k) modifier[k] = texels.light[k] >= limit ? next : modifier[k];
        }
        for (int c = 0; c < 3; ++c) {
            const auto its_base = static_cast<float>(base[c]);
            for (int k = 0; k < 8; ++k) {
                float code = its_base + modifier[k];
                code = code < 0.0f ? 0.0f : code;
                code = code > 255.0f ? 255.0f : code;
                const float off = code - texels.wanted[c][k];
                sum[k] += off * off;
            }
        }
        float error = 0.0f;
        for (const float of_texel : sum) error += of_texel;
        if (error >= least) continue;
        least = error;
        table = static_cast<std::uint8_t>(t);
    }
    return least;
}

// The bias that leaves black and white channels as they are, where kEtc1Unmoved does not: each channel has its own
// power of three, in which 2 is one step more.
std::uint8_t extreme_bias(const std::uint8_t codes[3][16]) {
    int bias = 0;
    for (int c = 2; c >= 0; --c) {
        int sum = 0;
        for (int k = 0; k < 16; ++k) sum += codes[c][k];
        bias = 3 * bias + (sum == 0 ? 0 : sum == 16 * 255 ? 2 : 1);
    }
    return static_cast<std::uint8_t>(bias);
}

class ColorEtc1Search {
public:
    ColorEtc1Search(const UastcColors& colors, const std::uint8_t codes[3][16], UastcHints& hints)
        : codes_(codes), hints_(hints) {
        for (int k = 0; k < 16; ++k) {
            int light = 0;
            for (int c = 0; c < 3; ++c) light += kColorLight[c] * codes[c][k];
            for (const bool flip : {false, true}) {
                const int half = (flip ? k / 4 : k % 4) / 2, at = flip ? k % 8 : k / 4 * 2 + k % 2;
                ColorHalf& to = halves_[flip ? 1 : 0][half];
                for (int c = 0; c < 3; ++c) to.wanted[c][at] = colors.code[c][k];
                to.light[at] = static_cast<float>(2 * light);
            }
        }
    }

    // All four ways without a bias; the one that suits extremes; unless fast, all biases for the best way.
    void find(Effort effort) {
        UastcHints tried = hints_;
        tried.bias = kEtc1Unmoved;
        for (const bool flip : {false, true}) {
            for (const bool diff : {false, true}) {
                tried.flip = flip;
                tried.diff = diff;
                consider(tried, kAllTables);
            }
        }
        const UastcHints best = hints_;
        const std::uint8_t extreme = extreme_bias(codes_);
        for (std::uint8_t bias = 0; bias < kColorBiases; ++bias) {
            tried = best;
            tried.bias = bias;
            if (bias != kEtc1Unmoved && (effort != Effort::fast || bias == extreme)) consider(tried, 1);
        }
    }

private:
    void consider(UastcHints tried, int reach) {
        int bases[2][3];
        uastc_etc1_bases(codes_, tried, true, bases);
        float error = 0.0f;
        for (int half = 0; half < 2 && error < least_; ++half)
            error += best_color_table(halves_[tried.flip ? 1 : 0][half], bases[half], reach, tried.table[half]);
        if (error >= least_) return;
        least_ = error;
        hints_ = tried;
    }

    const std::uint8_t (*const codes_)[16];
    UastcHints& hints_;
    ColorHalf halves_[2][2];
    float least_ = std::numeric_limits<float>::max();
};

float error_as_bc1(const UastcColors& colors, const UastcContent& content) {
    std::byte block[kUastcBlockBytes], bc1[8];
    write_uastc(content, block);
    uastc_to_bc1(block, bc1);
    float shown[3][16], alpha[16], error = 0.0f;
    decode_bc1(bc1, Bc1Mode::standard, shown[0], shown[1], shown[2], alpha);
    for (int c = 0; c < 3; ++c) {
        for (int k = 0; k < 16; ++k) {
            const float off = 255.0f * shown[c][k] - colors.code[c][k];
            error += off * off;
        }
    }
    return error;
}

// Endpoints and weights of a block of one subset may serve as they are.
void find_bc1(const UastcColors& colors, UastcContent& content) {
    if (kUastcModeTable[content.mode].subsets > 1) return;
    float least = error_as_bc1(colors, content);
    UastcContent tried = content;
    for (const bool ends : {false, true}) {
        tried.hints.bc1_ends = ends;
        tried.hints.bc1_weights = !ends;
        const float error = error_as_bc1(colors, tried);
        if (error >= least) continue;
        least = error;
        content.hints = tried.hints;
    }
}

}  // namespace

void find_uastc_color_hints(Effort effort, const UastcColors& colors, UastcContent& content) {
    std::uint8_t codes[3][16];
    uastc_texels(content, codes);
    if (kUastcModeTable[content.mode].channels == 2) {
        for (int c = 1; c < 3; ++c) std::copy_n(codes[0], 16, codes[c]);
    }
    ColorEtc1Search(colors, codes, content.hints).find(effort);
    find_bc1(colors, content);
}

UastcContent uastc_solid_color(const std::uint8_t color[3]) {
    UastcContent content;
    content.mode = kUastcSolid;
    std::copy_n(color, 3, content.ends[0][0]);
    UastcHints& hints = content.hints;
    int least = std::numeric_limits<int>::max();
    for (int n = 0; n < 64; ++n) {
        const bool diff = n >= 32;
        const int table = n / 4 % 8, selector = n % 4, limit = diff ? 31 : 15;
        const int size = kColorModifiers[table][selector == 0 || selector == 3 ? 1 : 0];
        const int modifier = selector < 2 ? -size : size;
        int base[3], error = 0;
        for (int c = 0; c < 3; ++c) {
            base[c] = std::clamp(((color[c] - modifier) * limit + 127) / 255, 0, limit);
            const int wide = diff ? base[c] << 3 | base[c] >> 2 : 17 * base[c];
            const int off = std::clamp(wide + modifier, 0, 255) - color[c];
            error += off * off;
        }
        if (error >= least) continue;
        least = error;
        hints.diff = diff;
        hints.table[0] = static_cast<std::uint8_t>(table);
        hints.selector = static_cast<std::uint8_t>(selector);
        for (int c = 0; c < 3; ++c) hints.base[c] = static_cast<std::uint8_t>(base[c]);
    }
    return content;
}

}  // namespace tex::inline v1
