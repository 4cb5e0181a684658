// SPDX-License-Identifier: Apache-2.0
// eac.h: one EAC block (R11): one channel of 4x4 texels in 8 bytes. RG11 stores two such blocks.
//
//     byte 0      base: 8 bits, unsigned (unorm) or two's complement (snorm)
//     byte 1      multiplier in the upper 4 bits, number of the table of modifiers in the lower 4
//     byte 2-7    48 bits, big-endian: a 3-bit selector for each texel, column-major, texel 0 in the highest bits
//
//     unorm    code = clamp(8 base + 4 + 8 multiplier modifier, 0, 2047)          value = code / 2047
//     snorm    code = clamp(8 base + 8 multiplier modifier, -1023, 1023)          value = code / 1023
//
// A multiplier of 0 stands for 1/8: the modifier itself is added. A signed base of -128 counts as -127. Each value is
// one rational number, rounded once to float. (Khronos Data Format Specification 1.3, chapter 21; OpenGL ES 3.0,
// C.1.5 to C.1.8.)

#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "blocks/texels.h"

namespace tex::inline v1 {

// Modifiers by table and selector. In each table, selector k has the modifier -1 - m if selector k + 4 has m: the
// palette is symmetrical about -1/2.
inline constexpr int kEacTables = 16;
inline constexpr int kEacMultipliers = 16;
inline constexpr int kEacModifiers[kEacTables][8] = {
    {-3, -6, -9, -15, 2, 5, 8, 14}, {-3, -7, -10, -13, 2, 6, 9, 12}, {-2, -5, -8, -13, 1, 4, 7, 12},
    {-2, -4, -6, -13, 1, 3, 5, 12}, {-3, -6, -8, -12, 2, 5, 7, 11},  {-3, -7, -9, -11, 2, 6, 8, 10},
    {-4, -7, -8, -11, 3, 6, 7, 10}, {-3, -5, -8, -11, 2, 4, 7, 10},  {-2, -6, -8, -10, 1, 5, 7, 9},
    {-2, -5, -8, -10, 1, 4, 7, 9},  {-2, -4, -8, -10, 1, 3, 7, 9},   {-2, -5, -7, -10, 1, 4, 6, 9},
    {-3, -4, -7, -10, 2, 3, 6, 9},  {-1, -2, -3, -10, 0, 1, 2, 9},   {-4, -6, -8, -9, 3, 5, 7, 8},
    {-3, -5, -7, -9, 2, 4, 6, 8},
};

// Decodes a block into texels in row-major order: [0, 1], or [-1, 1] for snorm. Any 8 bytes are a valid block.
void decode_eac_unorm(const std::byte* block, float values[16]);
void decode_eac_snorm(const std::byte* block, float values[16]);

// Encoding. Codes are counted from the lowest one: 0 to `top`. Code 8 b + `middle` is that of base b with a modifier of
// 0; the base is stored with `bias` subtracted. Signed blocks use the bases -127 to 127 only.
struct EacCodes {
    int top;
    int middle;
    int bases;
    int bias;
};
inline constexpr EacCodes kEacUnorm{2047, 4, 256, 0};
inline constexpr EacCodes kEacSnorm{2046, 7, 255, 127};

// What a block holds beside its selectors. Bases are counted from 0.
struct EacPalette {
    int base = 0;
    int multiplier = 0;
    int table = 0;
};

// Encoders fit to multiples of 1/128 of a code. A base is 8 codes, so that is 1/kCodeUnit of a base.
inline constexpr int kEacUnit = kCodeUnit / 8;

// A component in [-1, 1] (clamped), mapped to the codes 0 to `top`, in units of 1/kEacUnit. Computed in float, from
// left to right; halves are rounded up.
inline std::int32_t to_eac_units(float n, int top) {
    const float half_range = 0.5f * static_cast<float>(top) * static_cast<float>(kEacUnit);
    const float clamped = std::fmin(std::fmax(n, -1.0f), 1.0f);
    return static_cast<std::int32_t>(std::floor(clamped * half_range + half_range + 0.5f));
}

// Writes a block. The lowest three bits of nearest[k] are the selector of texel k (row-major).
void write_eac(EacCodes codes, EacPalette palette, const std::int32_t nearest[16], std::byte* block);

}  // namespace tex::inline v1
