// SPDX-License-Identifier: Apache-2.0
// trace_triangles-inl.h: where a ray hits the triangles of a group.
//
// Compiled once for each Highway target, as part of trace.cpp.

#if defined(TEX_KERNELS_TRACE_TRIANGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_TRACE_TRIANGLES_INL_H
#undef TEX_KERNELS_TRACE_TRIANGLES_INL_H
#else
#define TEX_KERNELS_TRACE_TRIANGLES_INL_H
#endif

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <hwy/highway.h>

#include "kernels/trace.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using EdgeTag = hn::CappedTag<double, kGroupTriangles>;
using CornerTag = hn::Rebind<float, EdgeTag>;
constexpr int kEdgeLanes = static_cast<int>(hn::MaxLanes(EdgeTag()));

// The ray as the tests of triangles need it: the axis along which it is longest becomes z, and is sheared to (0, 0, 1).
struct EdgeRay {
    std::size_t x, y, z;
    double shear_x, shear_y, shear_z;
};

HWY_INLINE EdgeRay sheared(const Ray& ray) {
    const double* const d = ray.direction;
    EdgeRay edge{};
    for (std::size_t k = 1; k < 3; ++k) {
        if (std::abs(d[k]) > std::abs(d[edge.z])) edge.z = k;
    }
    edge.x = (edge.z + 1) % 3;
    edge.y = (edge.x + 1) % 3;
    if (d[edge.z] < 0.0) std::swap(edge.x, edge.y);  // keeps the direction in which triangles turn
    edge.shear_x = d[edge.x] / d[edge.z];
    edge.shear_y = d[edge.y] / d[edge.z];
    edge.shear_z = 1.0 / d[edge.z];
    return edge;
}

using EdgeVec = hn::Vec<EdgeTag>;
struct Corner {
    EdgeVec x, y, z;
};

HWY_INLINE Corner corner_at(const float (*at)[kGroupTriangles], int first, const Ray& ray, const EdgeRay& edge) {
    const EdgeTag d;
    const CornerTag f;
    const auto along = [&](std::size_t axis) HWY_ATTR {
        return hn::Sub(hn::PromoteTo(d, hn::LoadU(f, at[axis] + first)), hn::Set(d, ray.origin[axis]));
    };
    const EdgeVec z = along(edge.z);
    return {hn::Sub(along(edge.x), hn::Mul(hn::Set(d, edge.shear_x), z)),
            hn::Sub(along(edge.y), hn::Mul(hn::Set(d, edge.shear_y), z)), hn::Mul(hn::Set(d, edge.shear_z), z)};
}

// Twice the area of the origin and two corners; exactly the negative if they change places.
HWY_INLINE EdgeVec side(const Corner& a, const Corner& b) { return hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x)); }

HWY_INLINE bool is_nearer(double t, std::uint32_t triangle, const RayHit& hit) {
    return t < hit.t || (t == hit.t && triangle < hit.triangle);
}

// Precondition: hit.t is the length of the ray if nothing was hit before.
HWY_INLINE bool hit_group(const TriangleGroup& group, const Ray& ray, const EdgeRay& edge, RayHit& hit) {
    const EdgeTag d;
    const auto zero = hn::Zero(d);
    bool found = false;
    for (int first = 0; first < kGroupTriangles; first += kEdgeLanes) {
        const Corner a = corner_at(group.at[0], first, ray, edge), b = corner_at(group.at[1], first, ray, edge),
                     c = corner_at(group.at[2], first, ray, edge);
        const EdgeVec u = side(c, b), v = side(a, c), w = side(b, a);
        const EdgeVec least = hn::Min(hn::Min(u, v), w), most = hn::Max(hn::Max(u, v), w);
        const EdgeVec area = hn::Add(hn::Add(u, v), w);
        auto inside = hn::Ne(area, zero);
        const auto front = hn::Ge(least, zero), back = hn::Le(most, zero);
        if (ray.facing == Facing::both)
            inside = hn::And(inside, hn::Or(front, back));
        else
            inside = hn::And(inside, ray.facing == Facing::front ? front : back);
        // NaN is neither equal nor less.
        inside = hn::And(inside, hn::Eq(area, area));
        if (hn::AllFalse(d, inside)) continue;
        const EdgeVec sum = hn::Add(hn::Add(hn::Mul(u, a.z), hn::Mul(v, b.z)), hn::Mul(w, c.z));
        const EdgeVec t = hn::Div(sum, area);
        inside = hn::And(inside, hn::And(hn::Ge(t, zero), hn::Le(t, hn::Set(d, hit.t))));
        if (hn::AllFalse(d, inside)) continue;
        HWY_ALIGN double ts[kGroupTriangles], us[kGroupTriangles], vs[kGroupTriangles], ws[kGroupTriangles],
            areas[kGroupTriangles];
        hn::Store(t, d, ts);
        hn::Store(u, d, us);
        hn::Store(v, d, vs);
        hn::Store(w, d, ws);
        hn::Store(area, d, areas);
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(d, inside, bits);
        for (unsigned lanes = bits[0]; lanes != 0; lanes &= lanes - 1) {
            const int k = std::countr_zero(lanes);
            const std::uint32_t triangle = group.triangle[first + k];
            if (!is_nearer(ts[k], triangle, hit)) continue;
            hit = {ts[k], {us[k] / areas[k], vs[k] / areas[k], ws[k] / areas[k]}, triangle};
            found = true;
        }
    }
    return found;
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif
