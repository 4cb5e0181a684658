// SPDX-License-Identifier: Apache-2.0
// normal_maps.h: normal maps for tests.

#pragma once

#include <cmath>
#include <utility>

#include <tex/types.h>

namespace tex {

// Normals that lean in all directions by up to about 60 degrees, with features of a few texels; `phase` gives another
// map.
inline NormalMap wavy_map(Extent extent, double phase = 0.0) {
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double x = std::sin(0.31 * i + 0.07 * j + phase) + 0.3 * std::sin(1.7 * i - phase);
            const double y = std::cos(0.23 * j - 0.11 * i + phase) + 0.3 * std::cos(1.3 * j + 0.5 * i);
            const double length = std::sqrt(x * x + y * y + 1);
            map.x.at(i, j) = static_cast<float>(x / length);
            map.y.at(i, j) = static_cast<float>(y / length);
            map.z.at(i, j) = static_cast<float>(1 / length);
        }
    }
    return map;
}

// One vector everywhere, of any length.
inline NormalMap uniform_map(Extent extent, float x, float y, float z) {
    NormalMap map;
    map.x = Plane<float>(extent, x);
    map.y = Plane<float>(extent, y);
    map.z = Plane<float>(extent, z);
    return map;
}

inline NormalMap flat_map(Extent extent) { return uniform_map(extent, 0.0f, 0.0f, 1.0f); }

inline NormalMap copy_of(const NormalMap& map) {
    NormalMap copy;
    copy.x = map.x.clone();
    copy.y = map.y.clone();
    copy.z = map.z.clone();
    return copy;
}

inline MipChain chain_from(NormalMap map) {
    MipChain chain;
    chain.levels.push_back(std::move(map));
    return chain;
}

}  // namespace tex
