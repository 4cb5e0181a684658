// SPDX-License-Identifier: Apache-2.0
// high_surface.h: what is found on the high mesh at a hit: normals, colours, ids (TransferInputs).

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <tex/transfer.h>

#include "rays/triangles.h"

namespace tex::inline v1 {

class HighSurface {
public:
    // Both must outlive this. Places refer to parts of `high`.
    HighSurface(const std::vector<MeshPart>& high, const TransferInputs& inputs);

    using Weights = std::array<double, 3>;

    // The normal at the triangle: see transfer.h. Of unit length.
    [[nodiscard]] Vector3 normal_at(const Triangles::Triangle& triangle, const Weights& weights) const;
    // Whether it is mixed from the normals of the corners alone.
    [[nodiscard]] bool mixes_normals(const Triangles::Triangle& triangle) const {
        const HighDetail* const detail = detail_of(triangle);
        return (detail == nullptr || detail->normals == nullptr) && !triangle.part.normals.empty();
    }
    [[nodiscard]] static Vector3 face_normal(const Triangles::Triangle& triangle);

    [[nodiscard]] bool has_cutouts() const { return has_cutouts_; }
    // Whether nothing is there: HighDetail::alpha.
    [[nodiscard]] bool is_open_at(const Triangles::Triangle& triangle, const Weights& weights) const;

    [[nodiscard]] bool has_colors() const { return has_colors_; }
    [[nodiscard]] Vector3 color_at(const Triangles::Triangle& triangle, const Weights& weights) const;

    // The colour of the vertices; white if the part has none.
    [[nodiscard]] static Vector3 vertex_color_at(const Triangles::Triangle& triangle, const Weights& weights);

    [[nodiscard]] bool has_ids() const { return !inputs_.high_ids.empty(); }
    [[nodiscard]] std::int32_t id_of(const Triangles::Triangle& triangle) const {
        return inputs_.high_ids[triangle.place == nullptr ? index_of(triangle) : triangle.place->place];
    }

private:
    [[nodiscard]] std::size_t index_of(const Triangles::Triangle& triangle) const {
        return static_cast<std::size_t>(&triangle.part - high_.data());
    }
    [[nodiscard]] const HighDetail* detail_of(const Triangles::Triangle& triangle) const {
        return inputs_.high_details.empty() ? nullptr : &inputs_.high_details[index_of(triangle)];
    }

    const std::vector<MeshPart>& high_;
    const TransferInputs& inputs_;
    bool has_colors_ = false, has_cutouts_ = false;
};

// Errors: bad_option, if ids and details do not fit the parts (transfer.h).
Result<void> check_details(const TransferInputs& inputs, const std::vector<MeshPart>& high);

}  // namespace tex::inline v1
