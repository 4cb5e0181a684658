// SPDX-License-Identifier: Apache-2.0

#include "reports/page_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace tex::cli {
namespace {

constexpr int kMostCells = 256;  // in each direction: 64 MB for their numbers
constexpr std::int32_t kNoVertex = -1;

using Point = std::array<double, 3>;

Point point_of(const Float3& p) {
    return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

Float3 rounded_point(const Point& p) {
    return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

// Twice the triangle's area, along its normal.
Point area_of(const MeshPart& part, std::size_t triangle) {
    std::array<Point, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = point_of(part.positions[part.indices[3 * triangle + k]]);
    Point a{}, b{};
    for (std::size_t c = 0; c < 3; ++c) {
        a[c] = p[1][c] - p[0][c];
        b[c] = p[2][c] - p[0][c];
    }
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double length_of(const Point& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// The vector with length 1, if it has any length.
Point unit_of(Point v) {
    const double length = length_of(v);
    if (!(length > 1e-30)) return v;
    for (double& c : v) c /= length;
    return v;
}

Point normal_at(const MeshPart& part, std::size_t triangle, std::size_t corner) {
    if (part.normals.empty()) return unit_of(area_of(part, triangle));
    return unit_of(point_of(part.normals[part.indices[3 * triangle + corner]]));
}

MeshPart joined_parts(const VisitAll& visit_all) {
    MeshPart all;
    visit_all([&all](const MeshPart& part) {
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        if (!part.normals.empty()) {
            all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
            all.normals.insert(all.normals.end(), part.normals.begin(), part.normals.end());
            for (const std::uint32_t v : part.indices) all.indices.push_back(first + v);
            return;
        }
        for (std::size_t k = 0; k < part.indices.size(); ++k) {
            all.positions.push_back(part.positions[part.indices[k]]);
            all.normals.push_back(rounded_point(normal_at(part, k / 3, k % 3)));
            all.indices.push_back(first + static_cast<std::uint32_t>(k));
        }
    });
    return all;
}

// The side of a cube that a normal points to.
std::size_t side_of(const Point& n) {
    std::size_t axis = 0;
    for (std::size_t c = 1; c < 3; ++c) {
        if (std::abs(n[c]) > std::abs(n[axis])) axis = c;
    }
    return 2 * axis + (n[axis] < 0.0 ? 1 : 0);
}

// The box of all triangles, and their area.
struct Bounds {
    Point low{}, high{};
    double area = 0.0;
    std::size_t triangles = 0;

    explicit Bounds(const VisitAll& visit_all) {
        low.fill(std::numeric_limits<double>::infinity());
        high.fill(-std::numeric_limits<double>::infinity());
        visit_all([this](const MeshPart& part) {
            for (const std::uint32_t v : part.indices) {
                const Point p = point_of(part.positions[v]);
                for (std::size_t c = 0; c < 3; ++c) {
                    low[c] = std::min(low[c], p[c]);
                    high[c] = std::max(high[c], p[c]);
                }
            }
            for (std::size_t t = 0; t < part.triangles(); ++t) area += 0.5 * length_of(area_of(part, t));
            triangles += part.triangles();
        });
    }
    [[nodiscard]] double side() const {
        return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2], 1e-30});
    }
};

class Grid {
public:
    Grid(const Bounds& bounds, int cells)
        : low_(bounds.low), cell_(bounds.side() / cells), cells_(static_cast<std::size_t>(cells)),
          numbers_(cells_ * cells_ * cells_, kNoVertex) {}

    void add(const MeshPart& part) {
        for (std::size_t t = 0; t < part.triangles(); ++t) add(part, t);
    }
    [[nodiscard]] std::size_t triangles() const { return corners_.size() / 3; }

    // Makes a part of the first triangles.
    [[nodiscard]] MeshPart finish(std::size_t most) const {
        MeshPart part;
        std::vector<std::int32_t> vertices(6 * cells_of_.size(), kNoVertex);
        for (std::size_t k = 0; k < std::min(corners_.size(), 3 * most); ++k) {
            const std::size_t corner = corners_[k];
            if (vertices[corner] == kNoVertex) {
                const Cell& cell = cells_of_[corner / 6];
                vertices[corner] = static_cast<std::int32_t>(part.positions.size());
                Point p = cell.sum;
                for (double& c : p) c /= cell.count;
                part.positions.push_back(rounded_point(p));
                part.normals.push_back(rounded_point(cell.normal(corner % 6)));
            }
            part.indices.push_back(static_cast<std::uint32_t>(vertices[corner]));
        }
        return part;
    }

private:
    // The vertices in a cell; normals by the side that they face.
    struct Cell {
        Point sum{};
        double count = 0.0;
        std::array<Point, 6> normals{};

        // With those of other sides within 60 degrees: smooth surfaces face several sides in a cell.
        [[nodiscard]] Point normal(std::size_t side) const {
            const Point own = unit_of(normals[side]);
            Point near{};
            for (const Point& other : normals) {
                const Point n = unit_of(other);
                if (n[0] * own[0] + n[1] * own[1] + n[2] * own[2] < 0.5) continue;
                for (std::size_t c = 0; c < 3; ++c) near[c] += other[c];
            }
            return unit_of(near);
        }
    };

    void add(const MeshPart& part, std::size_t triangle) {
        std::array<std::size_t, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Point p = point_of(part.positions[part.indices[3 * triangle + k]]);
            const Point n = normal_at(part, triangle, k);
            const std::size_t number = cell_of(p), side = side_of(n);
            Cell& cell = cells_of_[number];
            for (std::size_t c = 0; c < 3; ++c) {
                cell.sum[c] += p[c];
                cell.normals[side][c] += n[c];
            }
            cell.count += 1.0;
            corners[k] = 6 * number + side;
        }
        const std::size_t a = corners[0] / 6, b = corners[1] / 6, c = corners[2] / 6;
        if (a != b && b != c && c != a) corners_.insert(corners_.end(), corners.begin(), corners.end());
    }

    std::size_t cell_of(const Point& p) {
        std::size_t at = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double place = std::clamp((p[c] - low_[c]) / cell_, 0.0, static_cast<double>(cells_ - 1));
            at = at * cells_ + static_cast<std::size_t>(place);
        }
        if (numbers_[at] == kNoVertex) {
            numbers_[at] = static_cast<std::int32_t>(cells_of_.size());
            cells_of_.emplace_back();
        }
        return static_cast<std::size_t>(numbers_[at]);
    }

    Point low_;
    double cell_;
    std::size_t cells_;
    std::vector<std::int32_t> numbers_;
    std::vector<Cell> cells_of_;
    std::vector<std::size_t> corners_;  // 6 times the number of the cell, and the side
};

MeshPart with_uvs(MeshPart part) {
    part.uvs = {std::vector<Float2>(part.positions.size())};
    return part;
}

}  // namespace

MeshPart page_mesh(const VisitAll& visit_all, std::size_t most) {
    const Bounds bounds(visit_all);
    if (bounds.triangles <= most) return with_uvs(joined_parts(visit_all));
    // A surface crosses about area / cell^2 cells, and has about two triangles in each.
    const double wanted = bounds.side() * std::sqrt(static_cast<double>(most) / std::max(2.0 * bounds.area, 1e-30));
    int cells = static_cast<int>(std::clamp(1.25 * wanted, 2.0, static_cast<double>(kMostCells)));
    for (;; cells = std::max(2, cells * 4 / 5)) {
        Grid grid(bounds, cells);
        visit_all([&grid](const MeshPart& part) { grid.add(part); });
        if (grid.triangles() > most && cells > 2) continue;
        if (grid.triangles() > 0) return with_uvs(grid.finish(most));
        // All of it is in too few cells, such as needles: some triangles as they are.
        MeshPart some;
        visit_all([&](const MeshPart& part) {
            if (some.indices.empty()) some = part;
        });
        some.indices.resize(std::min(some.indices.size(), 3 * most));
        some.quads.clear();
        return with_uvs(joined_parts([&some](const VisitPart& visit) { visit(some); }));
    }
}

}  // namespace tex::cli
