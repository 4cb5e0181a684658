// SPDX-License-Identifier: Apache-2.0

#include "reference/blur.h"

#include <cmath>

#include "reference/bake.h"

namespace tex::reference {

Grid<double> blur(const Grid<double>& heights, double sigma, Wrap wrap_x, Wrap wrap_y) {
    if (sigma == 0.0) return heights;
    const int radius = static_cast<int>(std::ceil(3.0 * sigma));
    const auto g = [&](int k) { return std::exp(-k * k / (2.0 * sigma * sigma)); };
    double sum = 0.0;
    for (int k = -radius; k <= radius; ++k) sum += g(k);

    const auto along = [&](const Grid<double>& in, int step_x, int step_y) {
        Grid<double> out(in.extent);
        for (int j = 0; j < in.extent.height; ++j) {
            for (int i = 0; i < in.extent.width; ++i) {
                for (int k = -radius; k <= radius; ++k) {
                    out.at(i, j) += g(k) / sum * height_at(in, wrap_x, wrap_y, i + k * step_x, j + k * step_y);
                }
            }
        }
        return out;
    };
    return along(along(heights, 1, 0), 0, 1);
}

}  // namespace tex::reference
