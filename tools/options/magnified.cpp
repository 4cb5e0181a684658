// SPDX-License-Identifier: Apache-2.0

#include "options/magnified.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace tex::cli {
namespace {

// Two texels of a row or column, and the weight of the second one.
struct Between {
    int first, second;
    float weight;
};

std::vector<Between> places(int from, int to) {
    std::vector<Between> all(static_cast<std::size_t>(to));
    for (int i = 0; i < to; ++i) {
        const double at = (i + 0.5) * from / to - 0.5, below = std::floor(at);
        const int first = (static_cast<int>(below) + from) % from;
        all[static_cast<std::size_t>(i)] = {first, (first + 1) % from, static_cast<float>(at - below)};
    }
    return all;
}

}  // namespace

NormalMap magnified(const NormalMap& map, Extent extent) {
    NormalMap large(extent);
    const std::vector<Between> columns = places(map.extent().width, extent.width);
    const std::vector<Between> rows = places(map.extent().height, extent.height);
    const auto sample = [](const Plane<float>& plane, const Between& column, const Between& row) {
        const float *const upper = plane.row(row.first), *const lower = plane.row(row.second);
        const float a = upper[column.first] + column.weight * (upper[column.second] - upper[column.first]);
        const float b = lower[column.first] + column.weight * (lower[column.second] - lower[column.first]);
        return a + row.weight * (b - a);
    };
    for (int j = 0; j < extent.height; ++j) {
        const Between& row = rows[static_cast<std::size_t>(j)];
        for (int i = 0; i < extent.width; ++i) {
            const Between& column = columns[static_cast<std::size_t>(i)];
            const float x = sample(map.x, column, row), y = sample(map.y, column, row), z = sample(map.z, column, row);
            const float length = std::sqrt(x * x + y * y + z * z);
            const bool points = length > 1e-6f;  // opposite vectors cancel
            large.x.at(i, j) = points ? x / length : 0.0f;
            large.y.at(i, j) = points ? y / length : 0.0f;
            large.z.at(i, j) = points ? z / length : 1.0f;
        }
    }
    return large;
}

}  // namespace tex::cli
