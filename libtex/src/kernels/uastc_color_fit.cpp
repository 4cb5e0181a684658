// SPDX-License-Identifier: Apache-2.0

#include "kernels/uastc_color_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "blocks/astc_ise.h"
#include "blocks/uastc_modes.h"
#include "kernels/uastc_color_weights.h"

namespace tex::inline v1 {
namespace {

class ColorFitter {
public:
    ColorFitter(const UastcColors& colors, const UastcColorLine& line)
        : part_{colors, uastc_color_range(line.range), kAstcMeanings.weight[kUastcWeightRanges[line.weight_bits]],
                1 << line.weight_bits} {
        for (int k = 0; k < kUastcTexels; ++k) {
            part_.inside[k] = line.texels >> k & 1 ? 1.0f : 0.0f;
            count_ += part_.inside[k];
        }
        for (int c = 0; c < (colors.is_grey ? 1 : 3); ++c) {
            if (line.channels >> c & 1) add(c);
        }
    }

    // Ends at the extremes of the principal axis.
    void begin(UastcColorFit& fit) {
        float axis[3] = {};
        find_axis(axis);
        float low = 0.0f, high = 0.0f;
        for (int k = 0; k < kUastcTexels; ++k) {
            float along = 0.0f;
            for (int n = 0; n < part_.active; ++n)
                along += axis[n] * part_.inside[k] * (part_.colors.code[part_.channel[n]][k] - mean_[part_.channel[n]]);
            low = std::min(low, along);
            high = std::max(high, along);
        }
        for (int n = 0; n < part_.active; ++n) {
            const int c = part_.channel[n];
            fit.ends[0][c] = round(mean_[c] + low * axis[n]);
            fit.ends[1][c] = round(mean_[c] + high * axis[n]);
        }
        for (int c = 0; c < 3; ++c) {
            if (fixed_ >> c & 1) fit.ends[0][c] = fit.ends[1][c] = round(mean_[c]);
        }
        settle_uastc_colors(part_, fit);
    }

    // Ends by least squares for the weights.
    void solve(UastcColorFit& fit) {
        float ww = 0.0f, vw = 0.0f, vv = 0.0f;
        for (int k = 0; k < kUastcTexels; ++k) {
            const float w = weight(fit, k), v = 1.0f - w;
            ww += part_.inside[k] * w * w;
            vw += part_.inside[k] * w * v;
            vv += part_.inside[k] * v * v;
        }
        const float determinant = ww * vv - vw * vw;
        for (int n = 0; n < part_.active; ++n) {
            const int c = part_.channel[n];
            float first = 0.0f, last = 0.0f;  // of differences from the mean
            for (int k = 0; k < kUastcTexels; ++k) {
                const float w = weight(fit, k), d = part_.inside[k] * (part_.colors.code[c][k] - mean_[c]);
                first += (1.0f - w) * d;
                last += w * d;
            }
            const float over = determinant > 1e-4f ? 1.0f / determinant : 0.0f;
            fit.ends[0][c] = round(mean_[c] + over * (ww * first - vw * last));
            fit.ends[1][c] = round(mean_[c] + over * (vv * last - vw * first));
        }
        settle_uastc_colors(part_, fit);
    }

    // Whether a move of an end, or of both ends, of a channel made the error smaller.
    bool move(UastcColorFit& fit, int n, unsigned which, int by) const {
        UastcColorFit moved = fit;
        for (unsigned e = 0; e < 2; ++e) {
            if ((which >> e & 1) == 0) continue;
            const int number = fit.ends[e][part_.channel[n]] + by;
            if (number < 0 || number >= part_.range.levels) return false;
            moved.ends[e][part_.channel[n]] = static_cast<std::uint8_t>(number);
        }
        settle_uastc_colors(part_, moved);
        if (moved.error >= fit.error) return false;
        fit = moved;
        return true;
    }

    void settle_exactly(UastcColorFit& fit) const { settle_uastc_colors_exactly(part_, fit); }
    [[nodiscard]] int active() const { return part_.active; }
    void be_exact() { part_.is_exact = true; }

private:
    // A channel that is the same everywhere, and a code of the range, needs no fit: it comes back exactly.
    void add(int c) {
        float sum = 0.0f, least = 255.0f, most = 0.0f;
        for (int k = 0; k < kUastcTexels; ++k) {
            const float code = part_.colors.code[c][k];
            sum += part_.inside[k] * code;
            if (part_.inside[k] == 0.0f) continue;
            least = std::min(least, code);
            most = std::max(most, code);
        }
        mean_[c] = sum / count_;
        if (least == most && static_cast<float>(part_.range.code[round(least)]) == least) {
            mean_[c] = least;
            fixed_ |= 1u << c;
            return;
        }
        part_.channel[part_.active++] = c;
    }

    void find_axis(float axis[3]) const {
        float products[3][3] = {};
        int greatest = 0;
        for (int a = 0; a < part_.active; ++a) {
            for (int b = 0; b < part_.active; ++b) {
                const int c = part_.channel[a], d = part_.channel[b];
                for (int k = 0; k < kUastcTexels; ++k)
                    products[a][b] +=
                        part_.inside[k] * (part_.colors.code[c][k] - mean_[c]) * (part_.colors.code[d][k] - mean_[d]);
            }
            if (products[a][a] > products[greatest][greatest]) greatest = a;
        }
        for (int n = 0; n < part_.active; ++n) axis[n] = products[greatest][n];
        constexpr int kTurns = 6;
        for (int turn = 0; turn <= kTurns; ++turn) {
            float next[3] = {}, squared = 0.0f;
            for (int a = 0; a < part_.active; ++a) {
                for (int b = 0; b < part_.active && turn > 0; ++b) next[a] += products[a][b] * axis[b];
                if (turn == 0) next[a] = axis[a];
                squared += next[a] * next[a];
            }
            const float over = squared > 0.0f ? 1.0f / std::sqrt(squared) : 0.0f;
            for (int n = 0; n < part_.active; ++n) axis[n] = over * next[n];
        }
    }

    [[nodiscard]] std::uint8_t round(float code) const { return part_.range.round(code); }
    [[nodiscard]] float weight(const UastcColorFit& fit, int k) const {
        return static_cast<float>(part_.meaning[fit.weights[k]]) * (1.0f / 64.0f);
    }

    UastcColorPart part_;
    float count_ = 0.0f;
    unsigned fixed_ = 0;
    float mean_[3] = {};
};

// What stands for grey stands for R, G and B.
void spread_grey(const UastcColors& colors, UastcColorFit& fit) {
    for (auto& end : fit.ends) {
        if (colors.is_grey) end[1] = end[2] = end[0];
    }
}

}  // namespace

UastcColorFit fit_uastc_colors(const UastcColors& colors, const UastcColorLine& line, int solves) {
    ColorFitter fitter(colors, line);
    UastcColorFit best = {};
    fitter.begin(best);
    for (int n = 0; n < solves && fitter.active() > 0; ++n) {
        UastcColorFit next = best;
        fitter.solve(next);
        if (next.error >= best.error) break;
        best = next;
    }
    fitter.settle_exactly(best);
    spread_grey(colors, best);
    return best;
}

void improve_uastc_colors(const UastcColors& colors, const UastcColorLine& line, int rounds, UastcColorFit& fit) {
    ColorFitter fitter(colors, line);
    fitter.be_exact();
    for (int round = 0; round < rounds; ++round) {
        bool any = false;
        for (int n = 0; n < fitter.active(); ++n) {
            for (const unsigned which : {1u, 2u, 3u}) {
                for (const int by : {-1, 1}) {
                    while (fitter.move(fit, n, which, by)) any = true;
                }
            }
        }
        if (!any) break;
        UastcColorFit next = fit;
        fitter.solve(next);
        if (next.error < fit.error) fit = next;
    }
    spread_grey(colors, fit);
}

std::uint8_t uastc_color_number(int range, float code) { return uastc_color_range(range).round(code); }

}  // namespace tex::inline v1
