// SPDX-License-Identifier: Apache-2.0
// neighbours.h: which triangles share an edge.

#pragma once

#include <cstdint>
#include <vector>

#include <tex/types.h>

namespace tex::inline v1 {

inline constexpr std::int32_t kNoNeighbour = -1;

// For each edge, the triangle on its other side, or kNoNeighbour. Edge 3 t + k of triangle t runs from its corner k to
// the next one. `corners` has the representatives (weld.h) of all corners of triangles that have three different ones.
//
// If more than two triangles share an edge, each takes the first later one that runs along it in the other direction
// and is still free. The edges of the vertex that sorts last are an exception: the reference implementation of
// MikkTSpace forgets to sort them, so it finds only those neighbours that its quicksort happened to leave side by side.
// That order is repeated here. Errors: out_of_memory, cancelled.
Result<std::vector<std::int32_t>> find_neighbours(const std::vector<std::uint32_t>& corners,
                                                  const Execution& execution);

}  // namespace tex::inline v1
