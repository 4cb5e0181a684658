// SPDX-License-Identifier: Apache-2.0
// triangle_edge.h: which samples of a row are inside a triangle. Corners are whole numbers, so that the side of an edge
// that a sample is on is exact, and triangles with a common edge neither overlap nor leave a gap (Pineda 1988; the
// top-left rule of Direct3D: a sample on an edge belongs to the triangle if the edge is a top or a left one).

#pragma once

#include <algorithm>
#include <cstdint>

namespace tex::inline v1 {

struct TrianglePoint {
    std::int64_t x, y;
};

// Twice the area: positive if the corners are clockwise in the picture, where y points down.
constexpr std::int64_t twice_area(TrianglePoint a, TrianglePoint b, TrianglePoint c) {
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

constexpr std::int64_t floor_div(std::int64_t a, std::int64_t b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

// An edge of a triangle whose corners are clockwise. Sample 0 of the first row is at `start`; samples and rows are
// `spacing` apart.
class TriangleEdge {
public:
    TriangleEdge(TrianglePoint from, TrianglePoint to, TrianglePoint start, std::int64_t spacing)
        : step_(spacing * (from.y - to.y)), down_(spacing * (to.x - from.x)),
          owned_(to.y < from.y || (to.y == from.y && to.x > from.x)), value_(twice_area(from, to, start)) {}

    // Twice the area of the triangle of the edge and sample k of this row: positive inside, 0 on the edge.
    [[nodiscard]] std::int64_t at(std::int64_t k) const { return value_ + k * step_; }

    // Shortens the samples first to last of this row to those inside.
    void clip(std::int64_t& first, std::int64_t& last) const {
        const std::int64_t value = owned_ ? value_ : value_ - 1;  // at least 0 inside
        if (step_ > 0) {
            if (value < 0) first = std::max(first, floor_div(-value + step_ - 1, step_));
        } else if (step_ < 0) {
            last = std::min(last, floor_div(value, -step_));
        } else if (value < 0) {
            last = -1;
        }
    }
    void next_row() { value_ += down_; }

private:
    std::int64_t step_, down_;
    bool owned_;
    std::int64_t value_;
};

}  // namespace tex::inline v1
