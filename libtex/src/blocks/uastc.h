// SPDX-License-Identifier: Apache-2.0
// uastc.h: one block of UASTC of low dynamic range: RGBA of 4x4 texels in 16 bytes, in one of 19 modes. Each is a block
// of ASTC whose endpoints and weights are stored in another order, with hints for transcoders (Basis Universal, "UASTC
// LDR 4x4 Texture Specification"; Khronos Data Format Specification 1.3, "UASTC").

#pragma once

#include <cstddef>
#include <cstdint>

namespace tex::inline v1 {

// Decodes a block into codes of R, G, B and A, texels in row-major order. Decoding is exact: every decoder gives the
// same codes. Any 16 bytes are a block; those of the mode that is reserved, and those whose pattern of subsets does not
// exist, are magenta.
void decode_uastc(const std::byte* block, std::uint8_t channels[4][16]);

}  // namespace tex::inline v1
