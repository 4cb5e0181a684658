// SPDX-License-Identifier: Apache-2.0
// uastc_to.h: what Basis Universal's transcoder makes of blocks of UASTC (basisu_transcoder.cpp, Apache-2.0,
// whose rules, tables and roundings these are), without its options for higher quality. Blocks that are not valid
// become what it leaves: zeros.

#pragma once

#include <cstddef>
#include <cstdint>

#include "blocks/uastc_write.h"

namespace tex::inline v1 {

// A block of BC7, of 16 bytes: the mode that has as many subsets and planes.
void uastc_to_bc7(const std::byte* block, std::byte* out);

// A block of BC1, of 8 bytes, always of four colours: as the hints say, the endpoints and weights of the first plane as
// they are, or endpoints that fit these weights, or both fitted to the texels.
void uastc_to_bc1(const std::byte* block, std::byte* out);

// The texels of a block of ETC1: base colours from the means of halves and a bias, and the tables that the hints name.
void uastc_to_etc1(const std::byte* block, std::uint8_t rgb[16][3]);

// The base colours of both halves in 8 bits, for the codes of R, G and B of a block that is not of one colour. Modes 10
// to 12 have no bias.
void uastc_etc1_bases(const std::uint8_t codes[][16], const UastcHints& hints, bool has_bias, int bases[2][3]);

// What the block of ASTC with the same numbers decodes to, in 16 bits.
void uastc_to_astc(const std::byte* block, std::uint16_t rgba[16][4]);

}  // namespace tex::inline v1
