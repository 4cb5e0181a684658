// SPDX-License-Identifier: Apache-2.0
// astc_void.h: blocks of ASTC of one colour, whose codes have 16 bits ("void extents").

#pragma once

#include <cstddef>

#include "blocks/astc_decode.h"

namespace tex::inline v1 {

// A value of 1, 65536 of a decoder's codes, in units of endpoints of 8 bits.
inline constexpr float kAstcOne = 65536.0f / 257.0f;

// What a decoder makes of a code, and the code of which it makes the value that is nearest, in those units.
[[nodiscard]] inline float astc_void_value(int code) { return astc_value(code) * kAstcOne; }
[[nodiscard]] int astc_void_code(float value);

// Writes a block of one colour: luminance x and alpha y.
void write_astc_void(int x, int y, std::byte* block);

}  // namespace tex::inline v1
