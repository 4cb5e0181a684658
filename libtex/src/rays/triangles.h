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

#include "mesh/node_transform.h"
#include "mesh/vector3.h"

namespace tex::inline v1 {

// A part where it stands: as a placement says, or as it is stored if that is null.
struct StandingPart {
    const MeshPart* part;
    const NodeTransform* placement = nullptr;
    std::size_t place = 0;  // its number, an index into TransferInputs::high_places
};

// Refers to the parts, which must pass check_part(), and to placements. The triangles of all parts together are less
// than 2^32 - 1.
class Triangles {
public:
    explicit Triangles(std::vector<const MeshPart*> parts) : parts_(std::move(parts)) {
        for (const MeshPart* part : parts_) first_.push_back(first_.back() + part->triangles());
    }
    explicit Triangles(std::vector<StandingPart> places) : places_(std::move(places)) {
        for (const StandingPart& place : places_) {
            parts_.push_back(place.part);
            first_.push_back(first_.back() + place.part->triangles());
        }
    }

    [[nodiscard]] std::size_t count() const { return first_.back(); }

    // A triangle of a part, whose corners begin at part.indices[3 * number].
    struct Triangle {
        const MeshPart& part;
        std::size_t number;
        const StandingPart* place = nullptr;  // where the part stands, if there are places

        [[nodiscard]] const NodeTransform* placement() const { return place == nullptr ? nullptr : place->placement; }
        // Which of its corners is stored as this one: those of mirrored parts change places.
        [[nodiscard]] std::size_t stored(std::size_t corner) const {
            return corner > 0 && placement() != nullptr && placement()->is_mirrored() ? 3 - corner : corner;
        }
        [[nodiscard]] std::size_t vertex(std::size_t corner) const { return part.indices[3 * number + stored(corner)]; }
        [[nodiscard]] std::array<Vector3, 3> corners() const {
            if (placement() == nullptr) return stored_corners();
            std::array<Vector3, 3> moved;
            for (std::size_t k = 0; k < 3; ++k) moved[k] = vector_of(placement()->position(part.positions[vertex(k)]));
            return moved;
        }
        // Precondition: the part has normals.
        [[nodiscard]] Float3 normal(std::size_t corner) const {
            const Float3 normal = part.normals[vertex(corner)];
            return placement() == nullptr ? normal : placement()->normal(normal);
        }
        // Where they are stored.
        [[nodiscard]] std::size_t stored_vertex(std::size_t corner) const { return part.indices[3 * number + corner]; }
        [[nodiscard]] std::array<Vector3, 3> stored_corners() const {
            return {vector_of(part.positions[stored_vertex(0)]), vector_of(part.positions[stored_vertex(1)]),
                    vector_of(part.positions[stored_vertex(2)])};
        }
    };
    [[nodiscard]] Triangle at(std::size_t triangle) const {
        const std::size_t part = part_of(triangle);
        return {*parts_[part], triangle - first_[part], places_.empty() ? nullptr : &places_[part]};
    }

    // The part of each place, if there are places.
    [[nodiscard]] const std::vector<const MeshPart*>& parts() const { return parts_; }
    // For each of parts(); empty if all stand where they are stored.
    [[nodiscard]] const std::vector<StandingPart>& places() const { return places_; }
    // The place of a triangle's part among the parts.
    [[nodiscard]] std::size_t part_of(std::size_t triangle) const {
        const auto after = std::upper_bound(first_.begin(), first_.end(), triangle);
        return static_cast<std::size_t>(after - first_.begin()) - 1;
    }
    // The number of a part's first triangle.
    [[nodiscard]] std::size_t first_of(std::size_t part) const { return first_[part]; }

private:
    std::vector<const MeshPart*> parts_;
    std::vector<StandingPart> places_;
    std::vector<std::size_t> first_ = {0};
};

}  // namespace tex::inline v1
