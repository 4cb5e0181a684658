// SPDX-License-Identifier: Apache-2.0
// kernels/trace.h: what rays hit in a tree of boxes (rays/box_tree.h).
//
// Boxes have eight children, whose planes lie side by side, so that one instruction tests all of them. They are tested
// in float, in units of their own: the tree is moved and scaled so that all triangles lie between -1 and 1. Every test
// allows for more than its own rounding, so that no box is missed: see kBoxSlack. (Compare Ize, Robust BVH Ray
// Traversal, JCGT 2 (2), 2013, whose factor protects distances; a slack of places also covers the rounding of the ray.)
//
// Triangles are tested in double, four at a time (Woop, Benthin, Wald, Watertight Ray/Triangle Intersection, JCGT 2
// (1), 2013). The side of an edge that the ray passes on is computed from the two ends of the edge alone, by operations
// whose result only changes its sign if the ends change places. So two triangles with a common edge agree, and the ray
// hits at least one of them; a ray that meets the edge itself hits both. The order in which boxes are visited, and
// which rays go together, does not matter: the hit is the least (t, triangle) of all triangles that are hit. There is
// one exception: a triangle that the ray sees edge-on, so that its area is nothing but rounding, may be passed over if
// the ray does not meet its box.

#pragma once

#include <cstddef>
#include <cstdint>

namespace tex::inline v1 {

inline constexpr int kBoxes = 8;
inline constexpr int kGroupTriangles = 4;
inline constexpr std::uint32_t kNoHit = 0xffffffff;

// A child is the index of a box, or with kGroupBit that of a group. Children that are missing have boxes from infinity
// to minus infinity, which no ray meets.
inline constexpr std::uint32_t kGroupBit = 0x80000000;
struct alignas(32) Boxes {
    float low[3][kBoxes], high[3][kBoxes];  // x, y, z
    std::uint32_t child[kBoxes];
};

// Triangles in the units of the mesh: corner, axis, triangle. The corners of triangles that are missing are NaN.
struct alignas(16) TriangleGroup {
    float at[3][3][kGroupTriangles];
    std::uint32_t triangle[kGroupTriangles];
};

// The rounding of a box's plane, of a ray's origin and direction, and of the four operations of a test move a plane by
// less than 10 times 2^-24 of the largest number in it, which is the origin's largest coordinate or 1.
inline constexpr double kBoxSlack = 0x1p-20;

// How deep boxes may lie in each other.
inline constexpr int kMostLevels = 64;

struct PlacedTree;
struct TreeView {
    const Boxes* boxes = nullptr;  // the first one holds all others
    const TriangleGroup* groups = nullptr;
    double center[3] = {};  // (place - center) * scale lies in [-1, 1]; scale is a power of two
    double scale = 1.0;
    const PlacedTree* places = nullptr;  // if there are any, children with kGroupBit are places instead of groups
};

// A tree whose triangles stand somewhere else. Each corner is moved and rounded to float as in_scene() of mesh.h does
// it, so that a ray hits exactly what it would hit if there were a copy of the mesh; only boxes are tested in the space
// of the mesh, to which the ray is brought. The rounding of corners moves them there by less than `slack`.
struct PlacedTree {
    TreeView tree;          // of the mesh
    double to_scene[3][4];  // rows
    double to_mesh[3][3];   // the inverse of its first three columns
    double slack[3];        // in the unit of the mesh
    std::uint32_t first;    // the number of its first triangle
    bool is_mirrored;       // the second and the third corner change places
    bool is_plain;          // triangles stand where they are stored, and have numbers of their own: the rest is unused
};

// Which triangles a ray hits: those whose corners it sees counter-clockwise, clockwise, or all.
enum class Facing : std::uint8_t { front, back, both };

struct Ray {
    double origin[3];
    double direction[3];  // of unit length
    double length;        // hits have 0 <= t <= length
    Facing facing;
};

// t and triangle are unchanged, and kNoHit, if nothing is hit.
struct RayHit {
    double t = 0.0;
    double weights[3] = {};  // of the triangle's corners
    std::uint32_t triangle = kNoHit;
};

// hits[k] becomes the hit of rays[k]. Eight rays that begin near each other and look nearly the same way cost half of
// what they cost alone, if they follow each other. A ray whose origin is farther away than 10^30 sizes of the tree hits
// nothing. Returns the steps: how many boxes and groups were looked at.
std::int64_t trace_rays(const TreeView& tree, const Ray* rays, std::size_t count, RayHit* hits);

// blocked[k] becomes 1 if rays[k] hits anything, otherwise 0: what trace_rays() finds, in less time. Returns the steps.
std::int64_t find_blocked(const TreeView& tree, const Ray* rays, std::size_t count, std::uint8_t* blocked);

}  // namespace tex::inline v1
