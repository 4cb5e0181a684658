// SPDX-License-Identifier: Apache-2.0

#include "rays/second_rays.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tex::inline v1 {
namespace {

// A share of the largest coordinate. The place of a hit and the test of a triangle are exact to a few 2^-52 of it.
constexpr double kLift = 0x1p-32;
// Makes the directions of thickness others than those of occlusion.
constexpr std::uint32_t kInwards = 0x68bc21ebU;

}  // namespace

SecondRays::SecondRays(const RayGroup& whole, const HighSurface& surface, const TransferOptions& options,
                       double distance)
    : cutouts_(whole.triangles(), whole.tree(), surface), hemisphere_(options.rays_per_hit),
      looks_out_(options.occlusion || options.bent), looks_in_(options.thickness), limit_(distance) {
    const Vector3 across = whole.tree().high() - whole.tree().low();
    length_ = std::min(limit_, 2.0 * std::sqrt(dot(across, across)));  // nothing is farther away
    lift_ = kLift * whole.tree().largest_coordinate();
}

void SecondRays::start(const HitPoint& place, double side, std::uint32_t seed, Facing facing, Scratch& scratch) const {
    const auto count = static_cast<std::size_t>(hemisphere_.count());
    scratch.directions.resize(count);
    scratch.rays.resize(count);
    hemisphere_.about(side * place.normal, side * place.face, seed, scratch.directions.data());
    const Vector3 from = place.point + (side * lift_) * place.face;
    for (std::size_t k = 0; k < count; ++k) {
        const Vector3& d = scratch.directions[k];
        scratch.rays[k] = {{from.x, from.y, from.z}, {d.x, d.y, d.z}, length_, facing};
    }
}

void SecondRays::add_openness(const HitPoint& place, std::uint32_t seed, Scratch& scratch, Sums& sums) const {
    start(place, 1.0, seed, Facing::both, scratch);
    scratch.blocked.resize(scratch.rays.size());
    cutouts_.find_blocked(scratch.rays.data(), scratch.rays.size(), scratch.blocked.data(), scratch.work);
    int open = 0;
    Vector3 bent;
    for (std::size_t k = 0; k < scratch.rays.size(); ++k) {
        if (scratch.blocked[k] != 0) continue;
        ++open;
        bent = bent + scratch.directions[k];
    }
    sums.open += static_cast<double>(open) / hemisphere_.count();
    sums.bent = sums.bent + bent;
    sums.rays += hemisphere_.count();
}

void SecondRays::add_thickness(const HitPoint& place, std::uint32_t seed, Scratch& scratch, Sums& sums) const {
    start(place, -1.0, seed ^ kInwards, Facing::both, scratch);
    scratch.hits.assign(scratch.rays.size(), {});
    cutouts_.trace(scratch.rays.data(), scratch.rays.size(), scratch.hits.data(), scratch.work);
    double sum = 0.0;
    int count = 0;
    for (const RayHit& hit : scratch.hits) {
        const bool meets = hit.triangle != kNoHit;
        if (!meets && std::isinf(limit_)) continue;
        sum += meets ? hit.t : limit_;
        ++count;
    }
    sums.rays += hemisphere_.count();
    if (count == 0) return;
    sums.thickness += sum / count;
    ++sums.thick;
}

void SecondRays::add(const HitPoint& place, std::uint32_t seed, Scratch& scratch, Sums& sums) const {
    if (looks_out_) add_openness(place, seed, scratch, sums);
    if (looks_in_) add_thickness(place, seed, scratch, sums);
}

}  // namespace tex::inline v1
