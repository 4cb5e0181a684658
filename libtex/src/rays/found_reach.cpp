// SPDX-License-Identifier: Apache-2.0

#include "rays/found_reach.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "rays/box_tree.h"
#include "rays/ray_work.h"

namespace tex::inline v1 {
namespace {

constexpr double kFarthest = 0.1;  // of the diagonal: what is farther away belongs to something else
constexpr double kReserve = 0.25, kLeast = 0.001;
constexpr std::size_t kMostTriangles = 1 << 16;  // of the low mesh from which rays start
constexpr int kVerticesPerPiece = 4096;
constexpr int kTrianglesPerPiece = 512;

// The greatest number that any thread has seen.
class Greatest {
public:
    void see(double value) {
        double seen = value_.load(std::memory_order_relaxed);
        while (seen < value && !value_.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
        }
    }
    [[nodiscard]] double value() const { return value_.load(std::memory_order_relaxed); }

private:
    std::atomic<double> value_{0.0};
};

struct BothSides {
    Greatest front, back;
};

// Some triangles of the low mesh, with a tree over them.
struct LowSide {
    const MeshPart& part;  // of these triangles alone
    const BoxTree& tree;
    const std::vector<std::uint32_t>& triangles;
    const RayDirections& directions;
};

// The vertices of a part where it stands.
struct StandingVertices {
    const MeshPart& part;
    const NodeTransform* placement;  // or null
    std::size_t step;                // every so many of them

    [[nodiscard]] int count() const { return static_cast<int>((part.positions.size() + step - 1) / step); }
    [[nodiscard]] Vector3 at(std::size_t k) const {
        const Float3& p = part.positions[k * step];
        return vector_of(placement == nullptr ? p : placement->position(p));
    }
};

// Where all places have more vertices, some are left out. Copies of a part could not have had so many.
constexpr std::size_t kMostPlacedVertices = std::size_t{1} << 24;

std::vector<StandingVertices> vertices_of(const Triangles& triangles) {
    std::size_t all = 0;
    for (const StandingPart& place : triangles.places()) all += place.part->positions.size();
    const std::size_t step = all / (kMostPlacedVertices + 1) + 1;
    std::vector<StandingVertices> vertices;
    for (const StandingPart& place : triangles.places()) vertices.push_back({*place.part, place.placement, step});
    if (!vertices.empty()) return vertices;
    for (const MeshPart* part : triangles.parts()) vertices.push_back({*part, nullptr, 1});
    return vertices;
}

// From the vertices of the high mesh to the low one. A vertex that is nearer than both distances so far changes
// neither; mostly, the triangle near the last vertex says so.
// Returns whether that does not cost too much.
bool see_vertices(const StandingVertices& vertices, int begin, int end, const LowSide& low, double most,
                  BothSides& sides) {
    RayWork work;
    std::uint32_t near = kNoHit;
    for (int k = begin; k < end && work.is_fair(); ++k) {
        const Vector3 p = vertices.at(static_cast<std::size_t>(k));
        const double known = std::min(sides.front.value(), sides.back.value());
        if (near != kNoHit &&
            nearest_on_triangle(p, Triangles::Triangle{low.part, near}.corners()).squared <= known * known)
            continue;
        const NearestPoint within = low.tree.any_within(p, known * known);
        work.add(1, within.steps);
        near = within.triangle;
        if (near != kNoHit) continue;
        const NearestPoint nearest = low.tree.nearest(p, most * most);
        work.add(1, nearest.steps);
        if (nearest.triangle == kNoHit) continue;
        const Vector3 outwards =
            low.directions.at(low.triangles[nearest.triangle], nearest.weights, nearest.point, work);
        const bool in_front = dot(p - nearest.point, outwards) >= 0.0;
        (in_front ? sides.front : sides.back).see(std::sqrt(nearest.squared));
    }
    return work.is_fair();
}

// What a piece costs on each side.
struct BothWorks {
    RayWork low, high;
};

// From the corners and the middle of a triangle of the low mesh to the high one, along both directions of the ray.
void see_triangle(const MeshPart& low, std::size_t triangle, const RayDirections& directions, const BoxTree& tree,
                  double most, BothSides& sides, BothWorks& works) {
    constexpr double kThird = 1.0 / 3.0;
    constexpr std::array<double, 3> kPlaces[] = {
        {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, {kThird, kThird, kThird}};
    const auto corners = Triangles::Triangle{low, triangle}.corners();
    Ray rays[8];
    for (std::size_t k = 0; k < 4; ++k) {
        const Vector3 p = mix(corners, kPlaces[k]), d = directions.at(triangle, kPlaces[k], p, works.low);
        rays[2 * k] = {{p.x, p.y, p.z}, {d.x, d.y, d.z}, most, Facing::back};
        rays[2 * k + 1] = {{p.x, p.y, p.z}, {-d.x, -d.y, -d.z}, most, Facing::front};
    }
    RayHit hits[8];
    trace_fairly(tree.view(), rays, 8, hits, works.high);
    for (std::size_t k = 0; k < 8; k += 2) {
        const RayHit &out = hits[k], &in = hits[k + 1];
        if (out.triangle != kNoHit && (in.triangle == kNoHit || out.t < in.t))
            sides.front.see(out.t);
        else if (in.triangle != kNoHit)
            sides.back.see(in.t);
    }
}

// The triangles of the low mesh whose rays meet a group.
std::vector<std::uint32_t> triangles_of(const MeshPart& low, const RayGroups& groups, int group) {
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t t = 0; t < low.triangles(); ++t) {
        if (groups.of_low(t) == group) triangles.push_back(t);
    }
    return triangles;
}

MeshPart only_these(const MeshPart& low, const std::vector<std::uint32_t>& triangles) {
    MeshPart part;
    part.positions = low.positions;
    for (const std::uint32_t t : triangles)
        part.indices.insert(part.indices.end(), {low.indices[3 * t], low.indices[3 * t + 1], low.indices[3 * t + 2]});
    return part;
}

Result<void> see_group(const MeshPart& low, const std::vector<std::uint32_t>& triangles,
                       const RayDirections& directions, const RayGroup& group, double most, const Execution& execution,
                       BothSides& sides) {
    const std::size_t step = triangles.size() / kMostTriangles + 1;
    CostlyPiece costly, costly_back;
    const auto from_low = [&](int begin, int end) {
        const int piece = begin / kTrianglesPerPiece;
        BothWorks works;
        for (int k = begin; k < end && !costly.is_before(piece); ++k) {
            const std::size_t triangle = triangles[static_cast<std::size_t>(k) * step];
            see_triangle(low, triangle, directions, group.tree(), most, sides, works);
            if (!works.low.is_fair()) return costly.see(piece, RaySide::low);
            if (!works.high.is_fair()) return costly.see(piece, RaySide::high);
        }
    };
    const auto count = static_cast<int>((triangles.size() + step - 1) / step);
    if (auto seen = parallel_for(execution, count, kTrianglesPerPiece, from_low); !seen) return seen;
    if (auto fair = costly.check(); !fair) return fair;
    const MeshPart part = only_these(low, triangles);
    const auto low_tree = BoxTree::build(Triangles({&part}), execution);
    if (!low_tree) return low_tree.error();
    const LowSide side{part, *low_tree, triangles, directions};
    for (const StandingVertices& high : vertices_of(group.triangles())) {
        const auto from_high = [&](int begin, int end) {
            const int piece = begin / kVerticesPerPiece;
            if (costly_back.is_before(piece)) return;
            if (!see_vertices(high, begin, end, side, most, sides)) costly_back.see(piece, RaySide::low);
        };
        if (auto seen = parallel_for(execution, high.count(), kVerticesPerPiece, from_high); !seen) return seen;
        if (auto fair = costly_back.check(); !fair) return fair;
    }
    return {};
}

}  // namespace

Result<FoundReach> found_reach(const MeshPart& low, const RayDirections& directions, const RayGroups& groups,
                               double diagonal, const Execution& execution) {
    BothSides sides;
    for (std::size_t k = 0; k < groups.all().size(); ++k) {
        const std::vector<std::uint32_t> triangles = triangles_of(low, groups, static_cast<int>(k));
        if (triangles.empty()) continue;
        auto seen =
            see_group(low, triangles, directions, groups.all()[k], kFarthest * diagonal, execution.quiet(), sides);
        if (!seen) return seen.error();
    }
    const auto with_reserve = [&](double distance) { return (1.0 + kReserve) * distance + kLeast * diagonal; };
    return FoundReach{with_reserve(sides.front.value()), with_reserve(sides.back.value())};
}

double distance_between(const MeshPart& low, const RayGroups& groups) {
    double squared = std::numeric_limits<double>::infinity();
    RayWork work;
    for (std::size_t c = 0; c < low.indices.size() && work.is_fair(); ++c) {
        const int group = groups.of_low(c / 3);
        if (group == RayGroups::kNone) continue;
        const BoxTree& high = groups.all()[static_cast<std::size_t>(group)].tree();
        const NearestPoint nearest = high.nearest(vector_of(low.positions[low.indices[c]]), squared);
        work.add(1, nearest.steps);
        squared = std::min(squared, nearest.squared);
    }
    return std::sqrt(squared);
}

}  // namespace tex::inline v1
