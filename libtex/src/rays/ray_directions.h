// SPDX-License-Identifier: Apache-2.0
// ray_directions.h: the directions in which rays leave the low mesh: RayMode of transfer.h.

#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <tex/transfer.h>

#include "kernels/corner_vectors.h"
#include "rays/box_tree.h"
#include "rays/ray_work.h"

namespace tex::inline v1 {

class RayDirections {
public:
    // `width` in the unit of the mesh and `angle` in degrees are those of RayMode::straight. The part must outlive
    // this. Precondition: the part has normals if the mode is `vertex`. Errors: out_of_memory, cancelled.
    static Result<RayDirections> make(const MeshPart& part, RayMode mode, double width, double angle,
                                      const Execution& execution);

    // A direction of unit length, at the point of the triangle that has these weights. `work` is what hard edges cost.
    [[nodiscard]] Vector3 at(std::size_t triangle, const std::array<double, 3>& weights, Vector3 point,
                             RayWork& work) const;
    // The direction of RayMode::straight between the averaged normal (k = 0) and that of the face (k = 1).
    [[nodiscard]] Vector3 skewed(std::size_t triangle, const std::array<double, 3>& weights, double k) const;
    // Directions at many points of a triangle. They mean nothing if the work is not fair afterwards.
    void along(std::size_t triangle, VectorArrays<const double> weights, VectorArrays<const double> points,
               std::size_t count, VectorArrays<double> directions, RayWork& work) const;

private:
    void set_straight(const std::vector<std::uint32_t>& position, double angle);
    [[nodiscard]] double straightness(Vector3 point, RayWork& work) const;
    [[nodiscard]] std::array<Vector3, 3> of_corners(const std::vector<Vector3>& normals, std::size_t triangle) const {
        return {normals[3 * triangle], normals[3 * triangle + 1], normals[3 * triangle + 2]};
    }

    const MeshPart* part_ = nullptr;
    double width_ = 0.0;
    std::vector<Vector3> normals_;  // of corners: those of RayMode::smooth or RayMode::vertex
    std::vector<Vector3> own_;      // with RayMode::straight: averaged up to hard edges alone; else empty
    // The hard edges as triangles without area; empty unless the mode is `straight`.
    std::shared_ptr<MeshPart> hard_ = std::make_shared<MeshPart>();
    std::optional<BoxTree> hard_tree_;  // none: there are no hard edges
};

}  // namespace tex::inline v1
