// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

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

double gap(double place, float low, float high) {
    const double below = static_cast<double>(low) - place, above = place - static_cast<double>(high);
    return std::max(std::max(below, above) - kPlaneRounding, 0.0);
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

NearestPoint BoxTree::search(Vector3 p, double most, double enough) const {
    NearestPoint best;
    best.squared = most;
    const Vector3 q = scale_ * (p - center_);
    const double to_units = scale_ * scale_;
    Candidate stack[(kBoxes - 1) * kMostLevels + kBoxes + 1];
    Candidate* top = stack;
    *top++ = {0.0, 0};
    std::int64_t steps = 0;
    while (top > stack && best.squared > enough) {
        const Candidate next = *--top;
        if (next.squared > best.squared * to_units) continue;
        ++steps;
        if ((next.child & kGroupBit) != 0) {
            const TriangleGroup& group = groups_[next.child & ~kGroupBit];
            for (std::size_t k = 0; k < kGroupTriangles && group.triangle[k] != kNoHit; ++k) {
                std::array<Vector3, 3> corners;
                for (std::size_t c = 0; c < 3; ++c)
                    corners[c] = vector_of(Float3{group.at[c][0][k], group.at[c][1][k], group.at[c][2][k]});
                NearestPoint found = nearest_on_triangle(p, corners);
                found.triangle = group.triangle[k];
                const bool is_first = found.squared == best.squared && found.triangle < best.triangle;
                if (found.squared < best.squared || (is_first && best.triangle != kNoHit)) best = found;
            }
            continue;
        }
        const Boxes& boxes = boxes_[next.child];
        Candidate* const first = top;
        for (int k = 0; k < kBoxes; ++k) {
            const double x = gap(q.x, boxes.low[0][k], boxes.high[0][k]),
                         y = gap(q.y, boxes.low[1][k], boxes.high[1][k]),
                         z = gap(q.z, boxes.low[2][k], boxes.high[2][k]), squared = x * x + y * y + z * z;
            if (!(squared <= best.squared * to_units)) continue;
            if (boxes.low[0][k] > boxes.high[0][k]) continue;  // there is none
            Candidate* place = top++;
            for (; place > first && place[-1].squared < squared; --place) *place = place[-1];
            *place = {squared, boxes.child[k]};
        }
    }
    best.steps = steps;
    return best;
}

NearestPoint BoxTree::nearest(Vector3 p, double most) const { return search(p, most, -1.0); }

NearestPoint BoxTree::any_within(Vector3 p, double squared) const {
    const double more = squared > 0.0 ? squared * (1.0 + 0x1p-50) : 0x1p-1000;
    return search(p, more, squared);
}

}  // namespace tex::inline v1
