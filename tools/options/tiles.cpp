// SPDX-License-Identifier: Apache-2.0

#include "options/tiles.h"

#include "cli/usage_error.h"
#include "tasks/grid.h"

namespace tex::cli {

void TileOptions::add(Command& command, FileOptions& files) {
    command.group("Terrains");
    command.flag(files.tiles, "--tiles", "the inputs are tiles of terrains, named by a pattern with {x} and {y}");
    command
        .choice(border, "--tile-border", "WHAT", kTileBorderNames,
                "whether tiles share the rows and columns between them")
        .preset = "auto";
    command.choice(order, "--tile-y", "DIR", kTileOrderNames, "the direction in which y grows").preset = "down";
    command.check([&command, &files] {
        if (files.tiles) return;
        for (const char* option : {"--tile-border", "--tile-y"}) {
            if (command.given(option)) throw UsageError(std::string(option) + " has no effect without --tiles");
        }
    });
}

void TileOptions::relate(std::vector<Task>& tasks, const WrapOptions& wrap) const {
    find_tiles_around(tasks, wrap.x, wrap.y, order == TileOrder::up);
}

std::optional<TerrainTile> TileOptions::tile_of(const Task& task) const {
    if (!task.place) return std::nullopt;
    TerrainTile tile;
    tile.neighbour = [&task](int right, int down) {
        return task.around[static_cast<std::size_t>(3 * (down + 1) + right + 1)];
    };
    if (border != TileBorder::automatic) tile.shared_border = border == TileBorder::shared;
    return tile;
}

}  // namespace tex::cli
