// SPDX-License-Identifier: Apache-2.0
// shapes.h: finds where a view ray meets a shape, and the tangent frame there.

#pragma once

#include <optional>

#include <tex/preview.h>

#include "preview/camera.h"
#include "preview/vector.h"

namespace tex::inline v1::render {

// A point of a shape. A move by a along the tangent and by b along the binormal changes (u, v) by
// (a u_per_length, b v_per_length).
struct Hit {
    Vec3 point;
    // Towards growing u, towards growing v, outwards. Unit vectors or, of a mesh, T', B' and N' of its decoder.
    Vec3 tangent, binormal, normal;
    Vec2 uv;
    double u_per_length = 0.0, v_per_length = 0.0;  // greater than 0
    int face = 0;                                   // from 1; differs across an edge of the surface
};

// A shape of preview.h, prepared for rays.
class Body {
public:
    Body(const PreviewOptions& options, Extent map);

    // The greatest dot(direction, point) of all points that the shape reaches while it spins, with a margin around
    // solids.
    [[nodiscard]] double support(Vec3 direction) const;

    [[nodiscard]] std::optional<Hit> meet(const Ray& ray) const;
    // The face that the ray meets, 0 if it meets none. Faster than meet().
    [[nodiscard]] int face(const Ray& ray) const;

private:
    [[nodiscard]] double distance(const Ray& ray, int& face) const;
    [[nodiscard]] Hit on_plane(Vec3 point) const;
    [[nodiscard]] Hit on_sphere(Vec3 point) const;
    [[nodiscard]] Hit on_cube(Vec3 point, int face) const;

    Shape shape_;
    double half_width_ = 1.0;  // of the plane; its half-height is 1
    double u_turns_ = 1.0, v_turns_ = 1.0;
    bool mirror_;
};

// The change of (u, v) from `hit` to the point at which `ray` meets the tangent plane of the shape at `hit`; 0 if it
// does not meet that plane.
[[nodiscard]] Vec2 uv_step(const Hit& hit, const Ray& ray);

}  // namespace tex::inline v1::render
