// SPDX-License-Identifier: Apache-2.0
// sheet.h: pictures put together: contact sheets, split views and animations.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tex/image.h>
#include <tex/result.h>
#include <tex/texture.h>

#pragma GCC visibility push(default)
namespace tex {

// A picture here is a texture as preview() makes it: rgb8, one level, sRGB.

// The planes R, G and B of an image, sRGB values from 0 to 1 (a heat_map(), say), as a picture: floor(255 c + 0.5),
// clamped. Errors: bad_option (one of the planes is missing), out_of_memory.
[[nodiscard]] Result<Texture> picture_of(const Image& image);

// The bytes of a PNG of the picture with the fewest channels that hold its colours: grey where R, G and B are equal
// everywhere, a palette where there are at most 256 colours (preview()'s false colours), else R, G, B. Errors:
// out_of_memory.
[[nodiscard]] Result<std::vector<std::byte>> encode_picture(const Texture& picture);

// A picture with a caption, a part of a sheet.
struct Panel {
    Texture picture;
    std::string caption;  // printable ASCII; other bytes show as a box; where it is too long, its middle is left out
};

// Panels in rows of `columns` (0: about as many rows as columns), on a dark ground, each with its caption below. Cells
// are as large as the largest panel of their column and row. An empty list gives bad_option. Errors: bad_option,
// out_of_memory.
[[nodiscard]] Result<Texture> contact_sheet(const std::vector<Panel>& panels, int columns = 0);

// The left half of `left` and the right half of `right`, with a line between them and both captions. Errors: bad_option
// (the extents differ), out_of_memory.
[[nodiscard]] Result<Texture> split_view(const Panel& left, const Panel& right);

// The bytes of an animated PNG that plays the pictures for ever, `frames_per_second` of them in a second (1 to 1000).
// Programs that know no animation show the first. Errors: bad_option (no picture, or pictures that differ in size),
// out_of_memory.
[[nodiscard]] Result<std::vector<std::byte>> encode_animation(const std::vector<Texture>& pictures,
                                                              int frames_per_second = 20);

}  // namespace tex
#pragma GCC visibility pop
