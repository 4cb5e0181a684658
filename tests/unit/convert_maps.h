// SPDX-License-Identifier: Apache-2.0
// convert_maps.h: normal maps and a square for tests of conversions.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <tex/mesh.h>

#include "unit/meshes.h"
#include "unit/solids.h"

namespace tex {

inline Float3 vector_at(const NormalMap& map, int i, int j) { return {map.x.at(i, j), map.y.at(i, j), map.z.at(i, j)}; }

inline NormalMap constant_map(Extent extent, Float3 n) {
    NormalMap map;
    map.x = Plane<float>(extent, n.x);
    map.y = Plane<float>(extent, n.y);
    map.z = Plane<float>(extent, n.z);
    return map;
}

inline NormalMap bumpy_map(Extent extent) {
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const Float3 n = unit_vector({0.6f * std::sin(0.3f * static_cast<float>(i)),
                                          0.5f * std::cos(0.2f * static_cast<float>(j + i)), 1.0f});
            map.x.at(i, j) = n.x;
            map.y.at(i, j) = n.y;
            map.z.at(i, j) = n.z;
        }
    }
    return map;
}

inline double degrees_between(Float3 a, Float3 b) {
    const double dx = static_cast<double>(a.x) - static_cast<double>(b.x),
                 dy = static_cast<double>(a.y) - static_cast<double>(b.y),
                 dz = static_cast<double>(a.z) - static_cast<double>(b.z);
    return 2.0 * std::asin(std::min(1.0, std::sqrt(dx * dx + dy * dy + dz * dz) / 2.0)) * 57.29577951308232;
}

struct Angles {
    double mean = 0.0, max = 0.0;
    int texels = 0;
};

// Over the texels that triangles cover.
inline Angles angles_between(const NormalMap& a, const NormalMap& b, const Plane<Coverage>& coverage) {
    Angles angles;
    for (int j = 0; j < a.extent().height; ++j) {
        for (int i = 0; i < a.extent().width; ++i) {
            if (coverage.at(i, j) != Coverage::triangle) continue;
            const double angle = degrees_between(vector_at(a, i, j), vector_at(b, i, j));
            ++angles.texels;
            angles.mean += angle;
            angles.max = std::max(angles.max, angle);
        }
    }
    angles.mean /= std::max(1, angles.texels);
    return angles;
}

inline int count(const ConvertedMap& converted, Coverage wanted) {
    int texels = 0;
    for (int j = 0; j < converted.map.extent().height; ++j) {
        const Coverage* const row = converted.coverage.row(j);
        texels += static_cast<int>(std::count(row, row + converted.map.extent().width, wanted));
    }
    return texels;
}

// A square in the middle of the map, with `triangles` copies of each of its two triangles.
inline MeshPart square(float low, float high, int copies = 1) {
    MeshPart part;
    part.uvs.resize(1);
    for (const auto& [x, y] : {std::pair{low, low}, {high, low}, {high, high}, {low, high}}) {
        part.positions.push_back({x, y, 0.0f});
        part.normals.push_back({0.0f, 0.0f, 1.0f});
        part.uvs[0].push_back({x, y});
    }
    for (int k = 0; k < copies; ++k) {
        for (const std::uint32_t v : {0u, 1u, 2u, 0u, 2u, 3u}) part.indices.push_back(v);
    }
    return part;
}

}  // namespace tex
