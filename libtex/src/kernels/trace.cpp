// SPDX-License-Identifier: Apache-2.0

#include "kernels/trace.h"

#include <algorithm>
#include <bit>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/trace.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using BoxTag = hn::CappedTag<float, kBoxes>;
using EdgeTag = hn::CappedTag<double, kGroupTriangles>;
using CornerTag = hn::Rebind<float, EdgeTag>;
constexpr int kBoxLanes = static_cast<int>(hn::MaxLanes(BoxTag()));
constexpr int kEdgeLanes = static_cast<int>(hn::MaxLanes(EdgeTag()));

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

// Returns false if the ray hits nothing.
HWY_INLINE bool prepare(const TreeView& tree, const Ray& ray, BoxRay& box) {
    double origin[3], largest = 1.0;
    for (int k = 0; k < 3; ++k) {
        origin[k] = (ray.origin[k] - tree.center[k]) * tree.scale;
        largest = std::max(largest, std::abs(origin[k]));
        if (!(std::abs(origin[k]) < 1e30)) return false;
    }
    for (int k = 0; k < 3; ++k) {
        const double d = ray.direction[k];
        const double away = std::max(std::abs(d), kLeastDirection);
        const bool forward = !(d < -kLeastDirection);
        const double slack = forward ? kBoxSlack * largest : -kBoxSlack * largest;
        box.near_origin[k] = static_cast<float>(origin[k] + slack);
        box.far_origin[k] = static_cast<float>(origin[k] - slack);
        box.inverse[k] = static_cast<float>(forward ? 1.0 / away : -1.0 / away);
        box.near_row[k] = static_cast<std::size_t>(forward ? k : k + 3);
        box.far_row[k] = static_cast<std::size_t>(forward ? k + 3 : k);
    }
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
        HWY_ALIGN double ts[kGroupTriangles], us[kGroupTriangles], vs[kGroupTriangles], ws[kGroupTriangles];
        hn::Store(hn::IfThenElse(inside, t, hn::Set(d, -1.0)), d, ts);
        hn::Store(hn::Div(u, area), d, us);
        hn::Store(hn::Div(v, area), d, vs);
        hn::Store(hn::Div(w, area), d, ws);
        for (int k = 0; k < kEdgeLanes; ++k) {
            const std::uint32_t triangle = group.triangle[first + k];
            if (ts[k] < 0.0 || !is_nearer(ts[k], triangle, hit)) continue;
            hit = {ts[k], {us[k], vs[k], ws[k]}, triangle};
            found = true;
        }
    }
    return found;
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

// Finds the nearest hit, or with kAny any. Precondition: hit.t is the length of the ray if nothing was hit before.
template <bool kAny>
HWY_INLINE void search(const TreeView& tree, const Ray& ray, const EdgeRay& edge, BoxRay& box, RayHit& hit) {
    Waiting stack[(kBoxes - 1) * kMostLevels + kBoxes + 1];
    Waiting* top = stack;
    *top++ = {0.0f, 0};
    while (top > stack) {
        const Waiting next = *--top;
        if (next.enter > box.most) continue;
        if ((next.child & kGroupBit) != 0) {
            if (!hit_group(tree.groups[next.child & ~kGroupBit], ray, edge, hit)) continue;
            if (kAny) return;
            box.shorten(hit.t);
            continue;
        }
        float enter[kBoxes];
        const unsigned met = boxes_met(tree.boxes[next.child], box, enter);
        top = push(met, enter, top, [&](int k) HWY_ATTR { return tree.boxes[next.child].child[k]; });
    }
}

template <bool kAny>
HWY_INLINE RayHit trace(const TreeView& tree, const Ray& ray) {
    RayHit hit;
    BoxRay box;
    if (!prepare(tree, ray, box)) return hit;
    hit.t = ray.length;
    search<kAny>(tree, ray, sheared(ray), box, hit);
    if (hit.triangle == kNoHit) hit.t = 0.0;
    return hit;
}

// Rays that go through the tree together. A box counts if it may meet any of them: its distances are those of the ray
// whose origin and direction would be the extremes of theirs, along each axis by itself. As rounding keeps order, no
// box is passed over that one of them meets. A group of triangles is tested with those rays that meet its own box.
constexpr int kPacket = kBoxes;
constexpr std::size_t kCacheLine = 64;
// Rays that meet more boxes than this have little in common, and go on alone.
constexpr int kMostBoxes = 64;

struct Packet {
    HWY_ALIGN float near_origin[3][kPacket], far_origin[3][kPacket], inverse[3][kPacket], most[kPacket];
    float first_origin[3], last_origin[3], least_inverse[3], most_inverse[3];  // the extremes
    std::size_t near_row[3], far_row[3];
    float longest;  // the largest of `most`

    void shorten(int k, float length) {
        most[k] = length;
        longest = *std::max_element(most, most + kPacket);
    }
};

// Returns false if they go to different sides along an axis.
HWY_INLINE bool gather(const BoxRay* rays, Packet& packet) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t near_row = rays[0].near_row[axis];
        const bool forward = near_row == axis;
        float first = rays[0].near_origin[axis], last = rays[0].far_origin[axis];
        float least = rays[0].inverse[axis], most = least;
        for (int k = 0; k < kPacket; ++k) {
            if (rays[k].near_row[axis] != near_row) return false;
            const float near = rays[k].near_origin[axis], far = rays[k].far_origin[axis],
                        inverse = rays[k].inverse[axis];
            packet.near_origin[axis][k] = near;
            packet.far_origin[axis][k] = far;
            packet.inverse[axis][k] = inverse;
            first = forward ? std::max(first, near) : std::min(first, near);
            last = forward ? std::min(last, far) : std::max(last, far);
            least = std::min(least, inverse);
            most = std::max(most, inverse);
        }
        packet.first_origin[axis] = first;
        packet.last_origin[axis] = last;
        packet.least_inverse[axis] = least;
        packet.most_inverse[axis] = most;
        packet.near_row[axis] = near_row;
        packet.far_row[axis] = rays[0].far_row[axis];
    }
    for (int k = 0; k < kPacket; ++k) packet.most[k] = rays[k].most;
    packet.longest = *std::max_element(packet.most, packet.most + kPacket);
    return true;
}

// The children that any of the rays may meet, as bits, and a distance before which none of them enters.
HWY_INLINE unsigned boxes_met(const Boxes& boxes, const Packet& rays, float* enter) {
    const BoxTag d;
    const float* const rows = &boxes.low[0][0];
    unsigned met = 0;
    for (int k = 0; k < kBoxes; k += kBoxLanes) {
        auto near = hn::Zero(d), far = hn::Set(d, rays.longest);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto least = hn::Set(d, rays.least_inverse[axis]), most = hn::Set(d, rays.most_inverse[axis]);
            const auto low =
                hn::Sub(hn::Load(d, rows + rays.near_row[axis] * kBoxes + k), hn::Set(d, rays.first_origin[axis]));
            const auto high =
                hn::Sub(hn::Load(d, rows + rays.far_row[axis] * kBoxes + k), hn::Set(d, rays.last_origin[axis]));
            near = hn::Max(near, hn::Min(hn::Mul(low, least), hn::Mul(low, most)));
            far = hn::Min(far, hn::Max(hn::Mul(high, least), hn::Mul(high, most)));
        }
        hn::StoreU(near, d, enter + k);
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(d, hn::Le(near, far), bits);
        met |= static_cast<unsigned>(bits[0]) << k;
    }
    return met;
}

// The rays that meet a child, as bits.
HWY_INLINE unsigned rays_meeting(const Boxes& boxes, std::size_t child, const Packet& rays) {
    const BoxTag d;
    const float* const rows = &boxes.low[0][0];
    unsigned meeting = 0;
    for (int k = 0; k < kPacket; k += kBoxLanes) {
        auto near = hn::Zero(d), far = hn::Load(d, rays.most + k);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto inverse = hn::Load(d, rays.inverse[axis] + k);
            const auto low = hn::Set(d, rows[rays.near_row[axis] * kBoxes + child]),
                       high = hn::Set(d, rows[rays.far_row[axis] * kBoxes + child]);
            near = hn::Max(near, hn::Mul(hn::Sub(low, hn::Load(d, rays.near_origin[axis] + k)), inverse));
            far = hn::Min(far, hn::Mul(hn::Sub(high, hn::Load(d, rays.far_origin[axis] + k)), inverse));
        }
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(d, hn::Le(near, far), bits);
        meeting |= static_cast<unsigned>(bits[0]) << k;
    }
    return meeting;
}

// Loads what the rays come to next.
HWY_INLINE void prefetch(const TreeView& tree, const Boxes& boxes, unsigned met) {
    for (; met != 0; met &= met - 1) {
        const std::uint32_t child = boxes.child[std::countr_zero(met)];
        const bool is_group = (child & kGroupBit) != 0;
        const auto* const first = is_group ? reinterpret_cast<const char*>(tree.groups + (child & ~kGroupBit))
                                           : reinterpret_cast<const char*>(tree.boxes + child);
        const std::size_t size = is_group ? sizeof(TriangleGroup) : sizeof(Boxes);
        for (std::size_t at = 0; at < size; at += kCacheLine) hwy::Prefetch(first + at);
    }
}

// Returns false if the rays have too little in common; then some of their hits are still to be found.
HWY_INLINE bool search_together(const TreeView& tree, const Ray* rays, const EdgeRay* edges, BoxRay* boxes,
                                Packet& packet, RayHit* hits) {
    // Children of boxes: eight times the index of a box and the number of a child. The tree itself is one.
    Waiting stack[(kBoxes - 1) * kMostLevels + kBoxes + 1];
    Waiting* top = stack;
    const auto open = [&](std::uint32_t index) HWY_ATTR {
        float enter[kBoxes];
        const unsigned met = boxes_met(tree.boxes[index], packet, enter);
        prefetch(tree, tree.boxes[index], met);
        top = push(met, enter, top, [&](int k) HWY_ATTR { return kBoxes * index + static_cast<std::uint32_t>(k); });
    };
    open(0);
    for (int opened = 0; top > stack;) {
        const Waiting next = *--top;
        if (next.enter > packet.longest) continue;
        const Boxes& parent = tree.boxes[next.child / kBoxes];
        const std::uint32_t child = parent.child[next.child % kBoxes];
        if ((child & kGroupBit) == 0) {
            if (++opened > kMostBoxes) return false;
            open(child);
            continue;
        }
        const TriangleGroup& group = tree.groups[child & ~kGroupBit];
        for (unsigned meeting = rays_meeting(parent, next.child % kBoxes, packet); meeting != 0;
             meeting &= meeting - 1) {
            const int k = std::countr_zero(meeting);
            if (!hit_group(group, rays[k], edges[k], hits[k])) continue;
            boxes[k].shorten(hits[k].t);
            packet.shorten(k, boxes[k].most);
        }
    }
    return true;
}

// Returns whether the rays went together.
HWY_INLINE bool trace_packet(const TreeView& tree, const Ray* rays, RayHit* hits) {
    BoxRay boxes[kPacket];
    EdgeRay edges[kPacket];
    Packet packet;
    for (int k = 0; k < kPacket; ++k) {
        if (!prepare(tree, rays[k], boxes[k])) return false;
    }
    if (!gather(boxes, packet)) return false;
    for (int k = 0; k < kPacket; ++k) {
        edges[k] = sheared(rays[k]);
        hits[k] = {};
        hits[k].t = rays[k].length;
    }
    const bool together = search_together(tree, rays, edges, boxes, packet, hits);
    for (int k = 0; k < kPacket; ++k) {
        if (!together) search<false>(tree, rays[k], edges[k], boxes[k], hits[k]);
        if (hits[k].triangle == kNoHit) hits[k].t = 0.0;
    }
    return true;
}

void TraceRays(const TreeView& tree, const Ray* rays, std::size_t count, RayHit* hits) {
    std::size_t k = 0;
    while (k < count) {
        if (count - k >= kPacket && trace_packet(tree, rays + k, hits + k)) {
            k += kPacket;
            continue;
        }
        for (const std::size_t end = std::min(count, k + kPacket); k < end; ++k) hits[k] = trace<false>(tree, rays[k]);
    }
}

void FindBlocked(const TreeView& tree, const Ray* rays, std::size_t count, std::uint8_t* blocked) {
    for (std::size_t k = 0; k < count; ++k) blocked[k] = trace<true>(tree, rays[k]).triangle != kNoHit ? 1 : 0;
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

HWY_EXPORT(TraceRays);
HWY_EXPORT(FindBlocked);

void trace_rays(const TreeView& tree, const Ray* rays, std::size_t count, RayHit* hits) {
    HWY_DYNAMIC_DISPATCH(TraceRays)(tree, rays, count, hits);
}

void find_blocked(const TreeView& tree, const Ray* rays, std::size_t count, std::uint8_t* blocked) {
    HWY_DYNAMIC_DISPATCH(FindBlocked)(tree, rays, count, blocked);
}

}  // namespace tex::inline v1
#endif  // HWY_ONCE
