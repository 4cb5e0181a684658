// SPDX-License-Identifier: Apache-2.0
// bc6h.h: one BC6H block: RGB of 4x4 texels as half floats in 16 bytes, in one of 14 modes (see bptc.h). Decoding is
// exact: every decoder gives the same halves.

#pragma once

#include <cstddef>
#include <cstdint>

namespace tex::inline v1 {

// Decodes a block into the bits of half floats, of texels in row-major order: 0 to 65504, or -infinity to 65504 if
// `is_signed`. Any 16 bytes are a block; the four modes that are reserved give 0.
void decode_bc6h(const std::byte* block, bool is_signed, std::uint16_t rgb[16][3]);

}  // namespace tex::inline v1
