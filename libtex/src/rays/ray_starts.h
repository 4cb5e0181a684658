// SPDX-License-Identifier: Apache-2.0
// ray_starts.h: where the rays of the low mesh start: at `front`, or as the cage, the skew and the offset of
// TransferInputs say.

#pragma once

#include <array>
#include <cstddef>

#include <tex/transfer.h>

#include "rays/ray_casts.h"
#include "rays/ray_directions.h"
#include "rays/ray_work.h"

namespace tex::inline v1 {

class RayStarts {
public:
    // `directions` and `inputs` must outlive this. `diagonal` is that of the low mesh.
    RayStarts(const RayDirections& directions, const TransferInputs& inputs, double front, double diagonal)
        : directions_(directions), inputs_(inputs), front_(front), slack_(0x1p-20 * diagonal) {}

    // The start at the place of a triangle with these weights, at (x, y) of the map: from 0 to 1, right and down.
    // `work` is that of directions.
    [[nodiscard]] RayStart at(std::size_t triangle, const std::array<double, 3>& weights, Vector3 point, double x,
                              double y, RayWork& work) const;

    // The starts at many places of a triangle, without pictures. Writes their directions to `directions`.
    void along(std::size_t triangle, VectorArrays<const double> weights, VectorArrays<const double> points,
               std::size_t count, VectorArrays<double> directions, RayStart* starts, RayWork& work) const;

    // Whether the place in the map matters.
    [[nodiscard]] bool has_pictures() const { return inputs_.skew != nullptr || inputs_.offset != nullptr; }

    // The largest distance between the corners of the cage and of `low`, or `front` without a cage.
    [[nodiscard]] double farthest(const MeshPart& low) const;

private:
    const RayDirections& directions_;
    const TransferInputs& inputs_;
    double front_;
    double slack_;  // beyond a cage, so that rays meet what lies on it
};

// Errors: bad_option, if the inputs do not fit the meshes (transfer.h); bad_data, as check_part(cage).
Result<void> check_inputs(const TransferInputs& inputs, const MeshPart& low, std::size_t high_parts, RayMode rays);

}  // namespace tex::inline v1
