// SPDX-License-Identifier: Apache-2.0

#include "reference/grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tex::reference {

Grid<double> grid_of(const Plane<float>& plane) {
    Grid<double> grid(plane.extent());
    for (int j = 0; j < plane.extent().height; ++j) {
        for (int i = 0; i < plane.extent().width; ++i) grid.at(i, j) = static_cast<double>(plane.at(i, j));
    }
    return grid;
}

Grid<Vector> grid_of(const NormalMap& map) {
    Grid<Vector> grid(map.extent());
    for (int j = 0; j < map.extent().height; ++j) {
        for (int i = 0; i < map.extent().width; ++i) {
            grid.at(i, j) = {static_cast<double>(map.x.at(i, j)), static_cast<double>(map.y.at(i, j)),
                             static_cast<double>(map.z.at(i, j))};
        }
    }
    return grid;
}

Vector normalised(Vector v) {
    const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    if (length < 1e-6) return {0.0, 0.0, 1.0};
    return {v.x / length, v.y / length, v.z / length};
}

double angle_between(Vector a, Vector b) {
    const Vector cross{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    const double sine = std::sqrt(cross.x * cross.x + cross.y * cross.y + cross.z * cross.z);
    const double cosine = a.x * b.x + a.y * b.y + a.z * b.z;
    return std::atan2(sine, cosine) * 180.0 / std::numbers::pi;
}

double largest_angle(const NormalMap& map, const Grid<Vector>& truth) {
    if (map.extent() != truth.extent) return std::numeric_limits<double>::infinity();
    const Grid<Vector> grid = grid_of(map);
    double largest = 0.0;
    for (std::size_t k = 0; k < grid.values.size(); ++k) {
        const double angle = angle_between(grid.values[k], truth.values[k]);
        if (!(angle <= largest)) largest = angle;  // NaN too
    }
    return largest;
}

}  // namespace tex::reference
