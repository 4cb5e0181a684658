// SPDX-License-Identifier: Apache-2.0

#include "blocks/bc4.h"

#include <algorithm>
#include <cstdint>

namespace tex::inline v1 {
namespace {

// The palette of endpoints e0 and e1; `scale` is the code of 1. Numerators and denominators are whole numbers that
// float holds exactly, so each value is rounded once, by its division.
void make_palette(int e0, int e1, bool eight_values, int lowest, int scale, float palette[8]) {
    const int steps = eight_values ? 7 : 5;
    palette[0] = static_cast<float>(e0) / static_cast<float>(scale);
    palette[1] = static_cast<float>(e1) / static_cast<float>(scale);
    for (int k = 1; k < steps; ++k) {
        palette[k + 1] = static_cast<float>((steps - k) * e0 + k * e1) / static_cast<float>(steps * scale);
    }
    if (!eight_values) {
        palette[6] = static_cast<float>(lowest);
        palette[7] = 1.0f;
    }
}

void look_up(const std::byte* block, const float palette[8], float values[16]) {
    std::uint64_t indices = 0;
    for (int k = 0; k < 6; ++k) indices |= std::to_integer<std::uint64_t>(block[2 + k]) << (8 * k);
    for (int texel = 0; texel < 16; ++texel) values[texel] = palette[(indices >> (3 * texel)) & 7];
}

}  // namespace

void decode_bc4_unorm(const std::byte* block, float values[16]) {
    const int e0 = std::to_integer<int>(block[0]);
    const int e1 = std::to_integer<int>(block[1]);
    float palette[8];
    make_palette(e0, e1, e0 > e1, 0, 255, palette);
    look_up(block, palette, values);
}

void decode_bc4_snorm(const std::byte* block, float values[16]) {
    const int e0 = static_cast<std::int8_t>(block[0]);
    const int e1 = static_cast<std::int8_t>(block[1]);
    float palette[8];
    make_palette(std::max(e0, -127), std::max(e1, -127), e0 > e1, -1, 127, palette);
    look_up(block, palette, values);
}

namespace {

// The palette in units of 1/kBc4ErrorUnit of a code, all whole numbers.
void make_palette(Bc4Codes codes, Bc4Endpoints e, std::int64_t palette[8]) {
    const bool eight_values = e.e0 > e.e1;
    const int steps = eight_values ? 7 : 5;
    const std::int64_t unit = kBc4ErrorUnit / steps;
    palette[0] = e.e0 * kBc4ErrorUnit;
    palette[1] = e.e1 * kBc4ErrorUnit;
    for (int k = 1; k < steps; ++k) palette[k + 1] = ((steps - k) * e.e0 + k * e.e1) * unit;
    if (!eight_values) {
        palette[6] = 0;
        palette[7] = codes.top * kBc4ErrorUnit;
    }
}

}  // namespace

std::int64_t bc4_error(const BlockTexels& texels, Bc4Codes codes, Bc4Endpoints endpoints) {
    std::int64_t palette[8];
    make_palette(codes, endpoints, palette);
    std::int64_t sum = 0;
    for (int k = 0; k < 16; ++k) {
        if (texels.mask >> k & 1) sum += nearest(palette, texels.values[k] * (kBc4ErrorUnit / kCodeUnit)).squared;
    }
    return sum;
}

void write_bc4(const BlockTexels& texels, Bc4Codes codes, Bc4Endpoints endpoints, std::byte* block) {
    std::int64_t palette[8];
    make_palette(codes, endpoints, palette);
    block[0] = static_cast<std::byte>(endpoints.e0 - codes.bias);
    block[1] = static_cast<std::byte>(endpoints.e1 - codes.bias);
    std::uint64_t indices = 0;
    for (int k = 0; k < 16; ++k) {
        indices |= static_cast<std::uint64_t>(nearest(palette, texels.values[k] * (kBc4ErrorUnit / kCodeUnit)).index)
                   << (3 * k);
    }
    for (int k = 0; k < 6; ++k) block[2 + k] = static_cast<std::byte>(indices >> (8 * k));
}

}  // namespace tex::inline v1
