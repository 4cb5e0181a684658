// SPDX-License-Identifier: Apache-2.0

#include "mesh/coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "mesh/triangle_edge.h"

namespace tex::inline v1 {
namespace {

// Corners are rounded to 1/256 texel, as GPUs do: then the side of an edge that a texel is on is exact, and triangles
// with a common edge neither overlap nor leave a gap.
constexpr std::int64_t kSteps = 256;

// Limits of a triangle, so that the products of steps fit into 64 bits, and the work stays in proportion to the map.
constexpr double kMaxRepeats = 16.0;
constexpr double kMaxTexels = 1 << 22;
constexpr double kMaxUv = 1e6;
constexpr std::int64_t kMaxLayers = 1024;  // of triangles over the whole map
constexpr int kStripTexels = 1 << 17;

struct Point {
    double x = 0.0, y = 0.0;
};

// The place on the segment from a to b that is nearest to p: 0 is a, 1 is b.
double nearest_on(Point p, Point a, Point b) {
    const double dx = b.x - a.x, dy = b.y - a.y, size = dx * dx + dy * dy;
    const double along = size > 0.0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / size : 0.0;
    return std::min(std::max(along, 0.0), 1.0);
}

// The point of a triangle's border that is nearest to p, as weights of the corners.
struct BorderPoint {
    double squared = std::numeric_limits<double>::infinity();  // the distance
    std::array<double, 3> weights{};
};

BorderPoint nearest_on_border(Point p, const std::array<Point, 3>& c) {
    BorderPoint nearest;
    for (std::size_t k = 0; k < 3; ++k) {
        const Point a = c[k], b = c[(k + 1) % 3];
        const double t = nearest_on(p, a, b);
        const double x = a.x + t * (b.x - a.x) - p.x, y = a.y + t * (b.y - a.y) - p.y;
        const double squared = x * x + y * y;
        if (squared >= nearest.squared) continue;
        nearest.squared = squared;
        nearest.weights = {};
        nearest.weights[k] = 1.0 - t;
        nearest.weights[(k + 1) % 3] = t;
    }
    return nearest;
}

// The weights on the way from the border to p: as far as no weight is below -1. Beyond a sliver, p itself would have
// weights of hundreds.
std::array<double, 3> limited(const std::array<double, 3>& border, const std::array<double, 3>& outside) {
    double way = 1.0;
    for (std::size_t k = 0; k < 3; ++k) {
        if (outside[k] < -1.0) way = std::min(way, (border[k] + 1.0) / (border[k] - outside[k]));
    }
    std::array<double, 3> weights{};
    for (std::size_t k = 0; k < 3; ++k) weights[k] = border[k] + way * (outside[k] - border[k]);
    return weights;
}

Error unfit(std::int32_t triangle, const std::string& what) {
    return {ErrorCode::unsupported, {}, "triangle " + std::to_string(triangle) + " " + what};
}

}  // namespace

Result<CoverageMap> CoverageMap::make(const MeshPart& part, int uv_set, Extent extent, int gutter, int rows) {
    CoverageMap map;
    map.extent_ = extent;
    map.gutter_ = gutter;
    map.strip_rows_ = rows * std::max(1, std::min(32, kStripTexels / extent.width) / rows);
    map.by_strip_.resize(static_cast<std::size_t>(map.strips()));
    for (std::size_t t = 0; t < part.triangles(); ++t) {
        const auto placed = map.place(part, part.uvs[static_cast<std::size_t>(uv_set)], static_cast<std::int32_t>(t));
        if (!placed) return placed.error();
    }
    return map;
}

// Adds a copy of the triangle for each repeat of the map that it touches.
Result<void> CoverageMap::place(const MeshPart& part, const std::vector<Float2>& uvs, std::int32_t triangle) {
    Point corner[3];
    Point low{1e300, 1e300}, high{-1e300, -1e300};
    for (std::size_t k = 0; k < 3; ++k) {
        const Float2 uv = uvs[part.indices[3 * static_cast<std::size_t>(triangle) + k]];
        const auto v = static_cast<double>(uv.y);
        corner[k] = {static_cast<double>(uv.x), part.v_axis == YAxis::up ? 1.0 - v : v};
        low = {std::min(low.x, corner[k].x), std::min(low.y, corner[k].y)};
        high = {std::max(high.x, corner[k].x), std::max(high.y, corner[k].y)};
    }
    const double width = high.x - low.x, height = high.y - low.y;
    if (std::max({-low.x, -low.y, high.x, high.y}) > kMaxUv) return unfit(triangle, "has UVs beyond a million");
    if (std::max(width, height) > kMaxRepeats) return unfit(triangle, "covers more than 16 repeats of the map");
    if (std::max(width * extent_.width, height * extent_.height) > kMaxTexels)
        return unfit(triangle, "covers more than 2^22 texels in one direction");
    const double margin_x = (gutter_ + 1.0) / extent_.width, margin_y = (gutter_ + 1.0) / extent_.height;
    const auto repeat = [](double value) { return static_cast<std::int64_t>(std::floor(value)); };
    for (std::int64_t j = repeat(low.y - margin_y); j <= repeat(high.y + margin_y); ++j) {
        for (std::int64_t i = repeat(low.x - margin_x); i <= repeat(high.x + margin_x); ++i) {
            const auto left = static_cast<double>(i), top = static_cast<double>(j);
            Placed placed{triangle, {}, {}, i != 0 || j != 0};
            for (std::size_t k = 0; k < 3; ++k) {
                placed.x[k] =
                    static_cast<std::int64_t>(std::floor((corner[k].x - left) * extent_.width * kSteps + 0.5));
                placed.y[k] =
                    static_cast<std::int64_t>(std::floor((corner[k].y - top) * extent_.height * kSteps + 0.5));
            }
            if (Result<void> added = add(placed, part.triangles()); !added) return added;
        }
    }
    return {};
}

// Fails if that would be too much work or memory.
Result<void> CoverageMap::add(const Placed& placed, std::size_t triangles) {
    const Box box = box_of(placed, gutter_ + 1, -1);
    if (box.left > box.right || box.top > box.bottom) return {};
    tests_ += static_cast<std::int64_t>(box.right - box.left + 1) * (box.bottom - box.top + 1);
    entries_ += box.bottom / strip_rows_ - box.top / strip_rows_ + 1;
    if (tests_ > kMaxLayers * std::max<std::int64_t>(extent_.texels(), 1 << 20))
        return Error{ErrorCode::unsupported, {}, "its triangles cover the map more than a thousand times"};
    if (entries_ > static_cast<std::int64_t>(16 * triangles) + (1 << 24))
        return Error{ErrorCode::unsupported, {}, "its triangles are too many and too long for a map of this size"};
    for (int strip = box.top / strip_rows_; strip <= box.bottom / strip_rows_; ++strip)
        by_strip_[static_cast<std::size_t>(strip)].push_back(static_cast<std::uint32_t>(placed_.size()));
    placed_.push_back(placed);
    return {};
}

// The texels near a triangle that are in the map, and in the strip unless it is -1.
CoverageMap::Box CoverageMap::box_of(const Placed& t, int margin, int strip) const {
    const auto texel = [](std::int64_t steps) { return floor_div(steps, kSteps); };
    const auto clamp = [](std::int64_t value, int low, int high) {
        return static_cast<int>(std::min<std::int64_t>(std::max<std::int64_t>(value, low), high));
    };
    const int top = strip < 0 ? 0 : strip * strip_rows_;
    const int bottom = strip < 0 ? extent_.height : std::min(extent_.height, top + strip_rows_);
    const auto [x0, x1] = std::minmax({t.x[0], t.x[1], t.x[2]});
    const auto [y0, y1] = std::minmax({t.y[0], t.y[1], t.y[2]});
    return {clamp(texel(x0) - margin, 0, extent_.width), clamp(texel(x1) + margin, -1, extent_.width - 1),
            clamp(texel(y0) - margin, top, bottom), clamp(texel(y1) + margin, top - 1, bottom - 1)};
}

void CoverageMap::cover_inside(const Placed& t, int strip, std::vector<Covered>& texels, Overlaps& overlaps) const {
    TrianglePoint corner[3] = {{t.x[0], t.y[0]}, {t.x[1], t.y[1]}, {t.x[2], t.y[2]}};
    const std::int64_t area = twice_area(corner[0], corner[1], corner[2]);
    const Box box = box_of(t, 0, strip);
    if (area == 0 || box.left > box.right || box.top > box.bottom) return;
    const bool is_turned = area < 0;
    if (is_turned) std::swap(corner[1], corner[2]);
    const TrianglePoint start{box.left * kSteps + kSteps / 2, box.top * kSteps + kSteps / 2};
    // Each opposite of the corner with its number.
    TriangleEdge edges[3] = {{corner[1], corner[2], start, kSteps},
                             {corner[2], corner[0], start, kSteps},
                             {corner[0], corner[1], start, kSteps}};
    const auto whole = static_cast<double>(is_turned ? -area : area);
    for (int j = box.top; j <= box.bottom; ++j) {
        std::int64_t first = 0, last = box.right - box.left;
        for (const TriangleEdge& edge : edges) edge.clip(first, last);
        for (std::int64_t k = first; k <= last; ++k) {
            Covered& texel = texels[place_of(box.left + static_cast<int>(k), j, strip)];
            if (texel.inside) {
                ++(t.is_moved && !texel.is_moved ? overlaps.moved : overlaps.same);
                continue;
            }
            const auto weight = [&](int n) { return static_cast<double>(edges[n].at(k)) / whole; };
            texel = {t.triangle, true, t.is_moved, {weight(0), weight(is_turned ? 2 : 1), weight(is_turned ? 1 : 2)}};
        }
        for (TriangleEdge& edge : edges) edge.next_row();
    }
}

void CoverageMap::cover_gutter(const Placed& t, int strip, std::vector<Covered>& texels,
                               std::vector<double>& nearest) const {
    const Box box = box_of(t, gutter_, strip);
    std::array<Point, 3> c;
    for (std::size_t k = 0; k < 3; ++k)
        c[k] = {static_cast<double>(t.x[k]) / kSteps, static_cast<double>(t.y[k]) / kSteps};
    const double area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x);
    if (area == 0.0) return;
    for (int j = box.top; j <= box.bottom; ++j) {
        for (int i = box.left; i <= box.right; ++i) {
            const std::size_t place = place_of(i, j, strip);
            if (texels[place].inside) continue;
            const Point p{i + 0.5, j + 0.5};
            const BorderPoint border = nearest_on_border(p, c);
            if (border.squared > gutter_ * gutter_ || border.squared >= nearest[place]) continue;
            nearest[place] = border.squared;
            std::array<double, 3> outside{};
            for (std::size_t k = 0; k < 3; ++k) {
                const Point &a = c[(k + 1) % 3], &b = c[(k + 2) % 3];
                outside[k] = ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / area;
            }
            texels[place] = {t.triangle, false, t.is_moved, limited(border.weights, outside)};
        }
    }
}

Overlaps CoverageMap::cover(int strip, std::vector<Covered>& texels) const {
    const auto rows = static_cast<std::size_t>(std::min(strip_rows_, extent_.height - strip * strip_rows_));
    texels.assign(rows * static_cast<std::size_t>(extent_.width), {});
    const std::vector<std::uint32_t>& here = by_strip_[static_cast<std::size_t>(strip)];
    Overlaps overlaps;
    for (const bool is_moved : {false, true}) {
        for (const std::uint32_t k : here) {
            if (placed_[k].is_moved == is_moved) cover_inside(placed_[k], strip, texels, overlaps);
        }
    }
    if (gutter_ == 0) return overlaps;
    std::vector<double> nearest(texels.size(), std::numeric_limits<double>::infinity());
    for (const bool is_moved : {false, true}) {
        for (const std::uint32_t k : here) {
            if (placed_[k].is_moved == is_moved) cover_gutter(placed_[k], strip, texels, nearest);
        }
    }
    return overlaps;
}

}  // namespace tex::inline v1
