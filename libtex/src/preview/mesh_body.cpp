// SPDX-License-Identifier: Apache-2.0

#include "preview/mesh_body.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mesh/frames.h"

namespace tex::inline v1::render {
namespace {

using Weights = std::array<double, 3>;

Vec3 vec(const Float3& p) { return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)}; }
Vec3 vec(const Vector3& v) { return {v.x, v.y, v.z}; }

// The point of the triangle's plane on the ray, as weights of the corners (Moeller, Trumbore 1997). Nothing if the ray
// does not meet the plane in front of the viewer.
struct Crossing {
    Weights weights{};
    double distance = 0.0;
};

std::optional<Crossing> cross_plane(const std::array<Vec3, 3>& corners, const Ray& ray) {
    const Vec3 e = corners[1] - corners[0], f = corners[2] - corners[0];
    const Vec3 p = cross(ray.direction, f);
    const double det = dot(e, p);
    if (det == 0.0) return std::nullopt;
    const Vec3 s = ray.origin - corners[0], q = cross(s, e);
    const double b = dot(s, p) / det, c = dot(ray.direction, q) / det, distance = dot(f, q) / det;
    if (!(distance > 0.0) || !std::isfinite(b) || !std::isfinite(c)) return std::nullopt;
    return Crossing{{1.0 - b - c, b, c}, distance};
}

// Rounding moves the edges of triangles, so a sample of a triangle may lie slightly beside it.
Weights inside(Weights weights) {
    double sum = 0.0;
    for (double& w : weights) {
        w = w > 0.0 ? w : 0.0;
        sum += w;
    }
    if (!(sum > 0.0)) return {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
    for (double& w : weights) w /= sum;
    return weights;
}

template <class T>
T mix(const std::array<T, 3>& values, const Weights& weights) {
    return values[0] * weights[0] + values[1] * weights[1] + values[2] * weights[2];
}

// The change of (u, v) from here to the next pixel, from whichever neighbour meets the plane.
Vec2 uv_change(const std::array<Vec3, 3>& corners, const std::array<Vec2, 3>& uvs, Vec2 here, const Ray& next,
               const Ray& previous) {
    if (const auto ahead = cross_plane(corners, next)) return mix(uvs, ahead->weights) - here;
    if (const auto behind = cross_plane(corners, previous)) return here - mix(uvs, behind->weights);
    return {};
}

}  // namespace

MeshBody::MeshBody(const TangentSpace& space) : space_(space) {
    const MeshPart& part = space.part;
    Vec3 low = vec(part.positions[part.indices.front()]), high = low;
    for (const std::uint32_t v : part.indices) {
        const Vec3 p = vec(part.positions[v]);
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    centre_ = (low + high) * 0.5;
    double farthest = 0.0;
    for (const std::uint32_t v : part.indices) {
        const Vec3 way = vec(part.positions[v]) - centre_;
        farthest = std::max(farthest, dot(way, way));
    }
    if (farthest > 0.0) scale_ = 1.0 / std::sqrt(farthest);
}

Vec3 MeshBody::place(std::size_t vertex) const { return (vec(space_.part.positions[vertex]) - centre_) * scale_; }

std::array<Vec3, 3> MeshBody::corners(std::size_t triangle) const {
    const std::uint32_t* v = space_.part.indices.data() + 3 * triangle;
    return {place(v[0]), place(v[1]), place(v[2])};
}

std::array<Vec2, 3> MeshBody::uvs(std::size_t triangle) const {
    const std::vector<Float2>& set = space_.part.uvs[static_cast<std::size_t>(space_.uv_set)];
    std::array<Vec2, 3> found;
    for (std::size_t k = 0; k < 3; ++k) {
        const Float2& uv = set[space_.part.indices[3 * triangle + k]];
        const auto v = static_cast<double>(uv.y);
        found[k] = {static_cast<double>(uv.x), space_.part.v_axis == YAxis::down ? 1.0 - v : v};
    }
    return found;
}

bool MeshBody::faces(std::size_t triangle, const View& view) const {
    const auto [a, b, c] = corners(triangle);
    return dot(cross(b - a, c - a), view.towards_viewer(a)) > 0.0;
}

MeshHit MeshBody::meet(std::size_t triangle, const View& view, double x, double y) const {
    const std::array<Vec3, 3> places = corners(triangle);
    const std::array<Vec2, 3> uv = uvs(triangle);
    const auto crossing = cross_plane(places, view.ray(x, y));
    const Weights weights = inside(crossing ? crossing->weights : Weights{});
    const Frame frame = CornerFrames(space_, triangle).at(weights);
    MeshHit found;
    found.hit.point = mix(places, weights);
    found.hit.tangent = vec(frame.t);
    found.hit.binormal = vec(frame.b);
    found.hit.normal = vec(frame.n);
    found.hit.uv = mix(uv, weights);
    if (!crossing) return found;
    const Vec2 here = mix(uv, crossing->weights);
    found.footprint.dx = uv_change(places, uv, here, view.ray(x + 1.0, y), view.ray(x - 1.0, y));
    found.footprint.dy = uv_change(places, uv, here, view.ray(x, y + 1.0), view.ray(x, y - 1.0));
    return found;
}

}  // namespace tex::inline v1::render
