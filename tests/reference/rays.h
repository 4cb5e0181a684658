// SPDX-License-Identifier: Apache-2.0
// rays.h: what a ray hits, by testing every triangle, in double and without any tree.

#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace tex::reference {

using Point = std::array<double, 3>;
using PlainTriangle = std::array<Point, 3>;

struct PlainHit {
    bool found = false;
    double t = 0.0;
    Point weights{};
    std::uint32_t triangle = 0;
};

// The least (t, triangle) with 0 <= t <= length among the triangles that the ray meets; `facing` is 1 for those whose
// corners it sees counter-clockwise, -1 for clockwise, 0 for all. The formulas of Woop, Benthin, Wald (2013).
PlainHit first_hit(const std::vector<PlainTriangle>& triangles, const Point& origin, const Point& direction,
                   double length, int facing);

// Finds it by another way: the signs of the volumes between the ray and the edges in long double (Pluecker
// coordinates). Only triangles count that the ray meets by more than `margin` of their size within all edges.
PlainHit clear_hit(const std::vector<PlainTriangle>& triangles, const Point& origin, const Point& direction,
                   double length, int facing, double margin);

// The smallest squared distance of p from any triangle, from a search over a grid of weights that is refined around the
// best one.
double nearest_squared(const std::vector<PlainTriangle>& triangles, const Point& p);

}  // namespace tex::reference
