// SPDX-License-Identifier: Apache-2.0

#include "kernels/uastc_color_weights.h"

#include <algorithm>
#include <cmath>

#include "blocks/astc_ise.h"
#include "blocks/uastc_modes.h"
#include "blocks/uastc_write.h"

namespace tex::inline v1 {
namespace {

struct ColorRanges {
    UastcColorRange of[kAstcRanges];

    ColorRanges() {
        for (const UastcMode& mode : kUastcModeTable) {
            UastcColorRange& range = of[mode.color_range];
            if (mode.subsets == 0 || range.levels > 0) continue;
            range.levels = kAstcRangeTable[mode.color_range].levels;
            for (int n = 0; n < range.levels; ++n) range.code[n] = uastc_code(mode.color_range, n);
            for (int code = 0, n = 0; code < 256; ++code) {
                while (n + 1 < range.levels && range.code[n + 1] - code < code - range.code[n]) ++n;
                range.nearest[code] = static_cast<std::uint8_t>(n);
            }
        }
    }
};

// Endpoints of active channels, as decoders use them: 2^14 is a code.
struct ColorEnds {
    float begin[3] = {}, step[3] = {};

    ColorEnds(const UastcColorPart& part, const UastcColorFit& fit) {
        for (int n = 0; n < part.active; ++n) {
            const int e0 = part.range.code[fit.ends[0][part.channel[n]]];
            begin[n] = static_cast<float>(257 * 64 * e0 + 32);
            step[n] = static_cast<float>(257 * (part.range.code[fit.ends[1][part.channel[n]]] - e0));
        }
    }
    // Whole numbers below 2^24, so that floats are exact.
    [[nodiscard]] float code(int n, float weight) const {
        return static_cast<float>(static_cast<int>((begin[n] + step[n] * weight) * (1.0f / 16384.0f)));
    }
};

void finish(const UastcColorPart& part, const float least[kUastcTexels], const float best[kUastcTexels],
            UastcColorFit& fit) {
    float error = 0.0f;
    for (int k = 0; k < kUastcTexels; ++k) {
        error += part.inside[k] * least[k];
        fit.weights[k] = static_cast<std::uint8_t>(best[k]);
    }
    fit.error = part.colors.is_grey ? 3.0f * error : error;
}

void settle_on_line(const UastcColorPart& part, UastcColorFit& fit) {
    alignas(64) float along[kUastcTexels] = {}, least[kUastcTexels] = {}, weight[kUastcTexels];
    const ColorEnds ends(part, fit);
    float squared = 0.0f;
    for (int n = 0; n < part.active; ++n) squared += ends.step[n] * ends.step[n];
    const auto top = static_cast<float>(part.levels - 1);
    const float over = squared > 0.0f ? 256.0f * top / squared : 0.0f;
    for (int n = 0; n < part.active; ++n) {
        const float* const from = part.colors.code[part.channel[n]];
        const float first = ends.begin[n] * (1.0f / 16448.0f), step = ends.step[n] * over;
        for (int k = 0; k < kUastcTexels; ++k) along[k] += (from[k] - first) * step;
    }
    for (int k = 0; k < kUastcTexels; ++k) {
        float index = along[k] + 0.5f;
        index = index < 0.0f ? 0.0f : index;
        index = index > top ? top : index;
        along[k] = static_cast<float>(static_cast<int>(index));
    }
    for (int k = 0; k < kUastcTexels; ++k) weight[k] = static_cast<float>(part.meaning[static_cast<int>(along[k])]);
    for (int n = 0; n < part.active; ++n) {
        const float* const from = part.colors.code[part.channel[n]];
        for (int k = 0; k < kUastcTexels; ++k) {
            const float off = from[k] - ends.code(n, weight[k]);
            least[k] += off * off;
        }
    }
    finish(part, least, along, fit);
}

}  // namespace

// Between two whole codes, the nearest number is that of one of them.
std::uint8_t UastcColorRange::round(float value) const {
    const float clamped = std::min(std::max(value, 0.0f), 255.0f);
    const int below = static_cast<int>(clamped);
    const std::uint8_t a = nearest[below], b = nearest[std::min(below + 1, 255)];
    const float off_a = std::fabs(static_cast<float>(code[a]) - clamped);
    return off_a <= std::fabs(static_cast<float>(code[b]) - clamped) ? a : b;
}

const UastcColorRange& uastc_color_range(int number) {
    static const ColorRanges ranges;
    return ranges.of[number];
}

void settle_uastc_colors(const UastcColorPart& part, UastcColorFit& fit) {
    constexpr int kFewLevels = 4;
    if (part.is_exact || part.levels <= kFewLevels || part.active == 1) return settle_uastc_colors_exactly(part, fit);
    settle_on_line(part, fit);
}

void settle_uastc_colors_exactly(const UastcColorPart& part, UastcColorFit& fit) {
    alignas(64) float least[kUastcTexels], best[kUastcTexels];
    std::fill_n(least, kUastcTexels, 1e9f);
    std::fill_n(best, kUastcTexels, 0.0f);
    const ColorEnds ends(part, fit);
    for (int i = 0; i < part.levels; ++i) {
        alignas(64) float sum[kUastcTexels] = {};
        for (int n = 0; n < part.active; ++n) {
            const float code = ends.code(n, static_cast<float>(part.meaning[i]));
            const float* const from = part.colors.code[part.channel[n]];
            for (int k = 0; k < kUastcTexels; ++k) sum[k] += (from[k] - code) * (from[k] - code);
        }
        const auto index = static_cast<float>(i);
        for (int k = 0; k < kUastcTexels; ++k) {
            best[k] = sum[k] < least[k] ? index : best[k];
            least[k] = sum[k] < least[k] ? sum[k] : least[k];
        }
    }
    finish(part, least, best, fit);
}

}  // namespace tex::inline v1
