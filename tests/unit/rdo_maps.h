// SPDX-License-Identifier: Apache-2.0
// rdo_maps.h: maps for the tests of rate-distortion optimisation, and the angles that they measure, in double.

#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <tex/types.h>

namespace tex {

// The angle between two normals of which x and y are known, in degrees: z is rebuilt, and the vector made unit.
inline double angle_between(const double* n, const double* m) {
    const auto z = [](const double* v) { return std::sqrt(1.0 - std::min(1.0, v[0] * v[0] + v[1] * v[1])); };
    const auto length = [](const double* v) { return std::max(1.0, std::hypot(v[0], v[1])); };
    const double a = length(n), b = length(m);
    const double chord = std::hypot(n[0] / a - m[0] / b, n[1] / a - m[1] / b, z(n) - z(m));
    return 2.0 * std::asin(std::min(1.0, chord / 2.0)) * 180.0 / 3.14159265358979323846;
}

inline double mean_of(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

// Directions without any order, up to 64 degrees from z.
inline NormalMap noise(Extent extent) {
    NormalMap map(extent);
    std::mt19937 random(3);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double angle = static_cast<double>(random() % 6283) / 1000.0;
            const double length = static_cast<double>(random() % 901) / 1000.0;
            map.x.at(i, j) = static_cast<float>(length * std::cos(angle));
            map.y.at(i, j) = static_cast<float>(length * std::sin(angle));
            map.z.at(i, j) = static_cast<float>(std::sqrt(1.0 - length * length));
        }
    }
    return map;
}

// Flat, but for one steep texel in every third block.
inline NormalMap spikes(Extent extent) {
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const bool is_spike = i % 12 == 5 && j % 4 == 2;
            map.x.at(i, j) = is_spike ? 0.8f : 0.0f;
            map.y.at(i, j) = 0.0f;
            map.z.at(i, j) = is_spike ? 0.6f : 1.0f;
        }
    }
    return map;
}

// Normals at the rim, which lie in the plane of the map: what blocks decode to is often longer than 1.
inline NormalMap rim(Extent extent) {
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const double angle = 0.2 * i + 0.07 * j + 0.05 * std::sin(0.9 * j);
            map.x.at(i, j) = static_cast<float>(std::cos(angle));
            map.y.at(i, j) = static_cast<float>(std::sin(angle));
            map.z.at(i, j) = 0.0f;
        }
    }
    return map;
}

}  // namespace tex
