// SPDX-License-Identifier: Apache-2.0
// font.h: the letters of legends and captions, drawn for this library.

#pragma once

#include <cstdint>

namespace tex::inline v1::render {

inline constexpr int kGlyphWidth = 5;
inline constexpr int kGlyphHeight = 9;   // 7 above the baseline, 2 below
inline constexpr int kGlyphAdvance = 6;  // from one letter to the next

// kGlyphHeight rows from the top, with the leftmost of kGlyphWidth pixels in bit 4. Printable ASCII; any other
// character is a box.
[[nodiscard]] const std::uint8_t* glyph(char c);

}  // namespace tex::inline v1::render
