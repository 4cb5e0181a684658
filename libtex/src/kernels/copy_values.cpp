// SPDX-License-Identifier: Apache-2.0

#include "kernels/copy_values.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tex::inline v1 {

CopyHalf copy_half(const HalfShape& shape) {
    CopyHalf half{shape, 0.0f, 0.0f, 0.0f};
    for (const float weight : shape.weights) {
        half.sum += weight;
        half.squares += weight * weight;
    }
    const float variance = 16.0f * half.squares - half.sum * half.sum;
    half.inverse = variance > 1e-3f ? 1.0f / variance : 0.0f;
    return half;
}

CopyDirection copy_direction(const float values[16]) {
    // cos(pi/8) / sqrt(2), sin(pi/8) / sqrt(2)
    constexpr float kC = 0.6532814824381883f, kS = 0.2705980500730985f;
    constexpr float kBasis[4][4] = {
        {0.5f, 0.5f, 0.5f, 0.5f}, {kC, kS, -kS, -kC}, {0.5f, -0.5f, -0.5f, 0.5f}, {kS, -kC, kC, -kS}};
    // Each part's row and column of frequencies.
    constexpr int kOrder[16] = {1, 4, 5, 0, 2, 8, 6, 9, 3, 12, 7, 13, 10, 11, 14, 15};
    float rows[16], cosines[16];
    for (int j = 0; j < 4; ++j) {
        for (int f = 0; f < 4; ++f) {
            const float* const v = values + std::ptrdiff_t{4} * j;
            rows[4 * j + f] = v[0] * kBasis[f][0] + v[1] * kBasis[f][1] + v[2] * kBasis[f][2] + v[3] * kBasis[f][3];
        }
    }
    for (int g = 0; g < 4; ++g) {
        for (int f = 0; f < 4; ++f)
            cosines[4 * g + f] = rows[f] * kBasis[g][0] + rows[4 + f] * kBasis[g][1] + rows[8 + f] * kBasis[g][2] +
                                 rows[12 + f] * kBasis[g][3];
    }
    float low = 0.0f, high = 0.0f;  // squares
    for (int k = 0; k < 16; ++k) {
        if (k != 3) (k < 3 ? low : high) += cosines[kOrder[k]] * cosines[kOrder[k]];
    }
    CopyDirection direction{};
    if (low + high < 1e-9f) return direction;
    const float scale = static_cast<float>(kDirectionUnit) / std::sqrt(low + high);
    for (int k = 0; k < 16; ++k)
        direction.parts[k] = static_cast<std::int16_t>(std::floor(scale * cosines[kOrder[k]] + 0.5f));
    direction.parts[3] = static_cast<std::int16_t>(std::floor(scale * std::sqrt(high)) + 2.0f);
    return direction;
}

CopySize copy_size(float mean, float length) {
    const auto word = [](float value) {
        return static_cast<std::int16_t>(std::floor(std::min(std::max(value, -32767.0f), 32767.0f) + 0.5f));
    };
    return {word(kMeanUnit * mean), word(kLengthUnit * length)};
}

CopyValues copy_values(const float values[16]) {
    CopyValues found{{}, 0.0f, 0.0f, copy_direction(values), {}};
    for (int k = 0; k < 16; ++k) {
        found.values[k] = values[k];
        found.sum += values[k];
        found.squares += values[k] * values[k];
    }
    found.size = copy_size(found.sum * (1.0f / 16.0f), std::sqrt(spread_of(found)));
    return found;
}

std::array<float, 3> copy_errors(const CopyHalf& half, const CopyValues& values, bool keeps_slope) {
    // The errors of what is not a line must not look small.
    if (!half.shape.is_line) return {1e12f, 1e12f, 1e12f};
    float sums[4] = {};
    for (int k = 0; k < 16; k += 4) {
        for (int c = 0; c < 4; ++c) sums[c] += half.shape.weights[k + c] * values.values[k + c];
    }
    const float wv = (sums[0] + sums[2]) + (sums[1] + sums[3]);
    const float v = values.sum;
    const float vv = values.squares;
    const float w = half.sum;
    const float ww = half.squares;
    const float offset = half.shape.line.offset;
    const float slope = half.shape.line.slope;
    const float spread = vv - v * v * (1.0f / 16.0f);
    const float covariance = std::max(0.0f, 16.0f * wv - w * v);
    const float least = std::max(0.0f, spread - covariance * covariance * half.inverse * (1.0f / 16.0f));
    // Relative to the offset of the half.
    const float moved = wv - offset * w;
    const float flat = vv - offset * (2.0f * v - 16.0f * offset);
    float one = 0.0f;
    if (keeps_slope) {
        const float both = wv - w * v * (1.0f / 16.0f);
        const float own = ww - w * w * (1.0f / 16.0f);
        one = spread - slope * (2.0f * both - slope * own);
    } else {
        const float part = std::max(0.0f, moved);
        one = flat - part * part / std::max(ww, 1e-6f);
    }
    const float none = flat - slope * (2.0f * moved - slope * ww);
    return {least, std::max(least, one), std::max(least, none)};
}

float spread_of(const CopyValues& values) {
    return std::max(0.0f, values.squares - values.sum * values.sum * (1.0f / 16.0f));
}

}  // namespace tex::inline v1
