// SPDX-License-Identifier: Apache-2.0
// trace_boxes-inl.h: which boxes a ray meets, and the stack of those that wait.
//
// Compiled once for each Highway target, as part of trace.cpp.

#if defined(TEX_KERNELS_TRACE_BOXES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_TRACE_BOXES_INL_H
#undef TEX_KERNELS_TRACE_BOXES_INL_H
#else
#define TEX_KERNELS_TRACE_BOXES_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "kernels/trace.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using BoxTag = hn::CappedTag<float, kBoxes>;
constexpr int kBoxLanes = static_cast<int>(hn::MaxLanes(BoxTag()));

// A direction below this is taken for it: over the largest length that counts, 8 times the largest coordinate, the ray
// then moves by less than the slack.
constexpr double kLeastDirection = 1e-12;

// What the tests of boxes need, in the units of the tree.
struct BoxRay {
    float near_origin[3], far_origin[3], inverse[3];
    std::size_t near_row[3], far_row[3];  // of Boxes, whose rows are low x, y, z, high x, y, z
    float most;                           // the length beyond which boxes do not count
    double to_units;                      // from t to that length
    double end;                           // no box lies beyond

    // Boxes beyond t are passed over from now on.
    void shorten(double t) { most = static_cast<float>(std::min(end, t * to_units) * (1.0 + kBoxSlack)); }
};

// What the ray needs along an axis; `direction` is that of a vector of unit length.
HWY_INLINE void set_axis(int k, double origin, double direction, double slack, BoxRay& box) {
    const double away = std::max(std::abs(direction), kLeastDirection);
    const bool forward = !(direction < -kLeastDirection);
    if (!forward) slack = -slack;
    box.near_origin[k] = static_cast<float>(origin + slack);
    box.far_origin[k] = static_cast<float>(origin - slack);
    box.inverse[k] = static_cast<float>(forward ? 1.0 / away : -1.0 / away);
    box.near_row[k] = static_cast<std::size_t>(forward ? k : k + 3);
    box.far_row[k] = static_cast<std::size_t>(forward ? k + 3 : k);
}

// Returns false if the ray hits nothing.
HWY_INLINE bool prepare(const TreeView& tree, const Ray& ray, BoxRay& box) {
    double origin[3], largest = 1.0;
    for (int k = 0; k < 3; ++k) {
        origin[k] = (ray.origin[k] - tree.center[k]) * tree.scale;
        largest = std::max(largest, std::abs(origin[k]));
        if (!(std::abs(origin[k]) < 1e30)) return false;
    }
    for (int k = 0; k < 3; ++k) set_axis(k, origin[k], ray.direction[k], kBoxSlack * largest, box);
    box.end = 8.0 * largest;
    box.to_units = tree.scale;
    box.shorten(ray.length);
    return true;
}

// The children that the ray meets, as bits, and where it enters them.
HWY_INLINE unsigned boxes_met(const Boxes& boxes, const BoxRay& ray, float* enter) {
    const BoxTag d;
    const float* const rows = &boxes.low[0][0];
    unsigned met = 0;
    for (int k = 0; k < kBoxes; k += kBoxLanes) {
        auto near = hn::Zero(d), far = hn::Set(d, ray.most);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto inverse = hn::Set(d, ray.inverse[axis]);
            const auto low = hn::Load(d, rows + ray.near_row[axis] * kBoxes + k);
            const auto high = hn::Load(d, rows + ray.far_row[axis] * kBoxes + k);
            near = hn::Max(near, hn::Mul(hn::Sub(low, hn::Set(d, ray.near_origin[axis])), inverse));
            far = hn::Min(far, hn::Mul(hn::Sub(high, hn::Set(d, ray.far_origin[axis])), inverse));
        }
        hn::StoreU(near, d, enter + k);
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(d, hn::Le(near, far), bits);
        met |= static_cast<unsigned>(bits[0]) << k;
    }
    return met;
}

// Where the ray enters a child.
struct Waiting {
    float enter;
    std::uint32_t child;
};

// Adds the children that are met, the nearest one last: child_of(k) is what the k-th is called.
template <class ChildOf>
HWY_INLINE Waiting* push(unsigned met, const float* enter, Waiting* top, const ChildOf& child_of) {
    Waiting* const first = top;
    for (; met != 0; met &= met - 1) {
        const int k = std::countr_zero(met);
        Waiting* place = top++;
        for (; place > first && place[-1].enter < enter[k]; --place) *place = place[-1];
        *place = {enter[k], child_of(k)};
    }
    return top;
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif
