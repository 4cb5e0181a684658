// SPDX-License-Identifier: Apache-2.0
// wavy_sphere.h: a sphere with waves, and the rays that transfer() casts at it, for benchmarks.

#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <tex/mesh.h>

#include "kernels/trace.h"

namespace tex::bench {

inline MeshPart wavy_sphere(int columns, int rows, float waves) {
    MeshPart part;
    part.uvs.resize(1);
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            const float u = static_cast<float>(i) / static_cast<float>(columns),
                        v = static_cast<float>(j) / static_cast<float>(rows);
            const float a = 6.2831853f * u, b = 3.1415927f * (v - 0.5f);
            const Float3 n{std::cos(a) * std::cos(b), std::sin(b), -std::sin(a) * std::cos(b)};
            const float r = 1.0f + waves * std::sin(40.0f * a) * std::sin(40.0f * b);
            part.positions.push_back({r * n.x, r * n.y, r * n.z});
            part.normals.push_back(n);
            part.uvs[0].push_back({u, v});
        }
    }
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const auto a = static_cast<std::uint32_t>(j * (columns + 1) + i),
                       c = a + static_cast<std::uint32_t>(columns) + 1;
            for (const std::uint32_t k : {a, a + 1, c + 1, a, c + 1, c}) part.indices.push_back(k);
        }
    }
    return part;
}

// A ray for each texel, as transfer() casts them.
inline std::vector<Ray> rays_at(int size, double reach) {
    std::vector<Ray> rays;
    for (int j = 0; j < size; ++j) {
        for (int i = 0; i < size; ++i) {
            const double a = 6.283185307 * (i + 0.5) / size, b = 3.141592654 * ((j + 0.5) / size - 0.5);
            const double n[3] = {std::cos(a) * std::cos(b), std::sin(b), -std::sin(a) * std::cos(b)};
            const double far = 1.0 + reach;
            rays.push_back({{far * n[0], far * n[1], far * n[2]}, {-n[0], -n[1], -n[2]}, 2.0 * reach, Facing::front});
        }
    }
    return rays;
}

}  // namespace tex::bench
