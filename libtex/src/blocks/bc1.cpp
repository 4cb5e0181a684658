// SPDX-License-Identifier: Apache-2.0

#include "blocks/bc1.h"

#include <cstdint>

namespace tex::inline v1 {
namespace {

struct Color {
    int r, g, b;  // 0 to 255
};

constexpr int widen5(int code) { return code << 3 | code >> 2; }

Color widen(int c) { return {widen5(c >> 11 & 31), widen_green(c >> 5 & 63), widen5(c & 31)}; }

// (w0 e0 + w1 e1) / (w0 + w1), rounded once.
float mix(int w0, int e0, int w1, int e1) {
    return static_cast<float>(w0 * e0 + w1 * e1) / static_cast<float>((w0 + w1) * 255);
}

int load16(const std::byte* p) { return std::to_integer<int>(p[0]) | std::to_integer<int>(p[1]) << 8; }

}  // namespace

void decode_bc1(const std::byte* block, Bc1Mode mode, float r[16], float g[16], float b[16], float a[16]) {
    const int c0 = load16(block);
    const int c1 = load16(block + 2);
    const Color e0 = widen(c0);
    const Color e1 = widen(c1);
    const bool four = mode == Bc1Mode::four_colors || c0 > c1;
    // The weights of c0 and c1 in each entry of the palette; 0 and 0 mean transparent black.
    constexpr int kFour[4][2] = {{1, 0}, {0, 1}, {2, 1}, {1, 2}};
    constexpr int kThree[4][2] = {{1, 0}, {0, 1}, {1, 1}, {0, 0}};
    float palette[4][4];
    for (int k = 0; k < 4; ++k) {
        const auto [w0, w1] = four ? kFour[k] : kThree[k];
        const bool opaque = w0 + w1 > 0;
        palette[k][0] = opaque ? mix(w0, e0.r, w1, e1.r) : 0.0f;
        palette[k][1] = opaque ? mix(w0, e0.g, w1, e1.g) : 0.0f;
        palette[k][2] = opaque ? mix(w0, e0.b, w1, e1.b) : 0.0f;
        palette[k][3] = opaque ? 1.0f : 0.0f;
    }
    for (int texel = 0; texel < 16; ++texel) {
        const float* color = palette[std::to_integer<int>(block[4 + texel / 4]) >> (2 * (texel % 4)) & 3];
        r[texel] = color[0];
        g[texel] = color[1];
        b[texel] = color[2];
        a[texel] = color[3];
    }
}

void decode_bc2_alpha(const std::byte* block, float a[16]) {
    for (int texel = 0; texel < 16; ++texel) {
        const int code = std::to_integer<int>(block[texel / 2]) >> (4 * (texel % 2)) & 15;
        a[texel] = static_cast<float>(code) / 15.0f;
    }
}

namespace {

// The palette in the order of its indices, the greater endpoint first, in units of 1/kGreenErrorUnit of a code.
void make_palette(GreenEndpoints e, std::int64_t palette[4]) {
    const std::int64_t low = widen_green(e.e0);
    const std::int64_t high = widen_green(e.e1);
    palette[0] = 3 * high * kCodeUnit;
    palette[1] = 3 * low * kCodeUnit;
    palette[2] = (2 * high + low) * kCodeUnit;
    palette[3] = (high + 2 * low) * kCodeUnit;
}

}  // namespace

std::int64_t green_error(const BlockTexels& texels, GreenEndpoints endpoints) {
    std::int64_t palette[4];
    make_palette(endpoints, palette);
    std::int64_t sum = 0;
    for (int k = 0; k < 16; ++k) {
        if (texels.mask >> k & 1) sum += nearest(palette, std::int64_t{3} * texels.values[k]).squared;
    }
    return sum;
}

void write_green(const BlockTexels& texels, GreenEndpoints endpoints, std::byte* block) {
    std::int64_t palette[4];
    make_palette(endpoints, palette);
    const auto word = [](int green) { return 31 << 11 | green << 5 | 31; };
    const int c0 = word(endpoints.e1);
    const int c1 = word(endpoints.e0);
    std::uint32_t indices = 0;
    for (int k = 0; k < 16; ++k) {
        indices |= static_cast<std::uint32_t>(nearest(palette, std::int64_t{3} * texels.values[k]).index) << (2 * k);
    }
    block[0] = static_cast<std::byte>(c0);
    block[1] = static_cast<std::byte>(c0 >> 8);
    block[2] = static_cast<std::byte>(c1);
    block[3] = static_cast<std::byte>(c1 >> 8);
    for (int k = 0; k < 4; ++k) block[4 + k] = static_cast<std::byte>(indices >> (8 * k));
}

}  // namespace tex::inline v1
