// SPDX-License-Identifier: Apache-2.0
// sheet.h: combines pictures into contact sheets, split views and animations.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tex/image.h>
#include <tex/result.h>
#include <tex/texture.h>

#pragma GCC visibility push(default)
namespace tex {

// Here, a picture is a texture as preview() makes it: rgb8, one level, sRGB.

// The planes R, G and B of an image (for example a heat_map()), which are sRGB values from 0 to 1, as a picture:
// floor(255 c + 0.5), clamped. Errors: bad_option (a plane is missing), out_of_memory.
[[nodiscard]] Result<Texture> picture_of(const Image& image);

// The bytes of a PNG of the picture, with the fewest channels that hold its colours: grey if R, G and B are equal
// everywhere, a palette if there are at most 256 colours (preview()'s false colours), else R, G, B. Errors:
// out_of_memory.
[[nodiscard]] Result<std::vector<std::byte>> encode_picture(const Texture& picture);

// A picture with a caption: a part of a sheet.
struct Panel {
    Texture picture;        // without a level: an empty cell
    std::string caption;    // printable ASCII; other bytes show as a box; if it is too long, its middle is left out
    std::string note = {};  // written into an empty cell: why it is empty
};

// Panels in rows of `columns` (0: about as many rows as columns) on a dark background, each with its caption below.
// Cells are as large as the largest panel of their column and row; empty ones are as large as the largest picture of
// the sheet, or 320x320. Errors: bad_option (the list is empty), out_of_memory.
[[nodiscard]] Result<Texture> contact_sheet(const std::vector<Panel>& panels, int columns = 0);

// The left half of `left` and the right half of `right`, with a line between them and both captions. Errors: bad_option
// (the extents differ), out_of_memory.
[[nodiscard]] Result<Texture> split_view(const Panel& left, const Panel& right);

// The bytes of an animated PNG that repeats the pictures forever, at `frames_per_second` (1 to 1000). Programs without
// support for animation show the first picture. Errors: bad_option (no picture, or pictures that differ in size),
// out_of_memory.
[[nodiscard]] Result<std::vector<std::byte>> encode_animation(const std::vector<Texture>& pictures,
                                                              int frames_per_second = 20);

}  // namespace tex
#pragma GCC visibility pop
