// SPDX-License-Identifier: Apache-2.0

#include "preview/shapes.h"

#include <algorithm>
#include <cmath>

namespace tex::inline v1::render {
namespace {

constexpr double kHalfEdge = 0.7;  // half the edge of the cube
constexpr double kMissed = -1.0;

// Outward normal and direction of u of the cube's faces 1 to 6: +x, -x, +y, -y, +z, -z. v is cross(normal, u).
struct CubeFace {
    Vec3 normal, u;
};
constexpr CubeFace kCubeFaces[6] = {
    {{1, 0, 0}, {0, 0, -1}}, {{-1, 0, 0}, {0, 0, 1}}, {{0, 1, 0}, {1, 0, 0}},
    {{0, -1, 0}, {1, 0, 0}}, {{0, 0, 1}, {1, 0, 0}},  {{0, 0, -1}, {-1, 0, 0}},
};

double meet_plane(const Ray& ray, double half_width) {
    const double t = -ray.origin.z / ray.direction.z;
    if (!(t > 0.0) || !(ray.direction.z < 0.0)) return kMissed;  // the back of the plane is not visible
    const Vec3 p = ray.origin + ray.direction * t;
    // A small tolerance: the picture's own edge pixels belong to the plane.
    return std::abs(p.x) <= half_width + 1e-9 && std::abs(p.y) <= 1.0 + 1e-9 ? t : kMissed;
}

double meet_sphere(const Ray& ray) {
    const double a = dot(ray.direction, ray.direction);
    const double b = dot(ray.origin, ray.direction);
    const double c = dot(ray.origin, ray.origin) - 1.0;
    const double root = b * b - a * c;
    if (!(root >= 0.0)) return kMissed;
    return (-b - std::sqrt(root)) / a;
}

// The slab method (Kay, Kajiya 1986). Remembers the face through which the ray enters.
double meet_cube(const Ray& ray, int& face) {
    const double origin[3] = {ray.origin.x, ray.origin.y, ray.origin.z};
    const double direction[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
    double enter = -1e300, leave = 1e300;
    for (int axis = 0; axis < 3; ++axis) {
        const double o = origin[axis], d = direction[axis];
        if (d == 0.0) {
            if (std::abs(o) > kHalfEdge) return kMissed;
            continue;
        }
        const double near = (d < 0.0 ? kHalfEdge - o : -kHalfEdge - o) / d;
        const double far = (d < 0.0 ? -kHalfEdge - o : kHalfEdge - o) / d;
        if (near > enter) {
            enter = near;
            face = 1 + 2 * axis + (d < 0.0 ? 0 : 1);
        }
        leave = std::min(leave, far);
    }
    return enter <= leave && enter > 0.0 ? enter : kMissed;
}

}  // namespace

Body::Body(const PreviewOptions& options, Extent map) : shape_(options.shape), mirror_(options.mirror) {
    const double proportion = static_cast<double>(map.width) / map.height;
    if (shape_ == Shape::plane) {
        u_turns_ = options.tiles_x;
        v_turns_ = options.tiles_y;
        half_width_ = proportion * options.tiles_x / options.tiles_y;
    } else if (shape_ == Shape::sphere) {
        u_turns_ = std::max(1.0, std::floor(2.0 / proportion + 0.5));
    }
}

double Body::support(Vec3 d) const {
    constexpr double kMargin = 1.06;
    const double level = std::sqrt(d.x * d.x + d.z * d.z);
    switch (shape_) {
        case Shape::plane: return half_width_ * std::abs(d.x) + std::abs(d.y);
        case Shape::sphere: return kMargin * length(d);
        case Shape::cube: return kMargin * kHalfEdge * (std::sqrt(2.0) * level + std::abs(d.y));
    }
    return 1.0;
}

double Body::distance(const Ray& ray, int& face) const {
    face = 1;
    switch (shape_) {
        case Shape::plane: return meet_plane(ray, half_width_);
        case Shape::sphere: return meet_sphere(ray);
        case Shape::cube: return meet_cube(ray, face);
    }
    return kMissed;
}

int Body::face(const Ray& ray) const {
    int face = 0;
    return distance(ray, face) > 0.0 ? face : 0;
}

std::optional<Hit> Body::meet(const Ray& ray) const {
    int face = 0;
    const double t = distance(ray, face);
    if (!(t > 0.0)) return std::nullopt;
    const Vec3 point = ray.origin + ray.direction * t;
    Hit hit = shape_ == Shape::plane    ? on_plane(point)
              : shape_ == Shape::sphere ? on_sphere(point)
                                        : on_cube(point, face);
    hit.face = face;
    double w = 1.0;
    if (mirror_) {
        // u grows in the other direction, so the tangent is reversed. cross(N, T) then points against growing v; w
        // corrects that.
        hit.uv.x = -hit.uv.x;
        hit.tangent = hit.tangent * -1.0;
        w = -1.0;
    }
    hit.binormal = cross(hit.normal, hit.tangent) * w;
    return hit;
}

Hit Body::on_plane(Vec3 point) const {
    Hit hit;
    hit.point = point;
    hit.normal = {0.0, 0.0, 1.0};
    hit.tangent = {1.0, 0.0, 0.0};
    hit.u_per_length = u_turns_ / (2.0 * half_width_);
    hit.v_per_length = v_turns_ / 2.0;
    hit.uv = {(point.x + half_width_) * hit.u_per_length, (point.y + 1.0) * hit.v_per_length};
    return hit;
}

Hit Body::on_sphere(Vec3 point) const {
    Hit hit;
    hit.point = point;
    hit.normal = normalize(point);
    const double around = std::sqrt(hit.normal.x * hit.normal.x + hit.normal.z * hit.normal.z);
    // East. At the poles, where every direction is south or north, any direction will do.
    hit.tangent = around > 1e-9 ? Vec3{hit.normal.z / around, 0.0, -hit.normal.x / around} : Vec3{1.0, 0.0, 0.0};
    hit.u_per_length = u_turns_ / (2.0 * math::kPi * std::max(around, 1e-4));
    hit.v_per_length = 1.0 / math::kPi;
    hit.uv = {0.5 + u_turns_ * angle_of(hit.normal.x, hit.normal.z) / (2.0 * math::kPi),
              0.5 + angle_of(hit.normal.y, around) / math::kPi};
    return hit;
}

Hit Body::on_cube(Vec3 point, int face) const {
    const CubeFace& side = kCubeFaces[face - 1];
    Hit hit;
    hit.point = point;
    hit.normal = side.normal;
    hit.tangent = side.u;
    hit.u_per_length = hit.v_per_length = 1.0 / (2.0 * kHalfEdge);
    hit.uv = {0.5 + dot(point, side.u) * hit.u_per_length,
              0.5 + dot(point, cross(side.normal, side.u)) * hit.v_per_length};
    return hit;
}

Vec2 uv_step(const Hit& hit, const Ray& ray) {
    const double falls = dot(ray.direction, hit.normal);
    if (!(falls < 0.0)) return {};
    const double t = dot(hit.point - ray.origin, hit.normal) / falls;
    const Vec3 step = ray.origin + ray.direction * t - hit.point;
    return {dot(step, hit.tangent) * hit.u_per_length, dot(step, hit.binormal) * hit.v_per_length};
}

}  // namespace tex::inline v1::render
