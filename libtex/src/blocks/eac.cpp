// SPDX-License-Identifier: Apache-2.0

#include "blocks/eac.h"

#include <algorithm>
#include <cstdint>

namespace tex::inline v1 {
namespace {

// The eight codes of a palette, counted from the lowest one, clamped.
struct Codes {
    std::int32_t code[8];
};

Codes codes_of(EacCodes codes, EacPalette palette) {
    const int scale = palette.multiplier == 0 ? 1 : 8 * palette.multiplier;
    Codes result;
    for (int k = 0; k < 8; ++k) {
        const int code = 8 * palette.base + codes.middle + scale * kEacModifiers[palette.table][k];
        result.code[k] = std::clamp(code, 0, codes.top);
    }
    return result;
}

// The lowest bit of the selector of a texel (row-major) among the 48 bits.
constexpr int selector_bit(int texel) { return 45 - 3 * (4 * (texel % 4) + texel / 4); }

// Values are (code - zero) / one.
void decode(const std::byte* block, EacCodes codes, int base, int zero, int one, float values[16]) {
    const int second = std::to_integer<int>(block[1]);
    const Codes palette = codes_of(codes, {base, second >> 4, second & 15});
    std::uint64_t selectors = 0;
    for (int k = 2; k < 8; ++k) selectors = selectors << 8 | std::to_integer<std::uint64_t>(block[k]);
    for (int texel = 0; texel < 16; ++texel) {
        const int code = palette.code[selectors >> selector_bit(texel) & 7] - zero;
        values[texel] = static_cast<float>(code) / static_cast<float>(one);
    }
}

}  // namespace

void decode_eac_unorm(const std::byte* block, float values[16]) {
    decode(block, kEacUnorm, std::to_integer<int>(block[0]), 0, 2047, values);
}

void decode_eac_snorm(const std::byte* block, float values[16]) {
    const int base = std::max<int>(static_cast<std::int8_t>(block[0]), -127);
    decode(block, kEacSnorm, base + kEacSnorm.bias, 1023, 1023, values);
}

void write_eac(EacCodes codes, EacPalette palette, const std::int32_t nearest[16], std::byte* block) {
    block[0] = static_cast<std::byte>(palette.base - codes.bias);
    block[1] = static_cast<std::byte>(palette.multiplier << 4 | palette.table);
    std::uint64_t selectors = 0;
    for (int k = 0; k < 16; ++k) selectors |= static_cast<std::uint64_t>(nearest[k] & 7) << selector_bit(k);
    for (int k = 0; k < 6; ++k) block[2 + k] = static_cast<std::byte>(selectors >> (40 - 8 * k));
}

}  // namespace tex::inline v1
