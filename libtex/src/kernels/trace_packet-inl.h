// SPDX-License-Identifier: Apache-2.0
// trace_packet-inl.h: eight rays that go through the tree together.
//
// Compiled once for each Highway target, as part of trace.cpp.

#if defined(TEX_KERNELS_TRACE_PACKET_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_TRACE_PACKET_INL_H
#undef TEX_KERNELS_TRACE_PACKET_INL_H
#else
#define TEX_KERNELS_TRACE_PACKET_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "kernels/trace.h"
#include "kernels/trace_boxes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Rays that go through the tree together. A box counts if it may meet any of them: its distances are those of the ray
// whose origin and direction would be the extremes of theirs, along each axis by itself. As rounding keeps order, no
// box is passed over that one of them meets. A group of triangles is tested with those rays that meet its own box.
constexpr int kPacket = kBoxes;
constexpr std::size_t kCacheLine = 64;
struct Packet {
    HWY_ALIGN float near_origin[3][kPacket], far_origin[3][kPacket], inverse[3][kPacket], most[kPacket];
    float first_origin[3], last_origin[3], least_inverse[3], most_inverse[3];  // the extremes
    std::size_t near_row[3], far_row[3];
    float longest;  // the largest of `most`

    // After `most` has changed.
    void shorten() { longest = *std::max_element(most, most + kPacket); }
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
    packet.shorten();
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
    if (tree.groups == nullptr) return;  // a tree of places
    for (; met != 0; met &= met - 1) {
        const std::uint32_t child = boxes.child[std::countr_zero(met)];
        const bool is_group = (child & kGroupBit) != 0;
        const auto* const first = is_group ? reinterpret_cast<const char*>(tree.groups + (child & ~kGroupBit))
                                           : reinterpret_cast<const char*>(tree.boxes + child);
        const std::size_t size = is_group ? sizeof(TriangleGroup) : sizeof(Boxes);
        for (std::size_t at = 0; at < size; at += kCacheLine) hwy::Prefetch(first + at);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif
