// SPDX-License-Identifier: Apache-2.0
// ray_casts.h: from places of the low mesh to the high one: what TransferOptions::hit and `backfaces` mean.

#pragma once

#include <cstdint>
#include <vector>

#include <tex/transfer_options.h>

#include "rays/box_tree.h"

namespace tex {

// A place of the low mesh.
struct RayStart {
    Vector3 point;
    Vector3 direction;  // outwards, of unit length
};

// Where its ray meets the high mesh.
struct RayEnd {
    std::uint32_t triangle = kNoHit;  // of the high mesh
    double weights[3] = {};           // of its corners
    double height = 0.0;              // from the place along the direction
    bool behind = false;              // only triangles seen from behind are hit, or would be if they counted
};

class RayCaster {
public:
    // Distances in the unit of the meshes. `triangles` and `tree` must outlive this.
    RayCaster(const Triangles& triangles, const BoxTree& tree, HitChoice choice, bool backfaces, double front,
              double back)
        : triangles_(triangles), tree_(tree), choice_(choice), backfaces_(backfaces), front_(front), back_(back) {}

    // ends[k] belongs to starts[k].
    void cast(const std::vector<RayStart>& starts, std::vector<RayEnd>& ends) const;

    // The nearest triangle seen from outside on the whole line of a start.
    [[nodiscard]] RayEnd cast_line(const RayStart& start) const;

    // The normal at a hit: see transfer.h. Of unit length.
    [[nodiscard]] Vector3 normal_at(const RayEnd& end) const;

private:
    void cast_outermost(const std::vector<RayStart>& starts, std::vector<RayEnd>& ends, bool backfaces) const;
    void cast_nearest(const std::vector<RayStart>& starts, std::vector<RayEnd>& ends, bool backfaces) const;
    void note_behind(const std::vector<RayStart>& starts, std::vector<RayEnd>& ends) const;
    [[nodiscard]] Vector3 face_normal_of(std::uint32_t triangle) const;

    const Triangles& triangles_;
    const BoxTree& tree_;
    HitChoice choice_;
    bool backfaces_;
    double front_, back_;
};

}  // namespace tex
