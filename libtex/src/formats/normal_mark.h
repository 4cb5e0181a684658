// SPDX-License-Identifier: Apache-2.0
// normal_mark.h: the text with which libtex states in a file what the channels hold and where y points: "dxt5nm +y".
//
// The first word is a layout: a name of kSwizzleNames, or the four letters of a swizzle. If y is known, "+y" or "-y"
// follows. A file of heights has "heights 3.25" instead, the strength with which they give the normals again from which
// they were integrated, or "heights 3.25 2.5" if that of y differs. Every type of file keeps the text in its own place:
//
//   DDS              the reserved words 3 to 6 of the header: 'LTEX', then the text, unless it is longer
//   KTX2             the key "libtex.normal"
//   PNG              a tEXt chunk with the keyword "libtex.normal", before the texels
//   TIFF, TGA, JPEG  a line of the description: "libtex.normal rgb +y"
//
// EXR has its own attributes (exr.h). BMP holds no text.

#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <tex/format.h>
#include <tex/height.h>

#include "formats/file_layout.h"

namespace tex::inline v1 {

inline constexpr std::string_view kNormalKey = "libtex.normal";
inline constexpr std::size_t kLongestNormalMark = 9;  // "dxt5nm +y"

// The mark of a texture; empty if it is not known what the channels hold.
[[nodiscard]] std::string normal_mark(const TextureHead& head);

// Sets what the mark states: the swizzle, y, and that floats are the components of normals. Returns false, and changes
// nothing, if this is not a mark or if it does not fit the format, which must be set.
bool apply_normal_mark(std::string_view mark, Texture& texture);

// Calls apply_normal_mark(), but an empty mark is none at all, and a mark that is not applied becomes a remark.
bool apply_found_mark(std::string_view mark, Texture& texture);

// The strength that a mark of heights states.
[[nodiscard]] std::optional<Strength> strength_in_mark(std::string_view mark);

// The line of a description that holds a mark, and the mark in a description; empty if there is none.
[[nodiscard]] std::string description_of(std::string_view mark);
[[nodiscard]] std::string_view mark_in_description(std::string_view description);

}  // namespace tex::inline v1
