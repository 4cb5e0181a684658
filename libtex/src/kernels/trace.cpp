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
#include "kernels/trace_places-inl.h"
#include "kernels/trace_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Calls leaf(group or place) for those whose boxes the ray meets, until one returns true. Returns the steps.
template <class Leaf>
HWY_INLINE std::int64_t search(const TreeView& tree, const BoxRay& box, const Leaf& leaf) {
    Waiting stack[(kBoxes - 1) * kMostLevels + kBoxes + 1];
    Waiting* top = stack;
    *top++ = {0.0f, 0};
    std::int64_t steps = 0;
    while (top > stack) {
        const Waiting next = *--top;
        if (next.enter > box.most) continue;
        ++steps;
        if ((next.child & kGroupBit) != 0) {
            if (leaf(next.child & ~kGroupBit)) return steps;
            continue;
        }
        float enter[kBoxes];
        const unsigned met = boxes_met(tree.boxes[next.child], box, enter);
        top = push(met, enter, top, [&](int k) HWY_ATTR { return tree.boxes[next.child].child[k]; });
    }
    return steps;
}

// Finds the nearest hit, or with kAny any. Returns the steps. Precondition: hit.t is the length of the ray if nothing
// was hit before.
template <bool kAny, class Groups>
HWY_INLINE std::int64_t search_groups(const TreeView& tree, Groups groups, const Ray& ray, const EdgeRay& edge,
                                      BoxRay& box, RayHit& hit) {
    return search(tree, box, [&](std::uint32_t group) HWY_ATTR {
        if (!hit_group(groups.at(group), ray, edge, hit)) return false;
        if (kAny) return true;
        box.shorten(hit.t);
        return false;
    });
}

// Traces in a tree that is a place. The hit may be that of another one.
template <bool kAny>
std::int64_t search_place(const PlacedTree& place, const Ray& ray, const EdgeRay& edge, RayHit& hit) {
    BoxRay box;
    if (!prepare(place, ray, hit.t, box)) return 1;
    if (place.is_plain) return search_groups<kAny>(place.tree, StoredGroups(place), ray, edge, box, hit);
    return search_groups<kAny>(place.tree, PlacedGroups(place), ray, edge, box, hit);
}

// Traces in a tree of places.
template <bool kAny>
std::int64_t search_places(const TreeView& tree, const Ray& ray, const EdgeRay& edge, BoxRay& box, RayHit& hit) {
    std::int64_t inside = 0;
    const std::int64_t steps = search(tree, box, [&](std::uint32_t place) HWY_ATTR {
        inside += search_place<kAny>(tree.places[place], ray, edge, hit);
        box.shorten(hit.t);
        return kAny && hit.triangle != kNoHit;
    });
    return steps + inside;
}

template <bool kAny>
HWY_INLINE RayHit trace(const TreeView& tree, const Ray& ray, std::int64_t& steps) {
    RayHit hit;
    BoxRay box;
    if (!prepare(tree, ray, box)) return hit;
    hit.t = ray.length;
    if (tree.places == nullptr)
        steps += search_groups<kAny>(tree, StoredGroups(tree), ray, sheared(ray), box, hit);
    else
        steps += search_places<kAny>(tree, ray, sheared(ray), box, hit);
    if (hit.triangle == kNoHit) hit.t = 0.0;
    return hit;
}

// Rays that meet more boxes than this have little in common, and go on alone.
constexpr int kMostBoxes = 64;

// Calls leaf(group or place, rays that meet its box, as bits), which returns whether it has shortened rays. Returns
// false if the rays have too little in common; then some of their hits are still to be found.
template <class Leaf>
HWY_INLINE bool search_together(const TreeView& tree, Packet& packet, std::int64_t& steps, const Leaf& leaf) {
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
        if (leaf(child & ~kGroupBit, rays_meeting(parent, next.child % kBoxes, packet))) packet.shorten();
    }
    return true;
}

// Tests a group with those rays of a packet that meet its box.
template <class Groups>
HWY_INLINE bool hit_together(Groups& groups, std::uint32_t number, unsigned meeting, const Ray* rays,
                             const EdgeRay* edges, BoxRay* boxes, Packet& packet, RayHit* hits) {
    if (meeting == 0) return false;
    const TriangleGroup& group = groups.at(number);
    bool found = false;
    for (; meeting != 0; meeting &= meeting - 1) {
        const int k = std::countr_zero(meeting);
        if (!hit_group(group, rays[k], edges[k], hits[k])) continue;
        boxes[k].shorten(hits[k].t);
        packet.most[k] = boxes[k].most;
        found = true;
    }
    return found;
}

template <class Groups>
HWY_INLINE void search_groups_together(const TreeView& tree, Groups groups, const Ray* rays, const EdgeRay* edges,
                                       BoxRay* boxes, Packet& packet, RayHit* hits, std::int64_t& steps) {
    const auto leaf = [&](std::uint32_t group, unsigned meeting)
                          HWY_ATTR { return hit_together(groups, group, meeting, rays, edges, boxes, packet, hits); };
    if (search_together(tree, packet, steps, leaf)) return;
    for (int k = 0; k < kPacket; ++k) steps += search_groups<false>(tree, groups, rays[k], edges[k], boxes[k], hits[k]);
}

// search_place() for those rays of a packet that meet it.
inline void search_place_together(const PlacedTree& place, unsigned meeting, const Ray* rays, const EdgeRay* edges,
                                  RayHit* hits, std::int64_t& steps) {
    constexpr int kFew = 3;  // that are faster alone
    BoxRay boxes[kPacket];
    Packet packet;
    bool together = std::popcount(meeting) > kFew;
    for (int k = 0; k < kPacket && together; ++k) together = prepare(place, rays[k], hits[k].t, boxes[k]);
    if (!together || !gather(boxes, packet)) {
        for (; meeting != 0; meeting &= meeting - 1) {
            const int k = std::countr_zero(meeting);
            steps += search_place<false>(place, rays[k], edges[k], hits[k]);
        }
    } else if (place.is_plain) {
        search_groups_together(place.tree, StoredGroups(place), rays, edges, boxes, packet, hits, steps);
    } else {
        search_groups_together(place.tree, PlacedGroups(place), rays, edges, boxes, packet, hits, steps);
    }
}

inline void search_places_together(const TreeView& tree, const Ray* rays, const EdgeRay* edges, BoxRay* boxes,
                                   Packet& packet, RayHit* hits, std::int64_t& steps) {
    const auto leaf = [&](std::uint32_t place, unsigned meeting) HWY_ATTR {
        search_place_together(tree.places[place], meeting, rays, edges, hits, steps);
        for (int k = 0; k < kPacket; ++k) {
            boxes[k].shorten(hits[k].t);
            packet.most[k] = boxes[k].most;
        }
        return true;
    };
    if (search_together(tree, packet, steps, leaf)) return;
    for (int k = 0; k < kPacket; ++k) steps += search_places<false>(tree, rays[k], edges[k], boxes[k], hits[k]);
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
    if (tree.places == nullptr)
        search_groups_together(tree, StoredGroups(tree), rays, edges, boxes, packet, hits, steps);
    else
        search_places_together(tree, rays, edges, boxes, packet, hits, steps);
    for (int k = 0; k < kPacket; ++k) {
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
