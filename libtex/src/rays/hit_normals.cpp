// SPDX-License-Identifier: Apache-2.0

#include "rays/hit_normals.h"

namespace tex::inline v1 {

void HitNormals::set_placed(std::size_t k, bool mixes) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const Float3 n = mixes ? places_[k].normal(corner) : Float3{};
        corners_[3 * corner][k] = n.x;
        corners_[3 * corner + 1][k] = n.y;
        corners_[3 * corner + 2][k] = n.z;
    }
}

void HitNormals::find(const HighSurface& surface) {
    const float* rows[9];
    for (std::size_t row = 0; row < 9; ++row) rows[row] = corners_[row];
    if (mix_normals(rows, weights_.all(), places_.size(), normals_.all())) return;
    for (std::size_t k = 0; k < places_.size(); ++k) {
        const Vector3 mixed = at(k);
        if (dot(mixed, mixed) > 0.0) continue;
        const Vector3 normal = surface.normal_at(places_[k], {weights_.x[k], weights_.y[k], weights_.z[k]});
        normals_.x[k] = normal.x;
        normals_.y[k] = normal.y;
        normals_.z[k] = normal.z;
    }
}

void HitNormals::turn(std::size_t k, Vector3 face) {
    if (!(dot(at(k), face) > 0.0)) return;
    normals_.x[k] = -normals_.x[k];
    normals_.y[k] = -normals_.y[k];
    normals_.z[k] = -normals_.z[k];
}

}  // namespace tex::inline v1
