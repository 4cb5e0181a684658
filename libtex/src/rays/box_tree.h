// SPDX-License-Identifier: Apache-2.0
// box_tree.h: a tree of boxes over triangles, for rays and for the nearest point.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <tex/types.h>

#include "kernels/trace.h"
#include "rays/box_cuts.h"
#include "rays/triangles.h"
#include "threads/parallel.h"

namespace tex::inline v1 {

// The point of a triangle that is nearest to another point.
struct NearestPoint {
    double squared = std::numeric_limits<double>::infinity();  // the distance
    std::uint32_t triangle = kNoHit;
    std::array<double, 3> weights{};  // of the triangle's corners
    Vector3 point;
    std::int64_t steps = 0;  // of the search: see RayWork
};

class PartTrees;

// Each box has up to eight children: it is cut in two, then its largest child, and so on. A cut is the cheapest of 16
// places along the longest axis, or along each axis if there are few triangles, by the surface area heuristic (Wald, On
// Fast Construction of SAH-based Bounding Volume Hierarchies, 2007). Triangles whose boxes have a common centre are
// divided by their order; of copies among them, the first one alone is in the tree. The least and the greatest of
// numbers do not depend on their order, and the cuts follow from these and from counts. So the tree is the same for
// every number of threads.
class BoxTree {
public:
    // Precondition: there is at least one triangle. Errors: out_of_memory, cancelled.
    // Memory: about 80 bytes for each triangle, and 110 more while the tree is built.
    static Result<BoxTree> build(const Triangles& triangles, const Execution& execution, ProgressSpan span = {});

    // A tree of the places where parts stand, over a tree of each part that stands in several, which `shared` keeps:
    // all rays hit what they would hit in a tree of copies. Precondition: the triangles have places. Errors: bad_data
    // (coordinates become infinite), out_of_memory, cancelled.
    // Memory: about 500 bytes for each place.
    static Result<BoxTree> build_places(const Triangles& triangles, PartTrees& shared, const Execution& execution,
                                        ProgressSpan span = {});

    [[nodiscard]] TreeView view() const;

    // The point nearest to `p` among those whose squared distance is below `most`. Of several, that of the first
    // triangle.
    [[nodiscard]] NearestPoint nearest(Vector3 p, double most = std::numeric_limits<double>::infinity()) const;
    // A point within this squared distance, if there is any.
    [[nodiscard]] NearestPoint any_within(Vector3 p, double squared) const;

    // Between the corners of the box that holds all triangles, in the unit of the meshes.
    [[nodiscard]] Vector3 low() const { return low_; }
    [[nodiscard]] Vector3 high() const { return high_; }
    // The largest one of all corners, without its sign.
    [[nodiscard]] double largest_coordinate() const;

private:
    friend class TreeBuilder;
    friend class PlaceBuilder;
    [[nodiscard]] NearestPoint search(Vector3 p, double most, double enough) const;
    // Sets the bounds of all triangles.
    void set_bounds(const FloatBox& all);

    std::vector<Boxes> boxes_;
    std::vector<TriangleGroup> groups_;
    std::vector<PlacedTree> places_;  // instead of groups, if there are any
    std::vector<std::shared_ptr<const BoxTree>> below_;
    Vector3 low_, high_, center_;
    double scale_ = 1.0;
};

// The point of the triangle that is nearest to p; the triangle may be a segment or a point.
// (Ericson, Real-Time Collision Detection, 2005, 5.1.5.)
[[nodiscard]] NearestPoint nearest_on_triangle(Vector3 p, const std::array<Vector3, 3>& corners);

}  // namespace tex::inline v1
