// SPDX-License-Identifier: Apache-2.0

#include "kernels/encode_uastc_colors.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "blocks/extent.h"
#include "blocks/uastc_modes.h"
#include "blocks/uastc_write.h"
#include "kernels/uastc_color_fit.h"
#include "kernels/uastc_color_guess.h"
#include "kernels/uastc_color_hints.h"

namespace tex::inline v1 {
namespace {

constexpr int kColorEdge = 4;
constexpr int kMostColorTries = 64;

// What an effort spends.
struct ColorEffort {
    Effort effort;
    int solves;
    int planes;    // choices of the channel in the second plane
    int parts;     // patterns of subsets
    bool three;    // also those of three subsets
    float worth;   // patterns are tried if their guesses are below this times the least error so far
    float enough;  // and only above this error
    int kept;      // the best of all are improved
    int rounds;
};

ColorEffort color_effort(Effort effort) {
    switch (effort) {
        case Effort::fast: return {effort, 2, 1, 1, false, 4.0f, 16.0f, 0, 0};
        case Effort::normal: return {effort, 3, 3, 8, true, 20.0f, 0.0f, 3, 2};
        default: return {effort, 6, 3, 48, true, 1e9f, 0.0f, 12, 6};
    }
}

// A way to fit a block, and its fits: of subsets, or of planes.
struct ColorTry {
    float error = 0.0f;
    int mode = 0;
    unsigned pattern = 0;
    unsigned second_channel = 0;
    UastcColorFit fits[3] = {};

    [[nodiscard]] const UastcMode& row() const { return kUastcModeTable[mode]; }
    [[nodiscard]] int count() const { return row().planes == 2 ? 2 : row().subsets; }
    [[nodiscard]] UastcColorLine line(int n) const {
        constexpr unsigned kAllChannels = 7, kAllTexels = 0xffff;
        const unsigned second = 1u << second_channel;
        const bool has_planes = row().planes == 2;
        return {row().color_range, row().weight_bits, has_planes ? kAllTexels : uastc_texels(mode, pattern, n),
                !has_planes ? kAllChannels
                : n == 1    ? second
                            : kAllChannels & ~second};
    }
};

class ColorBlock {
public:
    ColorBlock(const UastcColors& colors, const ColorEffort& effort) : colors_(colors), effort_(effort) {}

    UastcContent encode() {
        add(colors_.is_grey ? 15 : 0);
        add(18);
        add(5);
        if (least_ > effort_.enough) add_guesses();
        return content_of(best());
    }

private:
    void add_guesses() {
        UastcColorGuess guesses[kUastcColorGuesses];
        if (!colors_.is_grey) {
            guess_uastc_color_planes(colors_, guesses);
            for (int n = 0; n < effort_.planes; ++n) add(guesses[n]);
        }
        const int most = guess_uastc_colors(colors_, effort_.three, effort_.parts, guesses);
        for (int n = 0; n < most && guesses[n].error < effort_.worth * least_; ++n) add(guesses[n]);
    }
    void add(const UastcColorGuess& guess) { add(guess.mode, guess.pattern, guess.second_channel); }
    void add(int mode, unsigned pattern = 0, unsigned second_channel = 0) {
        ColorTry& to = tries_[count_++];
        to.mode = mode;
        to.pattern = pattern;
        to.second_channel = second_channel;
        to.error = 0.0f;
        for (int n = 0; n < to.count(); ++n) {
            to.fits[n] = fit_uastc_colors(colors_, to.line(n), effort_.solves);
            to.error += to.fits[n].error;
        }
        least_ = std::min(least_, to.error);
    }

    // Whether one value varies, so that moves of endpoints are cheap.
    [[nodiscard]] bool is_scalar() const {
        int varying = 0;
        for (const auto& codes : colors_.code) varying += std::equal(codes + 1, codes + kUastcTexels, codes) ? 0 : 1;
        return colors_.is_grey || varying == 1;
    }

    const ColorTry& best() {
        const auto is_better = [](const ColorTry& a, const ColorTry& b) { return a.error < b.error; };
        const int most = std::max(effort_.kept, is_scalar() ? 1 : 0);
        if (most == 0) return *std::min_element(tries_, tries_ + count_, is_better);
        std::stable_sort(tries_, tries_ + count_, is_better);
        const int kept = std::min(most, count_);
        for (int k = 0; k < kept && tries_[0].error > 0.0f; ++k) {
            ColorTry& improved = tries_[k];
            improved.error = 0.0f;
            for (int n = 0; n < improved.count(); ++n) {
                improve_uastc_colors(colors_, improved.line(n), std::max(1, effort_.rounds), improved.fits[n]);
                improved.error += improved.fits[n].error;
            }
        }
        return *std::min_element(tries_, tries_ + kept, is_better);
    }

    [[nodiscard]] UastcContent content_of(const ColorTry& found) const {
        UastcContent content;
        content.mode = found.mode;
        content.pattern = found.pattern;
        content.second_channel = found.second_channel;
        const UastcMode& mode = found.row();
        if (mode.planes == 2) {
            for (int n = 0; n < 2; ++n) {
                std::copy_n(found.fits[n].weights, kUastcTexels, content.weights[n]);
                for (int e = 0; e < 2; ++e) {
                    for (unsigned c = 0; c < 3; ++c) {
                        if (found.line(n).channels >> c & 1) content.ends[0][e][c] = found.fits[n].ends[e][c];
                    }
                }
            }
        } else {
            const UastcPattern& pattern = *uastc_pattern(found.mode, found.pattern);
            for (int k = 0; k < kUastcTexels; ++k) content.weights[0][k] = found.fits[pattern.subset[k]].weights[k];
            for (int s = 0; s < mode.subsets; ++s) {
                for (int e = 0; e < 2; ++e) std::copy_n(found.fits[s].ends[e], 3, content.ends[s][e]);
            }
        }
        // Luminance and alpha.
        for (int s = 0; s < mode.subsets && mode.channels == 2; ++s) {
            for (auto& end : content.ends[s]) end[1] = uastc_color_number(mode.color_range, 255.0f);
        }
        find_uastc_color_hints(effort_.effort, colors_, content);
        return content;
    }

    const UastcColors& colors_;
    const ColorEffort& effort_;
    ColorTry tries_[kMostColorTries];
    int count_ = 0;
    float least_ = 1e30f;
};

std::uint8_t whole_code(float code) { return static_cast<std::uint8_t>(code + 0.5f); }

}  // namespace

void encode_uastc_colors(Format, Effort effort, const float* rgb, Extent extent, std::byte* blocks) {
    const ColorEffort spends = color_effort(effort);
    for (int top = 0; top < extent.height; top += kColorEdge) {
        for (int left = 0; left < extent.width; left += kColorEdge, blocks += kUastcBlockBytes) {
            UastcColors colors;
            colors.is_grey = true;
            bool is_one = true;
            std::uint8_t first[3] = {};
            for (int k = 0; k < kUastcTexels; ++k) {
                const int i = std::min(left + k % kColorEdge, extent.width - 1);
                const int j = std::min(top + k / kColorEdge, extent.height - 1);
                const float* const from = rgb + 3 * (static_cast<std::ptrdiff_t>(j) * extent.width + i);
                for (int c = 0; c < 3; ++c) {
                    const float code = 255.0f * std::fmin(std::fmax(from[c], 0.0f), 1.0f);
                    colors.code[c][k] = code;
                    colors.is_grey = colors.is_grey && code == colors.code[0][k];
                    if (k == 0) first[c] = whole_code(code);
                    is_one = is_one && whole_code(code) == first[c];
                }
            }
            write_uastc(is_one ? uastc_solid_color(first) : ColorBlock(colors, spends).encode(), blocks);
        }
    }
}

}  // namespace tex::inline v1
