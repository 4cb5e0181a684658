// SPDX-License-Identifier: Apache-2.0
// occluded_tile.h: occlusion of a tile of a terrain, on which the tiles around it cast their shadows.

#pragma once

#include <string>

#include <tex/pipeline.h>

#include "rows/bake_rows.h"

namespace tex::inline v1 {

struct OccludedTile {
    OcclusionMaps maps;  // of the tile
    int reach = 0;       // as BakeFileReport::occlusion_reach
};

// What the options want of the tile at `path`. `head` is that of its normals. With a distance, the heights are read
// twice: how far one counts follows from the highest. Errors: as occluded_heights(); those of reading the tiles, which
// name the file. May throw std::bad_alloc.
Result<OccludedTile> occluded_tile(const std::string& path, HeightFieldHead head, const BakeFileOptions& options,
                                   const Execution& execution);

}  // namespace tex::inline v1
