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

// Of the hits outwards and inwards, the nearer one; of two at the same distance, the first triangle.
RayEnd nearer(const RayHit& out, const RayHit& in) {
    if (out.triangle == kNoHit && in.triangle == kNoHit) return {};
    const bool outwards = in.triangle == kNoHit ||
                          (out.triangle != kNoHit && (out.t < in.t || (out.t == in.t && out.triangle < in.triangle)));
    return outwards ? end_of(out, out.t) : end_of(in, -in.t);
}

}  // namespace

// A triangle that the ray outwards meets is seen from outside if it turns its back to that ray.
void RayCaster::cast_nearest(const std::vector<RayStart>& starts, std::vector<RayEnd>& ends, bool backfaces) const {
    std::vector<Ray> rays;
    for (const RayStart& s : starts) {
        rays.push_back(ray_from(s.point, s.direction, s.front, backfaces ? Facing::both : Facing::back));
        rays.push_back(ray_from(s.point, -1.0 * s.direction, back_, backfaces ? Facing::both : Facing::front));
    }
    std::vector<RayHit> hits(rays.size());
    trace_rays(tree_.view(), rays.data(), rays.size(), hits.data());
    for (std::size_t k = 0; k < starts.size(); ++k) ends[k] = nearer(hits[2 * k], hits[2 * k + 1]);
}

void RayCaster::cast_outermost(const std::vector<RayStart>& starts, std::vector<RayEnd>& ends, bool backfaces) const {
    std::vector<Ray> rays;
    for (const RayStart& s : starts) {
        rays.push_back(ray_from(s.point + s.front * s.direction, -1.0 * s.direction, s.front + back_,
                                backfaces ? Facing::both : Facing::front));
    }
    std::vector<RayHit> hits(rays.size());
    trace_rays(tree_.view(), rays.data(), rays.size(), hits.data());
    for (std::size_t k = 0; k < starts.size(); ++k) ends[k] = end_of(hits[k], starts[k].front - hits[k].t);
}

// Casts what has missed again, for triangles seen from behind.
void RayCaster::note_behind(const std::vector<RayStart>& starts, std::vector<RayEnd>& ends) const {
    if (backfaces_) {
        for (std::size_t k = 0; k < starts.size(); ++k) {
            if (ends[k].triangle == kNoHit) continue;
            ends[k].behind = dot(HighSurface::face_normal(place_of(ends[k])), starts[k].direction) <= 0.0;
        }
        return;
    }
    std::vector<RayStart> missed;
    std::vector<std::size_t> which;
    for (std::size_t k = 0; k < starts.size(); ++k) {
        if (ends[k].triangle != kNoHit) continue;
        missed.push_back(starts[k]);
        which.push_back(k);
    }
    if (missed.empty()) return;
    std::vector<RayEnd> seen(missed.size());
    cast_outermost(missed, seen, true);
    for (std::size_t k = 0; k < missed.size(); ++k) ends[which[k]].behind = seen[k].triangle != kNoHit;
}

void RayCaster::cast(const std::vector<RayStart>& starts, std::vector<RayEnd>& ends) const {
    ends.assign(starts.size(), {});
    if (choice_ == HitChoice::nearest)
        cast_nearest(starts, ends, backfaces_);
    else
        cast_outermost(starts, ends, backfaces_);
    note_behind(starts, ends);
}

RayEnd RayCaster::cast_line(const RayStart& start) const {
    const Vector3 across = tree_.high() - tree_.low(), away = start.point - tree_.low();
    const double length = std::sqrt(dot(across, across)) + std::sqrt(dot(away, away));
    const Ray rays[2] = {ray_from(start.point, start.direction, length, Facing::back),
                         ray_from(start.point, -1.0 * start.direction, length, Facing::front)};
    RayHit hits[2];
    trace_rays(tree_.view(), rays, 2, hits);
    return nearer(hits[0], hits[1]);
}

}  // namespace tex::inline v1
