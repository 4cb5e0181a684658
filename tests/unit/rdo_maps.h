// SPDX-License-Identifier: Apache-2.0
// rdo_maps.h: maps for the tests of rate-distortion optimisation, and the angles that they measure, in double.

#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <tex/pack.h>

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

// The promise of RdoOptions{0.5, 4}, of the angles before and after, and what the report says of them. `rounding` is
// that of means.
inline void expect_promise(const RdoReport& report, const std::vector<double>& plain, const std::vector<double>& angles,
                           double rounding) {
    constexpr double kRounding = 0.02;  // the library computes in float
    EXPECT_LE(mean_of(angles), mean_of(plain) + 0.5 + rounding);
    double most_raised = 0.0;
    for (std::size_t k = 0; k < angles.size(); ++k) {
        EXPECT_LE(angles[k], std::max(plain[k], 4.0) + kRounding) << k;
        if (angles[k] > plain[k] + kRounding) most_raised = std::max(most_raised, angles[k]);
    }
    EXPECT_NEAR(report.plain_mean, mean_of(plain), rounding);
    EXPECT_NEAR(report.mean, mean_of(angles), rounding);
    EXPECT_LE(report.most_growth, 0.5);
    EXPECT_LE(report.most_raised, 4.0);
    EXPECT_GE(report.most_raised, most_raised - kRounding);
}

}  // namespace tex
