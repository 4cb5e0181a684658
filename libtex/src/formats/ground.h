// SPDX-License-Identifier: Apache-2.0
// ground.h: the size of a texel on the ground, as a picture's file and the files beside it state it. Every type of
// elevation model comes here.

#pragma once

#include <optional>
#include <string>

#include <tex/types.h>

#include "files/input_file.h"
#include "formats/row_source.h"

namespace tex::inline v1 {

struct GroundFound {
    std::optional<Ground> ground;
    std::string remark;  // as Image::ground_remark
};

// What the picture in `file` states. The unit of a grid that does not name its own is that of a .prj file beside it; or
// else degrees or metres, where its coordinates can be nothing else. A TIFF or PNG of numbers without a grid has that
// of a world file beside it, and a tile of a web map lies where its path says (map_tile.h). Nothing is beside a stream
// or bytes in memory. May throw std::bad_alloc.
[[nodiscard]] GroundFound ground_of(const RowSource& rows, const InputFile& file);

// The ground of a grid, and of what a .prj file says of it (or nothing).
[[nodiscard]] GroundFound ground_of(const GridPlace& place, Extent extent, const std::string& projection);

// The grid of a world file: six numbers, of which the first four are the steps of a column and a row, and the last two
// the middle of the first texel. Nothing if the text is not one.
[[nodiscard]] std::optional<GridPlace> world_file_place(const std::string& text);

}  // namespace tex::inline v1
