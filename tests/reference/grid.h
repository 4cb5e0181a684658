// SPDX-License-Identifier: Apache-2.0
// grid.h: the basic types of the reference. tests/reference implements every formula of libtex again, in double and
// with plain loops, in one file for each concept. Read each file beside the public header that specifies it. It shares
// no code with libtex/src; only the public types come from there.

#pragma once

#include <cstddef>
#include <vector>

#include <tex/types.h>

namespace tex::reference {

struct Vector {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
};

// The values of texels, row by row from the top.
template <class T>
struct Grid {
    Extent extent;
    std::vector<T> values;

    Grid() = default;
    explicit Grid(Extent size) : extent(size), values(static_cast<std::size_t>(size.texels())) {}
    [[nodiscard]] T& at(int i, int j) { return values[index(i, j)]; }
    [[nodiscard]] const T& at(int i, int j) const { return values[index(i, j)]; }

private:
    [[nodiscard]] std::size_t index(int i, int j) const {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(extent.width) + static_cast<std::size_t>(i);
    }
};

// These values in double.
Grid<double> grid_of(const Plane<float>& plane);
Grid<Vector> grid_of(const NormalMap& map);

// v / |v|; (0, 0, 1) if |v| < 1e-6.
Vector normalised(Vector v);

// The angle between two non-zero vectors, in degrees.
double angle_between(Vector a, Vector b);

// The largest angle between texels of a map and of the reference, in degrees. Both must have the same extent.
double largest_angle(const NormalMap& map, const Grid<Vector>& truth);

}  // namespace tex::reference
