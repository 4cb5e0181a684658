// SPDX-License-Identifier: Apache-2.0
// mesh_body.h: a mesh as the shape that carries the map: its place in the picture's world, and the tangent frame where
// a view ray meets a triangle.

#pragma once

#include <array>
#include <cstddef>

#include <tex/mesh.h>

#include "preview/camera.h"
#include "preview/sampling.h"
#include "preview/shapes.h"
#include "preview/vector.h"

namespace tex::inline v1::render {

// A point of a triangle, and the footprint of its pixel.
struct MeshHit {
    Hit hit;  // without u_per_length, v_per_length and face
    Footprint footprint;
};

// A mesh in a sphere of radius 1 about the origin: the centre of its box moves there, and its farthest corner has the
// distance 1. Refers to the TangentSpace, for which check_space() must succeed.
class MeshBody {
public:
    explicit MeshBody(const TangentSpace& space);

    [[nodiscard]] const TangentSpace& space() const { return space_; }
    [[nodiscard]] std::size_t triangles() const { return space_.part.triangles(); }
    // The place of a vertex in the picture's world.
    [[nodiscard]] Vec3 place(std::size_t vertex) const;
    [[nodiscard]] std::array<Vec3, 3> corners(std::size_t triangle) const;
    // In the map, v up.
    [[nodiscard]] std::array<Vec2, 3> uvs(std::size_t triangle) const;

    // Whether the viewer sees the front of the triangle.
    [[nodiscard]] bool faces(std::size_t triangle, const View& view) const;

    // Where the ray through (x, y) meets the triangle or, beside it, its nearest point.
    [[nodiscard]] MeshHit meet(std::size_t triangle, const View& view, double x, double y) const;

private:
    const TangentSpace& space_;
    Vec3 centre_;
    double scale_ = 1.0;
};

}  // namespace tex::inline v1::render
