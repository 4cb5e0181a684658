// SPDX-License-Identifier: Apache-2.0

#include "rays/ray_casts.h"

#include <algorithm>
#include <cmath>

#include "rays/high_surface.h"

namespace tex::inline v1 {
namespace {

Ray ray_from(Vector3 origin, Vector3 direction, double length, Facing facing) {
    return {{origin.x, origin.y, origin.z}, {direction.x, direction.y, direction.z}, length, facing};
}

RayEnd end_of(const RayHit& hit, double height) {
    return {hit.triangle, {hit.weights[0], hit.weights[1], hit.weights[2]}, height, false};
}

// The nearer one of the hits outwards and inwards; of two at the same distance, the first triangle.
RayEnd nearer(const RayHit& out, const RayHit& in) {
    if (out.triangle == kNoHit && in.triangle == kNoHit) return {};
    const bool outwards = in.triangle == kNoHit ||
                          (out.triangle != kNoHit && (out.t < in.t || (out.t == in.t && out.triangle < in.triangle)));
    return outwards ? end_of(out, out.t) : end_of(in, -in.t);
}

}  // namespace

void RayCaster::trace(Scratch& scratch) const {
    scratch.hits.assign(scratch.rays.size(), {});
    cutouts_.trace(scratch.rays.data(), scratch.rays.size(), scratch.hits.data(), scratch.work);
}

// A triangle that the ray outwards meets is seen from outside if it turns its back to that ray. Rays that look the same
// way are neighbours, because the tree is faster then.
void RayCaster::cast_nearest(const Starts& starts, Ends& ends, Scratch& scratch) const {
    scratch.rays.clear();
    for (const RayStart& s : starts)
        scratch.rays.push_back(ray_from(s.point, s.direction, s.front, backfaces_ ? Facing::both : Facing::back));
    for (const RayStart& s : starts)
        scratch.rays.push_back(ray_from(s.point, -1.0 * s.direction, back_, backfaces_ ? Facing::both : Facing::front));
    trace(scratch);
    for (std::size_t k = 0; k < starts.size(); ++k) ends[k] = nearer(scratch.hits[k], scratch.hits[starts.size() + k]);
}

void RayCaster::cast_outermost(const Starts& starts, Ends& ends, bool backfaces, Scratch& scratch) const {
    scratch.rays.clear();
    for (const RayStart& s : starts) {
        scratch.rays.push_back(ray_from(s.point + s.front * s.direction, -1.0 * s.direction, s.front + back_,
                                        backfaces ? Facing::both : Facing::front));
    }
    trace(scratch);
    for (std::size_t k = 0; k < starts.size(); ++k)
        ends[k] = end_of(scratch.hits[k], starts[k].front - scratch.hits[k].t);
}

// Casts what has missed again, for triangles seen from behind.
void RayCaster::note_behind(const Starts& starts, Ends& ends, Scratch& scratch) const {
    if (backfaces_) {
        for (std::size_t k = 0; k < starts.size(); ++k) {
            if (ends[k].triangle == kNoHit) continue;
            ends[k].behind = dot(HighSurface::face_normal(place_of(ends[k])), starts[k].direction) <= 0.0;
        }
        return;
    }
    scratch.missed.clear();
    scratch.which.clear();
    for (std::size_t k = 0; k < starts.size(); ++k) {
        if (ends[k].triangle != kNoHit) continue;
        scratch.missed.push_back(starts[k]);
        scratch.which.push_back(k);
    }
    if (scratch.missed.empty()) return;
    scratch.seen.assign(scratch.missed.size(), {});
    cast_outermost(scratch.missed, scratch.seen, true, scratch);
    for (std::size_t k = 0; k < scratch.missed.size(); ++k)
        ends[scratch.which[k]].behind = scratch.seen[k].triangle != kNoHit;
}

void RayCaster::cast(const Starts& starts, Ends& ends, Scratch& scratch) const {
    ends.assign(starts.size(), {});
    if (choice_ == HitChoice::nearest)
        cast_nearest(starts, ends, scratch);
    else
        cast_outermost(starts, ends, backfaces_, scratch);
    note_behind(starts, ends, scratch);
}

RayEnd RayCaster::cast_line(const RayStart& start, RayWork& work) const {
    const Vector3 across = tree_.high() - tree_.low(), away = start.point - tree_.low();
    const double length = std::sqrt(dot(across, across)) + std::sqrt(dot(away, away));
    const Ray rays[2] = {ray_from(start.point, start.direction, length, Facing::back),
                         ray_from(start.point, -1.0 * start.direction, length, Facing::front)};
    RayHit hits[2];
    cutouts_.trace(rays, 2, hits, work);
    return nearer(hits[0], hits[1]);
}

}  // namespace tex::inline v1
