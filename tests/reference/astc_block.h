// SPDX-License-Identifier: Apache-2.0
// astc_block.h: blocks of ASTC that need no encoder.

#pragma once

#include <array>
#include <cstddef>

namespace tex::reference {

using AstcBlock = std::array<std::byte, 16>;

// A block of one colour ("void extent", without coordinates; Khronos Data Format Specification, ASTC): 9 bits 0x1fc,
// bit 9 for high dynamic range, then R, G, B and A with 16 bits each.
inline AstcBlock one_color(bool is_hdr, const std::array<unsigned, 4>& rgba) {
    AstcBlock block;
    block.fill(std::byte{0xff});
    block[0] = std::byte{0xfc};
    block[1] = is_hdr ? std::byte{0xff} : std::byte{0xfd};
    for (std::size_t c = 0; c < 4; ++c) {
        block[8 + 2 * c] = static_cast<std::byte>(rgba[c] & 0xff);
        block[9 + 2 * c] = static_cast<std::byte>(rgba[c] >> 8);
    }
    return block;
}

}  // namespace tex::reference
