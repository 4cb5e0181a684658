// SPDX-License-Identifier: Apache-2.0
// cutouts.h: rays that pass where the alpha of the high mesh says that nothing is there (HighDetail::alpha).

#pragma once

#include <cstddef>
#include <cstdint>

#include "rays/box_tree.h"
#include "rays/high_surface.h"
#include "rays/ray_work.h"
#include "rays/triangles.h"

namespace tex::inline v1 {

class Cutouts {
public:
    // All must outlive this. `surface` is that of the triangles.
    Cutouts(const Triangles& triangles, const BoxTree& tree, const HighSurface& surface);

    // trace_fairly() of the tree, without what the rays pass.
    void trace(const Ray* rays, std::size_t count, RayHit* hits, RayWork& work) const;
    // find_blocked_fairly(), likewise.
    void find_blocked(const Ray* rays, std::size_t count, std::uint8_t* blocked, RayWork& work) const;

private:
    [[nodiscard]] bool is_open(const RayHit& hit) const;

    const Triangles& triangles_;
    const BoxTree& tree_;
    const HighSurface* surface_;  // null: no part has alpha
    double lift_;                 // behind what a ray has passed
};

}  // namespace tex::inline v1
