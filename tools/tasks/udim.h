// SPDX-License-Identifier: Apache-2.0
// udim.h: UDIM tiles: "rock_n.<UDIM>.png" stands for rock_n.1001.png, rock_n.1002.png and so on.
//
// Tile 1001 + u + 10 v holds the UVs from (u, v) to (u + 1, v + 1), with u from 0 to 9 and v pointing up (Foundry,
// Mari).

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tex/types.h>

#include "tasks/grid.h"

namespace tex::cli {

struct ModelInput;

inline constexpr std::string_view kTileMark = "<UDIM>";

// A file of the command line or of a list.
struct Input {
    std::string name;
    int tile = 0;                                  // 0: none
    std::string pattern = {};                      // the name with the mark, if there is a tile
    std::optional<TilePosition> place = {};        // of a tile of a terrain; `pattern` is then the name with its marks
    std::shared_ptr<const ModelInput> model = {};  // the input is this map of a model (model_input.h)
    std::string folder = {};                       // of the command line, in which the file was found
};

[[nodiscard]] bool has_tile(std::string_view name);

// The name with the tile's number in the place of every mark; the name itself if there is no tile.
[[nodiscard]] std::string with_tile(const std::string& name, int tile);

// The files that a name stands for: itself, or those that exist, in the order of their tiles. Errors: io (there is
// none, or the folder cannot be read). Throws UsageError if the mark is in the name of a folder.
[[nodiscard]] Result<std::vector<Input>> inputs_of(const std::string& name);

}  // namespace tex::cli
