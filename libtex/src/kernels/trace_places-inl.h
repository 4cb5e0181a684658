// SPDX-License-Identifier: Apache-2.0
// trace_places-inl.h: a ray in a tree that stands somewhere else (PlacedTree).
//
// Compiled once for each Highway target, as part of trace.cpp.

#if defined(TEX_KERNELS_TRACE_PLACES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_TRACE_PLACES_INL_H
#undef TEX_KERNELS_TRACE_PLACES_INL_H
#else
#define TEX_KERNELS_TRACE_PLACES_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "kernels/trace.h"
#include "kernels/trace_boxes-inl.h"
#include "kernels/trace_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The groups of a tree, where they are stored.
class StoredGroups {
public:
    explicit StoredGroups(const TreeView& tree) : groups_(tree.groups) {}
    explicit StoredGroups(const PlacedTree& place) : groups_(place.tree.groups) {}

    HWY_INLINE const TriangleGroup& at(std::uint32_t k) { return groups_[k]; }

private:
    const TriangleGroup* groups_;
};

// The groups of a tree where they stand. The reference is good until the next one.
class PlacedGroups {
public:
    explicit PlacedGroups(const PlacedTree& place) : place_(place) {}

    // The operations of NodeTransform::position() (mesh/node_transform.h), in its order.
    HWY_INLINE const TriangleGroup& at(std::uint32_t k) {
        const EdgeTag d;
        const CornerTag f;
        const TriangleGroup& from = place_.tree.groups[k];
        for (int corner = 0; corner < 3; ++corner) {
            auto& to = moved_.at[place_.is_mirrored && corner > 0 ? 3 - corner : corner];
            for (int first = 0; first < kGroupTriangles; first += kEdgeLanes) {
                const auto x = hn::PromoteTo(d, hn::LoadU(f, from.at[corner][0] + first)),
                           y = hn::PromoteTo(d, hn::LoadU(f, from.at[corner][1] + first)),
                           z = hn::PromoteTo(d, hn::LoadU(f, from.at[corner][2] + first));
                for (int axis = 0; axis < 3; ++axis) {
                    const double* const row = place_.to_scene[axis];
                    const auto sum = hn::Add(hn::Add(hn::Mul(hn::Set(d, row[0]), x), hn::Mul(hn::Set(d, row[1]), y)),
                                             hn::Mul(hn::Set(d, row[2]), z));
                    hn::StoreU(hn::DemoteTo(f, hn::Add(sum, hn::Set(d, row[3]))), f, to[axis] + first);
                }
            }
        }
        for (int t = 0; t < kGroupTriangles; ++t)
            moved_.triangle[t] = from.triangle[t] == kNoHit ? kNoHit : place_.first + from.triangle[t];
        return moved_;
    }

private:
    const PlacedTree& place_;
    TriangleGroup moved_;
};

// Along an axis on which rounding moves corners by more than this, in the units of the tree, all boxes count: the mesh
// is flat there. Such an axis is left out of the direction, so that the others stay exact.
constexpr double kMostSlack = 4.0;
// What double loses on the way to the space of the mesh, as a part of the largest number on it.
constexpr double kWayRounding = 0x1p-46;

// prepare() for the space of the mesh. `most`: as Ray::length. Lengths t stay those of the ray.
HWY_INLINE bool prepare(const PlacedTree& place, const Ray& ray, double most, BoxRay& box) {
    const TreeView& tree = place.tree;
    if (place.is_plain) {
        const bool may_hit = prepare(tree, ray, box);
        if (may_hit) box.shorten(most);
        return may_hit;
    }
    double origin[3], direction[3], slack[3], largest = 1.0, squared = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double* const row = place.to_mesh[k];
        double at = 0.0, rounding = 0.0;
        direction[k] = 0.0;
        for (int j = 0; j < 3; ++j) {
            at += row[j] * (ray.origin[j] - place.to_scene[j][3]);
            rounding += std::abs(row[j] * ray.origin[j]);
            direction[k] += row[j] * ray.direction[j];
        }
        origin[k] = (at - tree.center[k]) * tree.scale;
        slack[k] = (place.slack[k] + kWayRounding * rounding) * tree.scale;
        if (!(slack[k] < kMostSlack)) {
            origin[k] = direction[k] = 0.0;
            slack[k] = kMostSlack;
        }
        if (!(std::abs(origin[k]) < 1e30)) return false;
        largest = std::max(largest, std::abs(origin[k]) + slack[k]);
        squared += direction[k] * direction[k];
    }
    const double length = std::sqrt(squared), shorter = length > 0.0 ? 1.0 / length : 0.0;
    for (int k = 0; k < 3; ++k) set_axis(k, origin[k], shorter * direction[k], slack[k] + kBoxSlack * largest, box);
    box.end = 8.0 * largest;
    box.to_units = tree.scale * length;
    box.shorten(most);
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif
