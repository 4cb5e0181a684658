// SPDX-License-Identifier: Apache-2.0

#include "reference/integrate.h"

#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "reference/bake.h"

namespace tex::reference {
namespace {

using Column = std::vector<double>;

double dot(const Column& a, const Column& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

// The slopes to the right and upwards of every texel.
Column slopes_of(const Grid<Vector>& map) {
    Column slopes;
    for (const Vector& n : map.values) {
        slopes.push_back(-n.x / n.z);
        slopes.push_back(-n.y / n.z);
    }
    return slopes;
}

// Slopes are linear in the heights, so those of one texel of height 1 are a column of the matrix. Heights are floats;
// 0 and 1 are exact.
std::vector<Column> columns_of(Extent extent, const IntegrateOptions& options) {
    std::vector<Column> columns;
    HeightField field{Plane<float>(extent, 0.0f), options.bumpiness_x, options.bumpiness_y, options.wrap_x,
                      options.wrap_y};
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            field.height.at(i, j) = 1.0f;
            columns.push_back(slopes_of(reference::bake(field, options.bake)));
            field.height.at(i, j) = 0.0f;
        }
    }
    return columns;
}

Column product(const std::vector<Column>& columns, const Column& heights) {
    Column slopes(columns.front().size());
    for (std::size_t k = 0; k < columns.size(); ++k) {
        for (std::size_t i = 0; i < slopes.size(); ++i) slopes[i] += columns[k][i] * heights[k];
    }
    return slopes;
}

Column transposed_product(const std::vector<Column>& columns, const Column& slopes) {
    Column heights;
    for (const Column& column : columns) heights.push_back(dot(column, slopes));
    return heights;
}

}  // namespace

// Conjugate gradients from 0 on the normal equations stay in the space of what the kernel sees, so the result has the
// smallest mean square.
Grid<double> integrate(const Grid<Vector>& map, const IntegrateOptions& options) {
    const std::vector<Column> columns = columns_of(map.extent, options);
    Grid<double> heights(map.extent);
    Column rest = transposed_product(columns, slopes_of(map));
    Column direction = rest;
    double norm = dot(rest, rest);
    const double enough = 1e-26 * norm;
    for (int step = 0; step < 4000 && norm > enough; ++step) {
        const Column slopes = product(columns, direction);
        const double length = norm / dot(slopes, slopes);
        const Column change = transposed_product(columns, slopes);
        for (std::size_t k = 0; k < rest.size(); ++k) {
            heights.values[k] += length * direction[k];
            rest[k] -= length * change[k];
        }
        const double next = dot(rest, rest);
        for (std::size_t k = 0; k < rest.size(); ++k) direction[k] = rest[k] + next / norm * direction[k];
        norm = next;
    }
    return heights;
}

}  // namespace tex::reference
