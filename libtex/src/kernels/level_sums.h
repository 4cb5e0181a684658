// SPDX-License-Identifier: Apache-2.0
// kernels/level_sums.h: sums over the texels of a stored level, for the comparison with the averages of the base level.

#pragma once

#include <array>

#include "kernels/normal_row.h"

namespace tex::inline v1 {

// s is the stored vector, a the average of the base level, r the normalised average. Squares and products are sums over
// x and y.
struct LevelSums {
    std::array<double, 2> s{}, r{};
    double ss = 0.0, rr = 0.0, rs = 0.0;
    double length = 0.0, average_length = 0.0;             // of s and a
    double normalised_square = 0.0, average_square = 0.0;  // of s - r and s - a
    // Normal equations, over texels with four neighbours, of s - g r = d_x r_x + d_y r_y with central differences
    // r_x (to the right) and r_y (downwards).
    double xx = 0.0, xy = 0.0, yy = 0.0, xr = 0.0, yr = 0.0, xs = 0.0, ys = 0.0;

    void add(const LevelSums& other);
};

// Rows of the components x and y of r.
struct NormalisedRow {
    const float* x;
    const float* y;
};

// A row of a level. `above` and `below` are null at the borders. r is also read one texel before the row.
struct LevelRow {
    VectorRow s, a;
    NormalisedRow r, above, below;
};

// Adds a row to `sums`. Rows may be read up to a whole vector (64 bytes) past their last texel. Sums are made in 16
// lanes of floats for each 256 texels.
void add_level_row(const LevelRow& row, int count, LevelSums& sums);

}  // namespace tex::inline v1
