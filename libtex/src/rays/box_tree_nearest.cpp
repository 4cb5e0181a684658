// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "rays/box_tree.h"

namespace tex::inline v1 {
namespace {

// Planes of boxes are rounded by less than this, in the units of the tree.
constexpr double kPlaneRounding = 0x1p-22;

double squared_length(Vector3 v) { return dot(v, v); }

// The place on the segment from a to b that is nearest to p: 0 is a, 1 is b.
double nearest_on_segment(Vector3 p, Vector3 a, Vector3 b) {
    const Vector3 way = b - a;
    const double size = dot(way, way);
    return size > 0.0 ? std::min(std::max(dot(p - a, way) / size, 0.0), 1.0) : 0.0;
}

double gap(double place, float low, float high, double rounding) {
    const double below = static_cast<double>(low) - place, above = place - static_cast<double>(high);
    return std::max(std::max(below, above) - rounding, 0.0);
}

// Where the search goes on, and the squared distance of this box in the units of the tree.
struct Candidate {
    double squared;
    std::uint32_t child;
};

}  // namespace

NearestPoint nearest_on_triangle(Vector3 p, const std::array<Vector3, 3>& corners) {
    const auto& [a, b, c] = corners;
    const Vector3 normal = cross(b - a, c - a);
    const double size = dot(normal, normal);
    NearestPoint nearest;
    if (size > 0.0) {
        const double v = dot(cross(c - a, a - p), normal) / size, w = dot(cross(a - p, b - a), normal) / size;
        if (v >= 0.0 && w >= 0.0 && v + w <= 1.0) {
            nearest.weights = {1.0 - v - w, v, w};
            nearest.point = mix(corners, nearest.weights);
            nearest.squared = squared_length(nearest.point - p);
            return nearest;
        }
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        const double t = nearest_on_segment(p, corners[k], corners[next]);
        const Vector3 point = (1.0 - t) * corners[k] + t * corners[next];
        const double squared = squared_length(point - p);
        if (squared >= nearest.squared) continue;
        nearest.squared = squared;
        nearest.point = point;
        nearest.weights = {};
        nearest.weights[k] = 1.0 - t;
        nearest.weights[next] = t;
    }
    return nearest;
}

namespace {

// Where the triangles of a tree are: where they are stored.
struct StoredSpace {
    Vector3 q;        // the point, in the units of the tree
    double to_units;  // from squared distances to those of boxes
    double rounding;

    StoredSpace(const TreeView& tree, Vector3 p)
        : q(tree.scale * (p - Vector3{tree.center[0], tree.center[1], tree.center[2]})),
          to_units(tree.scale * tree.scale), rounding(kPlaneRounding) {}

    [[nodiscard]] static std::array<Vector3, 3> corners(const TriangleGroup& group, std::size_t k) {
        std::array<Vector3, 3> corners;
        for (std::size_t c = 0; c < 3; ++c)
            corners[c] = vector_of(Float3{group.at[c][0][k], group.at[c][1][k], group.at[c][2][k]});
        return corners;
    }
    [[nodiscard]] static std::uint32_t number(std::uint32_t triangle) { return triangle; }
};

// Does what NodeTransform::position() does.
Float3 placed_corner(const PlacedTree& place, double x, double y, double z) {
    float moved[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double* const row = place.to_scene[axis];
        moved[axis] = static_cast<float>(row[0] * x + row[1] * y + row[2] * z + row[3]);
    }
    return {moved[0], moved[1], moved[2]};
}

// They stand somewhere else, where distances are at least those of the mesh divided by the size of the inverse.
struct PlacedSpace {
    Vector3 q;
    double to_units, rounding;
    const PlacedTree& place;

    PlacedSpace(const PlacedTree& of, Vector3 p) : place(of) {
        const double from[3] = {p.x - of.to_scene[0][3], p.y - of.to_scene[1][3], p.z - of.to_scene[2][3]};
        double at[3] = {}, squared = 0.0, slack = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            double moved = 0.0, size = of.slack[k];
            for (std::size_t j = 0; j < 3; ++j) {
                const double factor = of.to_mesh[k][j];
                moved += factor * from[j];
                size += 0x1p-46 * std::abs(factor) * (std::abs(from[j]) + std::abs(of.to_scene[j][3]));
                squared += factor * factor;
            }
            at[k] = of.tree.scale * (moved - of.tree.center[k]);
            slack += of.tree.scale * size;
        }
        q = {at[0], at[1], at[2]};
        to_units = of.tree.scale * of.tree.scale * squared;
        rounding = kPlaneRounding + slack;
        if (std::isfinite(to_units) && std::isfinite(rounding)) return;
        q = {};  // all boxes count
        to_units = 1.0;
        rounding = std::numeric_limits<double>::infinity();
    }

    [[nodiscard]] std::array<Vector3, 3> corners(const TriangleGroup& group, std::size_t k) const {
        std::array<Vector3, 3> corners;
        for (std::size_t c = 0; c < 3; ++c) {
            const auto x = static_cast<double>(group.at[c][0][k]), y = static_cast<double>(group.at[c][1][k]),
                       z = static_cast<double>(group.at[c][2][k]);
            corners[place.is_mirrored && c > 0 ? 3 - c : c] = vector_of(placed_corner(place, x, y, z));
        }
        return corners;
    }
    [[nodiscard]] std::uint32_t number(std::uint32_t triangle) const { return place.first + triangle; }
};

// Calls leaf(group or place) for those whose boxes are not farther away than `best`.
template <class Space, class Leaf>
void search_boxes(const Boxes* tree, const Space& space, double enough, NearestPoint& best, const Leaf& leaf) {
    const Vector3 q = space.q;
    const double to_units = space.to_units, rounding = space.rounding;
    Candidate stack[(kBoxes - 1) * kMostLevels + kBoxes + 1];
    Candidate* top = stack;
    *top++ = {0.0, 0};
    while (top > stack && best.squared > enough) {
        const Candidate next = *--top;
        if (next.squared > best.squared * to_units) continue;
        ++best.steps;
        if ((next.child & kGroupBit) != 0) {
            leaf(next.child & ~kGroupBit);
            continue;
        }
        const Boxes& boxes = tree[next.child];
        Candidate* const first = top;
        for (int k = 0; k < kBoxes; ++k) {
            const double x = gap(q.x, boxes.low[0][k], boxes.high[0][k], rounding),
                         y = gap(q.y, boxes.low[1][k], boxes.high[1][k], rounding),
                         z = gap(q.z, boxes.low[2][k], boxes.high[2][k], rounding), squared = x * x + y * y + z * z;
            if (!(squared <= best.squared * to_units)) continue;
            if (boxes.low[0][k] > boxes.high[0][k]) continue;  // there is none
            Candidate* place = top++;
            for (; place > first && place[-1].squared < squared; --place) *place = place[-1];
            *place = {squared, boxes.child[k]};
        }
    }
}

template <class Space>
void search_tree(const TreeView& tree, const Space& space, Vector3 p, double enough, NearestPoint& best) {
    search_boxes(tree.boxes, space, enough, best, [&](std::uint32_t index) {
        const TriangleGroup& group = tree.groups[index];
        for (std::size_t k = 0; k < kGroupTriangles && group.triangle[k] != kNoHit; ++k) {
            NearestPoint found = nearest_on_triangle(p, space.corners(group, k));
            found.triangle = space.number(group.triangle[k]);
            const bool is_first = found.squared == best.squared && found.triangle < best.triangle;
            if (!(found.squared < best.squared || (is_first && best.triangle != kNoHit))) continue;
            found.steps = best.steps;
            best = found;
        }
    });
}

}  // namespace

NearestPoint BoxTree::search(Vector3 p, double most, double enough) const {
    NearestPoint best;
    best.squared = most;
    const TreeView tree = view();
    if (tree.places == nullptr) {
        search_tree(tree, StoredSpace(tree, p), p, enough, best);
        return best;
    }
    search_boxes(tree.boxes, StoredSpace(tree, p), enough, best, [&](std::uint32_t index) {
        const PlacedTree& place = tree.places[index];
        if (place.is_plain)
            search_tree(place.tree, StoredSpace(place.tree, p), p, enough, best);
        else
            search_tree(place.tree, PlacedSpace(place, p), p, enough, best);
    });
    return best;
}

NearestPoint BoxTree::nearest(Vector3 p, double most) const { return search(p, most, -1.0); }

NearestPoint BoxTree::any_within(Vector3 p, double squared) const {
    const double more = squared > 0.0 ? squared * (1.0 + 0x1p-50) : 0x1p-1000;
    return search(p, more, squared);
}

}  // namespace tex::inline v1
