// SPDX-License-Identifier: Apache-2.0

#include "kernels/uastc_solid.h"

#include <algorithm>
#include <cmath>

#include "blocks/uastc_modes.h"

namespace tex::inline v1 {
namespace {

constexpr float kMiddle = 127.5f;

float cosine_of(const float code[3], const float unit[3]) {
    float along = 0, squared = 0;
    for (int c = 0; c < 3; ++c) {
        const float v = code[c] - kMiddle;
        along += v * unit[c];
        squared += v * v;
    }
    return along / std::sqrt(squared);
}

float rounded(float value, float top) { return std::min(std::max(0.0f, std::floor(value + 0.5f)), top); }

// All lengths, from the greatest on: the greatest component has each code, and the others those beside the ray.
void find_color(const float unit[3], std::uint8_t color[3]) {
    const float greatest = std::max({std::fabs(unit[0]), std::fabs(unit[1]), std::fabs(unit[2])});
    float best = -2.0f;
    for (float size = kMiddle; size > 48.0f; size -= 1.0f) {
        float code[3];
        for (int c = 0; c < 3; ++c) code[c] = rounded(kMiddle + unit[c] * (size / greatest), 255.0f);
        const float cosine = cosine_of(code, unit);
        if (cosine <= best) continue;
        best = cosine;
        for (int c = 0; c < 3; ++c) color[c] = static_cast<std::uint8_t>(code[c]);
    }
}

// The best base colour near the ray for each modifier.
void find_hints(const float unit[3], const std::uint8_t color[3], UastcHints& hints) {
    constexpr float kModifiers[8][2] = {{2, 8}, {5, 17}, {9, 29}, {13, 42}, {18, 60}, {24, 80}, {33, 106}, {47, 183}};
    float best = -2.0f;
    for (int try_ = 0; try_ < 64; ++try_) {
        const bool diff = try_ >= 32;
        const int table = try_ / 4 % 8, selector = try_ % 4;
        const float size = kModifiers[table][selector == 0 || selector == 3 ? 1 : 0];
        const float modifier = selector < 2 ? -size : size;
        float base[3], code[3];
        for (int c = 0; c < 3; ++c) {
            const float top = diff ? 31.0f : 15.0f;
            base[c] = rounded((static_cast<float>(color[c]) - modifier) * (top / 255.0f), top);
            const float wide = diff ? 8.0f * base[c] + std::floor(0.25f * base[c]) : 17.0f * base[c];
            code[c] = std::min(std::max(0.0f, wide + modifier), 255.0f);
        }
        const float cosine = cosine_of(code, unit);
        if (cosine <= best) continue;
        best = cosine;
        hints.diff = diff;
        hints.table[0] = static_cast<std::uint8_t>(table);
        hints.selector = static_cast<std::uint8_t>(selector);
        for (int c = 0; c < 3; ++c) hints.base[c] = static_cast<std::uint8_t>(base[c]);
    }
}

}  // namespace

UastcContent uastc_solid(const float unit[3]) {
    UastcContent content;
    content.mode = kUastcSolid;
    find_color(unit, content.ends[0][0]);
    find_hints(unit, content.ends[0][0], content.hints);
    return content;
}

}  // namespace tex::inline v1
