// SPDX-License-Identifier: Apache-2.0
// canvas.h: 8-bit pictures to draw on.

#pragma once

#include <string>
#include <string_view>

#include <tex/format.h>

#include "preview/colormap.h"
#include "preview/font.h"

namespace tex::inline v1::render {

inline constexpr Code kGround{38, 40, 44};
inline constexpr Code kInk{226, 228, 232};

// Positions are in pixels from the top left corner. Anything outside the picture is clipped.
class Canvas {
public:
    explicit Canvas(Extent extent, Code ground = kGround);
    explicit Canvas(Texture picture);  // rgb8, one level

    [[nodiscard]] Extent extent() const { return level_.extent; }
    void set(int x, int y, Code color);
    void fill(int x, int y, Extent size, Code color);
    void draw(int x, int y, const Level& picture);
    // Draws only the columns [from, to) of the picture.
    void draw_columns(int x, int y, const Level& picture, int from, int to);
    // Letters are kGlyphHeight times `scale` pixels high.
    void text(int x, int y, int scale, std::string_view words, Code color = kInk);

    [[nodiscard]] Texture take() &&;

private:
    Level level_;
};

// Whether this byte of UTF-8 belongs to the letter before it.
[[nodiscard]] constexpr bool continues_letter(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

// The width of a line of text (UTF-8) in pixels.
[[nodiscard]] constexpr int text_width(std::string_view words, int scale) {
    int letters = 0;
    for (const char c : words) letters += continues_letter(c) ? 0 : 1;
    return words.empty() ? 0 : (letters * kGlyphAdvance - 1) * scale;
}

// Returns the words, shortened to fit into `width` pixels if necessary. The letters that are cut out are replaced by
// ".." in the middle, because files that belong together often have names that differ at their ends.
[[nodiscard]] std::string fitted(std::string_view words, int scale, int width);

// The size of letters for a picture: 1, or 2 if it is 1024 pixels wide or wider.
[[nodiscard]] constexpr int text_scale(int picture_width) { return picture_width >= 1024 ? 2 : 1; }

}  // namespace tex::inline v1::render
