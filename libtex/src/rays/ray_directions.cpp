// SPDX-License-Identifier: Apache-2.0

#include "rays/ray_directions.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>

#include "mesh/disjoint_sets.h"
#include "mesh/weld.h"
#include "rows/math.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

std::array<Vector3, 3> corners_of(const MeshPart& part, std::size_t triangle) {
    return Triangles::Triangle{part, triangle}.corners();
}

Vector3 face_normal(const std::array<Vector3, 3>& corners) {
    return normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
}

// Between a and b, 0 to pi; 0 if one of them has no length.
double angle_between(Vector3 a, Vector3 b) {
    const Vector3 normal = cross(a, b);
    const double y = std::sqrt(dot(normal, normal)), x = dot(a, b);
    if (x == 0.0) return y == 0.0 ? 0.0 : math::kPi / 2.0;
    return math::atan(y / x) + (x < 0.0 ? math::kPi : 0.0);
}

// Triangles that are so narrow that the rounding of their corners to float decides where they face, as at the poles of
// many spheres, have no normal: (0, 0, 0).
class FaceNormals {
public:
    explicit FaceNormals(const MeshPart& part) : part_(part) {
        double largest = 0.0;
        for (const std::uint32_t v : part.indices) {
            const Vector3 p = vector_of(part.positions[v]);
            largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        }
        least_height_ = kNarrow * largest;
    }

    [[nodiscard]] Vector3 of(std::size_t triangle) const {
        const auto corners = corners_of(part_, triangle);
        double longest = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector3 side = corners[(k + 1) % 3] - corners[k];
            longest = std::max(longest, dot(side, side));
        }
        const Vector3 area = cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (dot(area, area) <= least_height_ * least_height_ * longest) return {};
        return normalized(area);
    }

private:
    static constexpr double kNarrow = 0x1p-21;  // of the largest coordinate, which has 24 bits

    const MeshPart& part_;
    double least_height_ = 0.0;
};

// The part of a corner in the sum of the normals that meet there.
double weight_of_corner(const std::array<Vector3, 3>& corners, std::size_t k) {
    return angle_between(corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
}

// For each corner, the normalised sum over all corners with its number. Numbers are less than `count`.
std::vector<Vector3> averaged(const MeshPart& part, const std::vector<std::uint32_t>& number, std::size_t count) {
    std::vector<Vector3> sums(count), normals(number.size());
    const FaceNormals faces(part);
    for (std::size_t t = 0; t < part.triangles(); ++t) {
        const auto corners = corners_of(part, t);
        const Vector3 normal = faces.of(t);
        for (std::size_t k = 0; k < 3; ++k) {
            Vector3& sum = sums[number[3 * t + k]];
            sum = sum + weight_of_corner(corners, k) * normal;
        }
    }
    for (std::size_t c = 0; c < number.size(); ++c) normals[c] = normalized(sums[number[c]]);
    return normals;
}

// A side of a triangle, keyed by the numbers of its ends' positions.
struct Side {
    std::uint32_t low, high;
    std::uint32_t low_corner, high_corner;

    [[nodiscard]] auto key() const { return std::tuple(low, high); }
};

std::vector<Side> sorted_sides(const MeshPart& part, const std::vector<std::uint32_t>& position) {
    std::vector<Side> sides;
    sides.reserve(part.indices.size());
    for (std::uint32_t c = 0; c < part.indices.size(); ++c) {
        const std::uint32_t next = c % 3 == 2 ? c - 2 : c + 1;
        const std::uint32_t a = position[part.indices[c]], b = position[part.indices[next]];
        if (a < b) sides.push_back({a, b, c, next});
        if (b < a) sides.push_back({b, a, next, c});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tuple(a.key(), a.low_corner) < std::tuple(b.key(), b.low_corner);
    });
    return sides;
}

}  // namespace

// Joins corners across soft edges, and collects the hard ones.
void RayDirections::set_straight(const std::vector<std::uint32_t>& position, double angle) {
    const std::vector<Side> sides = sorted_sides(*part_, position);
    const double least_cosine = math::cos(angle * math::kPi / 180.0);
    const FaceNormals faces(*part_);
    DisjointSets sets(part_->indices.size());
    for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
        for (end = first; end < sides.size() && sides[end].key() == sides[first].key();) ++end;
        const Side &a = sides[first], &b = sides[end - 1];
        const Vector3 n = faces.of(a.low_corner / 3), m = faces.of(b.low_corner / 3);
        const bool no_angle = dot(n, n) == 0.0 || dot(m, m) == 0.0;
        if (end - first == 2 && (no_angle || dot(n, m) >= least_cosine)) {
            sets.join(a.low_corner, b.low_corner);
            sets.join(a.high_corner, b.high_corner);
            continue;
        }
        const auto vertex = static_cast<std::uint32_t>(hard_->positions.size());
        hard_->positions.push_back(part_->positions[part_->indices[a.low_corner]]);
        hard_->positions.push_back(part_->positions[part_->indices[a.high_corner]]);
        for (const std::uint32_t v : {vertex, vertex + 1, vertex + 1}) hard_->indices.push_back(v);
    }
    std::vector<std::uint32_t> group(part_->indices.size());
    for (std::uint32_t c = 0; c < group.size(); ++c) group[c] = sets.root(c);
    own_ = averaged(*part_, group, group.size());
}

Result<RayDirections> RayDirections::make(const MeshPart& part, RayMode mode, double width, double angle,
                                          const Execution& execution) {
    return no_throw([&]() -> Result<RayDirections> {
        RayDirections directions;
        directions.part_ = &part;
        directions.width_ = width;
        if (mode == RayMode::vertex) {
            for (const std::uint32_t v : part.indices)
                directions.normals_.push_back(normalized(vector_of(part.normals[v])));
            return directions;
        }
        const std::vector<std::uint32_t> position = numbered_positions(part);
        std::vector<std::uint32_t> of_corner(part.indices.size());
        for (std::size_t c = 0; c < of_corner.size(); ++c) of_corner[c] = position[part.indices[c]];
        directions.normals_ = averaged(part, of_corner, position.size());
        if (mode == RayMode::smooth) return directions;
        directions.set_straight(position, angle);
        if (directions.hard_->indices.empty()) return directions;
        auto tree = BoxTree::build(Triangles({directions.hard_.get()}), execution);
        if (!tree) return tree.error();
        directions.hard_tree_ = std::move(*tree);
        return directions;
    });
}

double RayDirections::straightness(Vector3 point, RayWork& work) const {
    if (!hard_tree_) return 1.0;
    const double most = width_ * width_;
    const NearestPoint nearest = hard_tree_->nearest(point, most);
    work.add(1, nearest.steps);
    const double part = std::sqrt(std::min(nearest.squared, most));
    const double t = width_ > 0.0 ? part / width_ : 1.0;
    return t * t * (3.0 - 2.0 * t);
}

Vector3 RayDirections::at(std::size_t triangle, const std::array<double, 3>& weights, Vector3 point,
                          RayWork& work) const {
    return skewed(triangle, weights, own_.empty() ? 0.0 : straightness(point, work));
}

void RayDirections::along(std::size_t triangle, VectorArrays<const double> weights, VectorArrays<const double> points,
                          std::size_t count, VectorArrays<double> directions, RayWork& work) const {
    CornerVectors corners;
    copy_to(of_corners(normals_, triangle), corners);
    if (own_.empty() && mix_directions(corners, weights, count, directions)) return;
    for (std::size_t k = 0; k < count && work.is_fair(); ++k) {
        const Vector3 direction =
            at(triangle, {weights.x[k], weights.y[k], weights.z[k]}, {points.x[k], points.y[k], points.z[k]}, work);
        directions.x[k] = direction.x;
        directions.y[k] = direction.y;
        directions.z[k] = direction.z;
    }
}

Vector3 RayDirections::skewed(std::size_t triangle, const std::array<double, 3>& weights, double k) const {
    const Vector3 smooth = normalized(mix(of_corners(normals_, triangle), weights));
    Vector3 direction = smooth;
    if (!own_.empty())
        direction = normalized((1.0 - k) * smooth + k * normalized(mix(of_corners(own_, triangle), weights)));
    if (dot(direction, direction) > 0.5) return direction;
    // Normals cancel out: the triangle's own, or any.
    const Vector3 face = face_normal(corners_of(*part_, triangle));
    return dot(face, face) > 0.5 ? face : Vector3{0.0, 0.0, 1.0};
}

}  // namespace tex::inline v1
