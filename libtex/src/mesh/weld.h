// SPDX-License-Identifier: Apache-2.0
// weld.h: which corners of a mesh are one vertex.

#pragma once

#include <cstdint>
#include <vector>

#include <tex/mesh.h>
#include <tex/types.h>

namespace tex::inline v1 {

// For each corner, the corner that represents all those with its position, normal and UV (of set `uv_set`).
//
// Which one of them represents the others follows from the order in which MikkTSpace's reference implementation divides
// space: 2048 slabs along the longest side of the bounding box, each halved until one position is left. The order of
// representatives decides which edges the reference sorts last (neighbours.h), so it must be the same.
// Errors: out_of_memory, cancelled.
Result<std::vector<std::uint32_t>> weld_corners(const MeshPart& part, int uv_set, const Execution& execution);

// The classes of weld_corners(), each represented by its first corner.
Result<std::vector<std::uint32_t>> weld_to_first(const MeshPart& part, int uv_set, const Execution& execution);

// For each vertex, the number of its position; equal positions have the same number. May throw std::bad_alloc.
std::vector<std::uint32_t> numbered_positions(const MeshPart& part);

}  // namespace tex::inline v1
