// SPDX-License-Identifier: Apache-2.0
// tiles.h: the options of terrains that are stored as tiles: --tiles, --tile-border, --tile-y.

#pragma once

#include <optional>
#include <vector>

#include <tex/pipeline.h>

#include "cli/command.h"
#include "options/files.h"
#include "options/mips.h"
#include "tasks/task.h"

namespace tex::cli {

enum class TileBorder { automatic, shared, apart };

inline constexpr Named<TileBorder> kTileBorderNames[] = {
    {TileBorder::automatic, "auto", "shared if the sides of a tile are 2^n + 1, or those of HGT"},
    {TileBorder::shared, "shared", "the first row and column of a tile are the last ones of the tile before it"},
    {TileBorder::apart, "apart", "each row and column is in one tile"},
};

enum class TileOrder { down, up };

inline constexpr Named<TileOrder> kTileOrderNames[] = {
    {TileOrder::down, "down", "y grows from the top to the bottom"},
    {TileOrder::up, "up", "y grows from the bottom to the top"},
};

struct TileOptions {
    TileBorder border = TileBorder::automatic;
    TileOrder order = TileOrder::down;

    // Sets FileOptions::tiles.
    void add(Command& command, FileOptions& files);
    // Finds the tiles around each task's own.
    void relate(std::vector<Task>& tasks, const WrapOptions& wrap) const;
    // The surroundings of the task's tile, which must outlive them; none without --tiles.
    [[nodiscard]] std::optional<TerrainTile> tile_of(const Task& task) const;
};

}  // namespace tex::cli
