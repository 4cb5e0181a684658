// SPDX-License-Identifier: Apache-2.0
// grid.h: the tiles of a terrain: "tile_{x}_{y}.png" stands for all files that have whole numbers in the place of {x}
// and {y}.

#pragma once

#include <compare>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tex/height.h>
#include <tex/types.h>

namespace tex::cli {

struct Task;

// The place of a tile, and its numbers as the file's name has them.
struct TilePosition {
    int x = 0, y = 0;
    std::string x_text = {}, y_text = {};
};

struct GridFile {
    std::string name;
    TilePosition place;
};

// Whether a name has both marks.
[[nodiscard]] bool has_grid(std::string_view name);

// The place of the tile that a path with numbers in the place of the marks names; none if it does not match.
[[nodiscard]] std::optional<TilePosition> place_in_grid(const std::string& pattern, const std::string& path);

// The pattern with * in the place of the marks. Throws UsageError if it has other wildcards, or if no other characters
// stand between the marks.
[[nodiscard]] std::string grid_glob(const std::string& pattern);

// The name with the tile's numbers in the place of the marks.
[[nodiscard]] std::string with_grid(std::string name, const TilePosition& place);

// The files whose names and folders a pattern stands for, row by row. Errors: io (there is none; a folder cannot be
// read). Throws UsageError if no other characters stand between the marks, or if two files have one place.
[[nodiscard]] Result<std::vector<GridFile>> grid_files(const std::string& pattern);

// Finds the tiles around each task's tile, for Task::around and Task::own. Where the heights repeat, the tile at the
// other end of a row or column stands for one that does not exist. `upwards`: y grows from the bottom to the top.
void find_tiles_around(std::vector<Task>& tasks, Wrap wrap_x, Wrap wrap_y, bool upwards);

}  // namespace tex::cli
