// SPDX-License-Identifier: Apache-2.0
// triangles.h: the triangles of several parts under one numbering.
//
// The folder rays/ holds what rays meet, a tree of boxes over triangles, the places on them that are nearest to a
// point, and the maps that rays fill. Its rule: it opens no file. Coordinates are those of the meshes, in double; only
// kernels/trace.h knows other ones.

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "mesh/vector3.h"

namespace tex::inline v1 {

// Refers to the parts, which must pass check_part(). The triangles of all parts together are at most kMaxTriangles.
class Triangles {
public:
    explicit Triangles(std::vector<const MeshPart*> parts) : parts_(std::move(parts)) {
        for (const MeshPart* part : parts_) first_.push_back(first_.back() + part->triangles());
    }

    [[nodiscard]] std::size_t count() const { return first_.back(); }

    // A triangle of a part, whose corners begin at part.indices[3 * number].
    struct Triangle {
        const MeshPart& part;
        std::size_t number;

        [[nodiscard]] std::size_t vertex(std::size_t corner) const { return part.indices[3 * number + corner]; }
        [[nodiscard]] std::array<Vector3, 3> corners() const {
            return {vector_of(part.positions[vertex(0)]), vector_of(part.positions[vertex(1)]),
                    vector_of(part.positions[vertex(2)])};
        }
    };
    [[nodiscard]] Triangle at(std::size_t triangle) const {
        const auto after = std::upper_bound(first_.begin(), first_.end(), triangle);
        const auto part = static_cast<std::size_t>(after - first_.begin()) - 1;
        return {*parts_[part], triangle - first_[part]};
    }

    [[nodiscard]] const std::vector<const MeshPart*>& parts() const { return parts_; }
    // The number of a part's first triangle.
    [[nodiscard]] std::size_t first_of(std::size_t part) const { return first_[part]; }

private:
    std::vector<const MeshPart*> parts_;
    std::vector<std::size_t> first_ = {0};
};

}  // namespace tex::inline v1
