// SPDX-License-Identifier: Apache-2.0
// bc7.h: one BC7 block: RGBA of 4x4 texels in 16 bytes, in one of eight modes (see bptc.h). Decoding is exact: every
// decoder gives the same codes.

#pragma once

#include <cstddef>
#include <cstdint>

namespace tex::inline v1 {

// Decodes a block into codes of texels in row-major order. Any 16 bytes are a block; the one mode that is reserved (the
// first byte is 0) gives 0 for all channels.
void decode_bc7(const std::byte* block, std::uint8_t rgba[16][4]);

}  // namespace tex::inline v1
