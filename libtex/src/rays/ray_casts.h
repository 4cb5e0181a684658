// SPDX-License-Identifier: Apache-2.0
// ray_casts.h: from places of the low mesh to the high one: what TransferOptions::hit and `backfaces` mean.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <tex/transfer.h>

#include "rays/box_tree.h"
#include "rays/cutouts.h"
#include "rays/ray_work.h"

namespace tex::inline v1 {

// A place of the low mesh.
struct RayStart {
    Vector3 point;
    Vector3 direction;   // outwards, of unit length
    double front = 0.0;  // how far the ray reaches outwards
};

// Where its ray meets the high mesh.
struct RayEnd {
    std::uint32_t triangle = kNoHit;  // of the high mesh
    std::array<double, 3> weights{};  // of its corners
    double height = 0.0;              // from the place along the direction
    bool behind = false;              // only triangles seen from behind are hit, or would be if they counted
};

class RayCaster {
public:
    // Distances in the unit of the meshes. `triangles`, `tree` and `surface` must outlive this.
    RayCaster(const Triangles& triangles, const BoxTree& tree, const HighSurface& surface, HitChoice choice,
              bool backfaces, double back)
        : triangles_(triangles), tree_(tree), cutouts_(triangles, tree, surface), choice_(choice),
          backfaces_(backfaces), back_(back) {}

    // Memory that casts use one after the other.
    struct Scratch {
        std::vector<Ray> rays;
        std::vector<RayHit> hits;
        std::vector<RayStart> missed;
        std::vector<RayEnd> seen;
        std::vector<std::size_t> which;
        RayWork work;
    };
    // ends[k] belongs to starts[k]. Means nothing if scratch.work is not fair afterwards.
    void cast(const std::vector<RayStart>& starts, std::vector<RayEnd>& ends, Scratch& scratch) const;

    // The nearest triangle seen from outside on the whole line of a start.
    [[nodiscard]] RayEnd cast_line(const RayStart& start, RayWork& work) const;

    // The triangle of a hit, and the place of the hit on it.
    [[nodiscard]] Triangles::Triangle place_of(const RayEnd& end) const { return triangles_.at(end.triangle); }
    [[nodiscard]] Vector3 point_of(const RayEnd& end) const { return mix(place_of(end).corners(), end.weights); }

private:
    using Starts = std::vector<RayStart>;
    using Ends = std::vector<RayEnd>;
    void cast_outermost(const Starts& starts, Ends& ends, bool backfaces, Scratch& scratch) const;
    void cast_nearest(const Starts& starts, Ends& ends, Scratch& scratch) const;
    void trace(Scratch& scratch) const;
    void note_behind(const Starts& starts, Ends& ends, Scratch& scratch) const;

    const Triangles& triangles_;
    const BoxTree& tree_;
    Cutouts cutouts_;
    HitChoice choice_;
    bool backfaces_;
    double back_;
};

}  // namespace tex::inline v1
