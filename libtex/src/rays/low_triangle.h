// SPDX-License-Identifier: Apache-2.0
// low_triangle.h: the places and the tangent space of a triangle of the low mesh.

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include <tex/types.h>

#include "mesh/frames.h"
#include "rays/triangles.h"

namespace tex::inline v1 {

class LowTriangle {
public:
    LowTriangle() = default;
    LowTriangle(const TangentSpace& space, std::size_t number, Extent extent)
        : frames_(space, number), corners_(Triangles::Triangle{space.part, number}.corners()) {
        double x[3], y[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const Float2 uv =
                space.part.uvs[static_cast<std::size_t>(space.uv_set)][space.part.indices[3 * number + k]];
            const auto v = static_cast<double>(uv.y);
            x[k] = static_cast<double>(uv.x) * extent.width;
            y[k] = (space.part.v_axis == YAxis::up ? 1.0 - v : v) * extent.height;
        }
        const double area = (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]);
        for (std::size_t k = 0; k < 3 && area != 0.0; ++k) {
            const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
            along_x_[k] = (y[a] - y[b]) / area;
            along_y_[k] = (x[b] - x[a]) / area;
        }
    }

    // The places with these weights.
    void points(VectorArrays<const double> weights, std::size_t count, VectorArrays<double> points) const {
        CornerVectors corners;
        copy_to(corners_, corners);
        mix_corners(corners, weights, count, points);
    }

    [[nodiscard]] const CornerFrames& frames() const { return frames_; }

    // The weights so many texels from the triangle with these weights, or these if that is far beyond the triangle.
    [[nodiscard]] std::array<double, 3> moved(const std::array<double, 3>& weights, double x, double y) const {
        std::array<double, 3> there{};
        for (std::size_t k = 0; k < 3; ++k) there[k] = weights[k] + x * along_x_[k] + y * along_y_[k];
        const bool is_near = *std::min_element(there.begin(), there.end()) >= -1.0;
        return is_near ? there : weights;
    }

private:
    CornerFrames frames_;
    std::array<Vector3, 3> corners_;
    std::array<double, 3> along_x_{}, along_y_{};  // how the weights change in a texel
};

}  // namespace tex::inline v1
