// SPDX-License-Identifier: Apache-2.0
// uv_tiles.h: UDIM tiles (mesh_selection.h) and the UVs of triangles: those of the first set of a part.

#pragma once

#include <cstddef>

#include <tex/mesh.h>

namespace tex::inline v1 {

// The tile of the centre of a triangle's UVs, or 0.
int tile_of(const MeshPart& part, std::size_t triangle);

// Whether a corner is more than 1e-4 outside of the tile.
bool leaves_tile(const MeshPart& part, std::size_t triangle, int tile);

}  // namespace tex::inline v1
