// SPDX-License-Identifier: Apache-2.0
// second_rays.h: what is seen from the places that rays have hit: occlusion, bent normals, thickness (transfer.h).

#pragma once

#include <cstdint>
#include <vector>

#include <tex/transfer.h>

#include "rays/cutouts.h"
#include "rays/hemisphere.h"
#include "rays/high_surface.h"
#include "rays/ray_groups.h"
#include "rays/ray_work.h"

namespace tex::inline v1 {

// A place on the high mesh. Both normals have unit length and point to the side from which second rays start.
struct HitPoint {
    Vector3 point;
    Vector3 normal, face;  // interpolated; of the triangle
};

class SecondRays {
public:
    // `distance` is how far they reach; infinite if there is no limit. Both must outlive this.
    SecondRays(const RayGroup& whole, const HighSurface& surface, const TransferOptions& options, double distance);

    // What a texel has found at the places that its rays have hit.
    struct Sums {
        double open = 0.0;  // parts of the second rays of a place
        Vector3 bent;
        double thickness = 0.0;  // means of a place
        int thick = 0;           // places that have one
        std::int64_t rays = 0;
    };
    struct Scratch {
        std::vector<Vector3> directions;
        std::vector<Ray> rays;
        std::vector<std::uint8_t> blocked;
        std::vector<RayHit> hits;
        RayWork work;
    };

    // Casts the rays of one place. Means nothing if scratch.work is not fair afterwards.
    void add(const HitPoint& place, std::uint32_t seed, Scratch& scratch, Sums& sums) const;

private:
    void start(const HitPoint& place, double side, std::uint32_t seed, Facing facing, Scratch& scratch) const;
    void add_openness(const HitPoint& place, std::uint32_t seed, Scratch& scratch, Sums& sums) const;
    void add_thickness(const HitPoint& place, std::uint32_t seed, Scratch& scratch, Sums& sums) const;

    Cutouts cutouts_;
    Hemisphere hemisphere_;
    bool looks_out_, looks_in_;
    double limit_;   // infinite: none
    double length_;  // of rays
    double lift_;    // off the surface
};

}  // namespace tex::inline v1
