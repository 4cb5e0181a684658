// SPDX-License-Identifier: Apache-2.0
// hit_normals.h: the normals of the high mesh at many hits, found together.

#pragma once

#include <cstddef>
#include <vector>

#include "kernels/corner_vectors.h"
#include "rays/high_surface.h"

namespace tex::inline v1 {

class HitNormals {
public:
    static constexpr std::size_t kMost = 512;

    void clear() { places_.clear(); }
    // Precondition: there are fewer than kMost.
    void add(const HighSurface& surface, const Triangles::Triangle& triangle, const HighSurface::Weights& weights);
    // Finds what HighSurface::normal_at() finds.
    void find(const HighSurface& surface);
    // Turns the k-th normal round if it is on the side of its triangle that `face`, the triangle's normal, points to.
    // For triangles that are seen from behind; where their corners alone are the wrong way round, normals stay.
    void turn(std::size_t k, Vector3 face);

    // The triangle and the normal of the k-th hit that was added.
    [[nodiscard]] const Triangles::Triangle& triangle(std::size_t k) const { return places_[k]; }
    [[nodiscard]] Vector3 at(std::size_t k) const { return {normals_.x[k], normals_.y[k], normals_.z[k]}; }

private:
    // Sets the corners of the k-th triangle, which stands in a place.
    void set_placed(std::size_t k, bool mixes);

    std::vector<Triangles::Triangle> places_;
    VectorBlock<kMost> weights_, normals_;
    float corners_[9][kMost + kMoreVectors] = {};  // normals: corner and axis, triangle
};

// Corners of places whose normal is not just mixed become (0, 0, 0), so that find() looks at them alone.
inline void HitNormals::add(const HighSurface& surface, const Triangles::Triangle& triangle,
                            const HighSurface::Weights& weights) {
    const std::size_t k = places_.size();
    places_.push_back(triangle);
    weights_.x[k] = weights[0];
    weights_.y[k] = weights[1];
    weights_.z[k] = weights[2];
    const bool mixes = surface.mixes_normals(triangle);
    if (triangle.place != nullptr) return set_placed(k, mixes);
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const Float3 n = mixes ? triangle.part.normals[triangle.stored_vertex(corner)] : Float3{};
        corners_[3 * corner][k] = n.x;
        corners_[3 * corner + 1][k] = n.y;
        corners_[3 * corner + 2][k] = n.z;
    }
}

}  // namespace tex::inline v1
