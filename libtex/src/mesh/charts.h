// SPDX-License-Identifier: Apache-2.0
// charts.h: which triangles lie in one piece in the map.

#pragma once

#include <cstdint>
#include <vector>

#include <tex/mesh.h>

namespace tex::inline v1 {

// For each triangle, the number of its chart, from 0 in the order of their first triangles. Triangles that share a
// place of the map are of one chart. Precondition: the part has UV set `uv_set`. Throws std::bad_alloc.
std::vector<std::int32_t> charts_of(const MeshPart& part, int uv_set);

}  // namespace tex::inline v1
