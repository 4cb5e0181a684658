// SPDX-License-Identifier: Apache-2.0
// etc1s.h: one block of ETC1S: RGB of 4x4 texels in 8 bytes. It is a block of ETC1 whose halves have one base colour of
// 5 bits a channel and one table of modifiers (Khronos Data Format Specification 1.3, "ETC1S").

#pragma once

#include <cstddef>
#include <cstdint>

namespace tex::inline v1 {

inline constexpr int kEtc1sBlockBytes = 8;

// Decodes a block into codes of R, G and B, texels in row-major order. Channels that are null are not needed. Any 8
// bytes are a block: what ETC1S does not have (an offset between two base colours, a second table) is ignored.
void decode_etc1s(const std::byte* block, std::uint8_t* const channels[3]);

// The bytes of a block: its base colour (R, G, B, 0 to 31), its table (0 to 7), and the four bytes in which it stores
// which modifier each texel has.
void write_etc1s_color(const std::uint8_t color[3], std::uint8_t table, std::byte* block);
// The modifiers of four rows: two bits for each texel, the first texel in the lowest ones; 0 is the darkest one.
void write_etc1s_modifiers(const std::uint8_t rows[4], std::byte* bytes);

}  // namespace tex::inline v1
