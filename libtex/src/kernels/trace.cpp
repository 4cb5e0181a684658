// SPDX-License-Identifier: Apache-2.0

#include "kernels/trace.h"

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/trace.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"
#include "kernels/trace_boxes-inl.h"
#include "kernels/trace_packet-inl.h"
#include "kernels/trace_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Finds the nearest hit, or with kAny any. Returns the steps. Precondition: hit.t is the length of the ray if nothing
// was hit before.
template <bool kAny>
HWY_INLINE std::int64_t search(const TreeView& tree, const Ray& ray, const EdgeRay& edge, BoxRay& box, RayHit& hit) {
    Waiting stack[(kBoxes - 1) * kMostLevels + kBoxes + 1];
    Waiting* top = stack;
    *top++ = {0.0f, 0};
    std::int64_t steps = 0;
    while (top > stack) {
        const Waiting next = *--top;
        if (next.enter > box.most) continue;
        ++steps;
        if ((next.child & kGroupBit) != 0) {
            if (!hit_group(tree.groups[next.child & ~kGroupBit], ray, edge, hit)) continue;
            if (kAny) return steps;
            box.shorten(hit.t);
            continue;
        }
        float enter[kBoxes];
        const unsigned met = boxes_met(tree.boxes[next.child], box, enter);
        top = push(met, enter, top, [&](int k) HWY_ATTR { return tree.boxes[next.child].child[k]; });
    }
    return steps;
}

template <bool kAny>
HWY_INLINE RayHit trace(const TreeView& tree, const Ray& ray, std::int64_t& steps) {
    RayHit hit;
    BoxRay box;
    if (!prepare(tree, ray, box)) return hit;
    hit.t = ray.length;
    steps += search<kAny>(tree, ray, sheared(ray), box, hit);
    if (hit.triangle == kNoHit) hit.t = 0.0;
    return hit;
}

// Rays that meet more boxes than this have little in common, and go on alone.
constexpr int kMostBoxes = 64;

// Returns false if the rays have too little in common; then some of their hits are still to be found.
HWY_INLINE bool search_together(const TreeView& tree, const Ray* rays, const EdgeRay* edges, BoxRay* boxes,
                                Packet& packet, RayHit* hits, std::int64_t& steps) {
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
    ++steps;
    for (int opened = 0; top > stack;) {
        const Waiting next = *--top;
        if (next.enter > packet.longest) continue;
        ++steps;
        const Boxes& parent = tree.boxes[next.child / kBoxes];
        const std::uint32_t child = parent.child[next.child % kBoxes];
        if ((child & kGroupBit) == 0) {
            if (++opened > kMostBoxes) return false;
            open(child);
            continue;
        }
        const TriangleGroup& group = tree.groups[child & ~kGroupBit];
        bool found = false;
        for (unsigned meeting = rays_meeting(parent, next.child % kBoxes, packet); meeting != 0;
             meeting &= meeting - 1) {
            const int k = std::countr_zero(meeting);
            if (!hit_group(group, rays[k], edges[k], hits[k])) continue;
            boxes[k].shorten(hits[k].t);
            packet.most[k] = boxes[k].most;
            found = true;
        }
        if (found) packet.shorten();
    }
    return true;
}

// Returns whether the rays went together.
HWY_INLINE bool trace_packet(const TreeView& tree, const Ray* rays, RayHit* hits, std::int64_t& steps) {
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
    const bool together = search_together(tree, rays, edges, boxes, packet, hits, steps);
    for (int k = 0; k < kPacket; ++k) {
        if (!together) steps += search<false>(tree, rays[k], edges[k], boxes[k], hits[k]);
        if (hits[k].triangle == kNoHit) hits[k].t = 0.0;
    }
    return true;
}

std::int64_t TraceRays(const TreeView& tree, const Ray* rays, std::size_t count, RayHit* hits) {
    std::int64_t steps = 0;
    std::size_t k = 0;
    while (k < count) {
        if (count - k >= kPacket && trace_packet(tree, rays + k, hits + k, steps)) {
            k += kPacket;
            continue;
        }
        for (const std::size_t end = std::min(count, k + kPacket); k < end; ++k)
            hits[k] = trace<false>(tree, rays[k], steps);
    }
    return steps;
}

std::int64_t FindBlocked(const TreeView& tree, const Ray* rays, std::size_t count, std::uint8_t* blocked) {
    std::int64_t steps = 0;
    for (std::size_t k = 0; k < count; ++k) blocked[k] = trace<true>(tree, rays[k], steps).triangle != kNoHit ? 1 : 0;
    return steps;
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(std::int64_t, trace_rays, TraceRays,
           (const TreeView& tree, const Ray* rays, std::size_t count, RayHit* hits), (tree, rays, count, hits))

TEX_KERNEL(std::int64_t, find_blocked, FindBlocked,
           (const TreeView& tree, const Ray* rays, std::size_t count, std::uint8_t* blocked),
           (tree, rays, count, blocked))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
