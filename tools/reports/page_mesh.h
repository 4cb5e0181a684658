// SPDX-License-Identifier: Apache-2.0
// page_mesh.h: a mesh of any number of triangles, made small enough for a page.

#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <tex/mesh.h>

namespace tex::cli {

// Takes parts that are visited one by one, several times, always in the same order.
using VisitPart = std::function<void(const MeshPart&)>;
using VisitAll = std::function<void(const VisitPart&)>;

// All parts as one, with normals (those of the triangles where a part has none) and, for preview(), a set of UVs, which
// are all 0. If there are more triangles than `most`, vertices in the same cell of a grid become one, at their mean
// place, and triangles that lose a corner go (Rossignac and Borrel, Multi-resolution 3D approximations for rendering
// complex scenes, 1993). Normals are means, too, of those vertices of a cell that face the same side of a cube, so that
// both sides of a sheet stay apart. The grid has at most 256 cells in each direction, and as many as keep to `most`.
//
// Preconditions: every part passes check_part(); there is a part; most >= 1.
[[nodiscard]] MeshPart page_mesh(const VisitAll& visit_all, std::size_t most);

}  // namespace tex::cli
