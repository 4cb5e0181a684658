// SPDX-License-Identifier: Apache-2.0
// bc4.h: one BC4 block (ATI1, RGTC1): one channel of 4x4 texels in 8 bytes. BC3 stores its alpha in this form, and BC5
// each of its channels.
//
//     byte 0, 1   endpoints e0 and e1: 8 bits each, unsigned (unorm) or two's complement (snorm)
//     byte 2-7    48 bits, little-endian: a 3-bit index for each texel, row-major, texel 0 in the lowest bits
//
//     e0 > e1     8 values:  e0, e1, (6 e0 + e1)/7, (5 e0 + 2 e1)/7, ... (e0 + 6 e1)/7
//     else        6 values:  e0, e1, (4 e0 + e1)/5, ... (e0 + 4 e1)/5, the lowest value, the greatest value
//
// The endpoints are compared as stored. Values are divided by 255 (unorm: lowest 0, greatest 1) or by 127 (snorm:
// lowest -1, greatest 1; -128 counts as -127). Sevenths and fifths are exact: each value is one rational number,
// rounded once to float. (Direct3D 11.3 Functional Specification, 19.5.11 and 19.5.12, whose interpolants GPUs
// approximate.)

#pragma once

#include <cstddef>
#include <cstdint>

#include "blocks/texels.h"

namespace tex::inline v1 {

// Decodes a block into texels in row-major order: [0, 1], or [-1, 1] for snorm. Any 8 bytes are a valid block.
void decode_bc4_unorm(const std::byte* block, float values[16]);
void decode_bc4_snorm(const std::byte* block, float values[16]);

// The codes to which an encoder fits: 0 to `top`, stored with `bias` subtracted. Signed blocks use -127 to 127 only.
struct Bc4Codes {
    int top;
    int bias;
};
inline constexpr Bc4Codes kBc4Unorm{255, 0};
inline constexpr Bc4Codes kBc4Snorm{254, 127};

// Endpoints in the order in which the block compares them, before bias is subtracted: e0 > e1 has 8 values, otherwise
// 6.
struct Bc4Endpoints {
    int e0 = 0;
    int e1 = 0;
};

// The squared error of a block if each texel takes the nearest value of the palette, in units of (code /
// kBc4ErrorUnit)^2. Exact.
inline constexpr std::int64_t kBc4ErrorUnit = std::int64_t{35} * kCodeUnit;
[[nodiscard]] std::int64_t bc4_error(const BlockTexels& texels, Bc4Codes codes, Bc4Endpoints endpoints);

// Writes the block. Each texel takes the nearest value, or the first of equally near ones.
void write_bc4(const BlockTexels& texels, Bc4Codes codes, Bc4Endpoints endpoints, std::byte* block);

}  // namespace tex::inline v1
