// SPDX-License-Identifier: Apache-2.0

#include "rays/cutouts.h"

#include <array>
#include <utility>
#include <vector>

namespace tex::inline v1 {
namespace {

// What a ray passes at most, so that a stack of leaves does not take time without end.
constexpr int kMostPassed = 64;
// A share of the largest coordinate, as that of second rays.
constexpr double kBehind = 0x1p-32;

}  // namespace

Cutouts::Cutouts(const Triangles& triangles, const BoxTree& tree, const HighSurface& surface)
    : triangles_(triangles), tree_(tree), surface_(surface.has_cutouts() ? &surface : nullptr),
      lift_(kBehind * tree.largest_coordinate()) {}

bool Cutouts::is_open(const RayHit& hit) const {
    if (hit.triangle == kNoHit) return false;
    return surface_->is_open_at(triangles_.at(hit.triangle), {hit.weights[0], hit.weights[1], hit.weights[2]});
}

void Cutouts::trace(const Ray* rays, std::size_t count, RayHit* hits, RayWork& work) const {
    trace_fairly(tree_.view(), rays, count, hits, work);
    if (surface_ == nullptr) return;
    std::vector<std::size_t> open, still;
    for (std::size_t k = 0; k < count; ++k) {
        if (is_open(hits[k])) open.push_back(k);
    }
    std::vector<Ray> onward;
    std::vector<RayHit> found;
    for (int passed = 0; passed < kMostPassed && !open.empty(); ++passed) {
        onward.clear();
        for (const std::size_t k : open) {
            Ray& ray = onward.emplace_back(rays[k]);
            const double way = hits[k].t + lift_;
            for (int axis = 0; axis < 3; ++axis) ray.origin[axis] += way * ray.direction[axis];
            ray.length -= way;
        }
        found.assign(onward.size(), {});
        trace_fairly(tree_.view(), onward.data(), onward.size(), found.data(), work);
        still.clear();
        for (std::size_t n = 0; n < open.size(); ++n) {
            RayHit& hit = hits[open[n]];
            found[n].t += hit.t + lift_;
            hit = found[n].triangle == kNoHit ? RayHit{} : found[n];
            if (is_open(hit)) still.push_back(open[n]);
        }
        std::swap(open, still);
    }
}

void Cutouts::find_blocked(const Ray* rays, std::size_t count, std::uint8_t* blocked, RayWork& work) const {
    if (surface_ == nullptr) return find_blocked_fairly(tree_.view(), rays, count, blocked, work);
    std::vector<RayHit> hits(count);
    trace(rays, count, hits.data(), work);
    for (std::size_t k = 0; k < count; ++k) blocked[k] = hits[k].triangle == kNoHit ? 0 : 1;
}

}  // namespace tex::inline v1
