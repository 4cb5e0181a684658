// SPDX-License-Identifier: Apache-2.0
// solids.h: coarse meshes of simple solids with smooth normals, and the normals that a flat surface has on them. For
// tests that compare with a tolerance.

#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <tex/mesh.h>
#include <tex/types.h>

#include "unit/meshes.h"

namespace tex {

struct Solid {
    std::string name;
    MeshPart part;
    std::function<Float3(float u, float v)> normal;  // of the surface at a place of the map, v up
};

// A grid of quads over the whole map. `at` returns a point of the surface, `normal` its normal.
inline MeshPart grid_part(int columns, int rows, const std::function<Float3(float, float)>& at,
                          const std::function<Float3(float, float)>& normal) {
    MeshPart part;
    part.uvs.resize(1);
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            const float u = static_cast<float>(i) / static_cast<float>(columns),
                        v = static_cast<float>(j) / static_cast<float>(rows);
            part.positions.push_back(at(u, v));
            part.normals.push_back(normal(u, v));
            part.uvs[0].push_back({u, v});
        }
    }
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const auto a = static_cast<std::uint32_t>(j * (columns + 1) + i);
            const auto c = a + static_cast<std::uint32_t>(columns) + 1;
            for (const std::uint32_t k : {a, a + 1, c + 1, a, c + 1, c}) part.indices.push_back(k);
        }
    }
    return part;
}

// 16 segments, 8 rings, without the caps beyond 80 degrees, where a map of this kind has no tangents.
inline Solid sphere() {
    const auto normal = [](float u, float v) -> Float3 {
        const float a = 6.2831853f * u, b = 2.7925268f * (v - 0.5f);
        return {std::cos(a) * std::cos(b), std::sin(b), -std::sin(a) * std::cos(b)};
    };
    return {"sphere", grid_part(16, 8, normal, normal), normal};
}

// Radii 1 and 0.4, 16 by 8 segments.
inline Solid torus() {
    const auto normal = [](float u, float v) -> Float3 {
        const float a = 6.2831853f * u, b = 6.2831853f * v;
        return {std::cos(a) * std::cos(b), std::sin(b), -std::sin(a) * std::cos(b)};
    };
    const auto at = [normal](float u, float v) -> Float3 {
        const Float3 n = normal(u, v);
        const float a = 6.2831853f * u;
        return {std::cos(a) + 0.4f * n.x, 0.4f * n.y, -std::sin(a) + 0.4f * n.z};
    };
    return {"torus", grid_part(16, 8, at, normal), normal};
}

// Golus's cube: twelve triangles whose normals are smooth over edges of 90 degrees. Its faces are flat. The charts are
// a grid of 3 by 2 with borders.
inline Solid smooth_cube() {
    struct Face {
        Float3 n, u, v;
    };
    static const Face faces[6] = {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                  {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                                  {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}}};
    Solid cube;
    cube.name = "cube";
    cube.part.uvs.resize(1);
    for (int f = 0; f < 6; ++f) {
        const auto [n, u, v] = faces[f];
        const auto first = static_cast<std::uint32_t>(cube.part.positions.size());
        for (int k = 0; k < 4; ++k) {
            const float s = k == 1 || k == 2 ? 1.0f : -1.0f, t = k >= 2 ? 1.0f : -1.0f;
            const Float3 p{n.x + s * u.x + t * v.x, n.y + s * u.y + t * v.y, n.z + s * u.z + t * v.z};
            cube.part.positions.push_back(p);
            cube.part.normals.push_back(unit_vector(p));
            cube.part.uvs[0].push_back({(static_cast<float>(f % 3) + 0.5f + 0.4f * s) / 3.0f,
                                        (static_cast<float>(f / 3) + 0.5f + 0.4f * t) / 2.0f});
        }
        for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) cube.part.indices.push_back(first + k);
    }
    cube.normal = [](float u, float v) { return faces[static_cast<int>(3.0f * u) + 3 * static_cast<int>(2.0f * v)].n; };
    return cube;
}

// The map in object space of the solid's surface.
inline NormalMap surface_map(const Solid& solid, Extent extent) {
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const Float3 n = solid.normal((static_cast<float>(i) + 0.5f) / static_cast<float>(extent.width),
                                          1.0f - (static_cast<float>(j) + 0.5f) / static_cast<float>(extent.height));
            map.x.at(i, j) = n.x;
            map.y.at(i, j) = n.y;
            map.z.at(i, j) = n.z;
        }
    }
    return map;
}

}  // namespace tex
