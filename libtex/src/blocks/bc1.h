// SPDX-License-Identifier: Apache-2.0
// bc1.h: one BC1 block (DXT1): the colours of 4x4 texels in 8 bytes; and the explicit alpha of BC2. BC2 and BC3 store
// their colours as a BC1 block that always has four of them.
//
//     byte 0-1, 2-3   colours c0 and c1: 16 bits little-endian, red in the highest 5, green 6, blue 5
//     byte 4-7        32 bits, little-endian: a 2-bit index for each texel, row-major, texel 0 in the lowest bits
//
//     c0 > c1, or four_colors     c0, c1, (2 c0 + c1)/3, (c0 + 2 c1)/3
//     else                        c0, c1, (c0 + c1)/2, transparent black
//
// The colours are compared as 16-bit numbers. Channels are widened to 8 bits by replication of their high bits and
// divided by 255; thirds are exact: each value is one rational number, rounded once to float. (Direct3D 11.3 Functional
// Specification, 19.5.6 to 19.5.8, whose interpolants GPUs approximate.)

#pragma once

#include <cstddef>
#include <cstdint>

#include "blocks/texels.h"

namespace tex::inline v1 {

enum class Bc1Mode {
    standard,     // c0 <= c1 means three colours and transparent black: BC1
    four_colors,  // always four: BC2 and BC3
};

// Decodes a block into texels in row-major order, each channel in [0, 1]. In four_colors mode a is 1. Any 8 bytes are a
// valid block.
void decode_bc1(const std::byte* block, Bc1Mode mode, float r[16], float g[16], float b[16], float a[16]);

// Decodes the first 8 bytes of a BC2 block: 4 bits of alpha for each texel, row-major, texel 0 in the lowest bits.
void decode_bc2_alpha(const std::byte* block, float a[16]);

// Encoding: the green of a DXT5nm colour block. R and B are 31 in both colours, so that they decode to exactly 255 for
// every index and decoder. Only green is fitted, to codes 0 to 255.

// Two 6-bit greens, e0 <= e1. The block holds the greater one first, so c0 > c1 if they differ.
struct GreenEndpoints {
    int e0 = 0;
    int e1 = 0;
};

// The 8-bit code to which decoders widen a 6-bit green.
constexpr int widen_green(int code) { return code << 2 | code >> 4; }

// The squared error of a block if each texel takes the nearest value of the palette, in units of (code /
// kGreenErrorUnit)^2. Exact.
inline constexpr std::int64_t kGreenErrorUnit = std::int64_t{3} * kCodeUnit;
[[nodiscard]] std::int64_t green_error(const BlockTexels& texels, GreenEndpoints endpoints);

// Writes the colour block. Each texel takes the nearest value, or the first of equally near ones. Equal endpoints use
// index 0 only.
void write_green(const BlockTexels& texels, GreenEndpoints endpoints, std::byte* block);

}  // namespace tex::inline v1
