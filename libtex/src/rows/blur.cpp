// SPDX-License-Identifier: Apache-2.0

#include "rows/blur.h"

#include <algorithm>
#include <cmath>

#include "kernels/height_field.h"
#include "rows/border.h"
#include "rows/math.h"

namespace tex::inline v1 {

WorkingVector<float> gaussian_weights(double sigma) {
    const int radius = static_cast<int>(std::ceil(3.0 * sigma));
    WorkingVector<double> g;
    g.reserve(static_cast<std::size_t>(radius) + 1);
    double sum = 0.0;
    for (int k = 0; k <= radius; ++k) {
        g.push_back(math::exp(-0.5 * k * k / (sigma * sigma)));
        sum += k == 0 ? g.back() : 2.0 * g.back();
    }
    WorkingVector<float> weights;
    weights.reserve(g.size());
    for (const double value : g) weights.push_back(static_cast<float>(value / sum));
    return weights;
}

void blur_across(PlaneView<const float> heights, std::span<const float> weights, Wrap wrap_x, int begin, int end,
                 Plane<float>& across) {
    const int radius = static_cast<int>(weights.size()) - 1;
    HeightRows rows(heights, wrap_x, wrap_x, radius, 1);
    for (int j = begin; j < end; ++j)
        smooth_row(rows.fetch(j), weights.data(), radius, heights.extent.width, across.row(j));
}

void blur_down(PlaneView<const float> across, std::span<const float> weights, Wrap wrap_y, int begin, int end,
               Plane<float>& out) {
    const int radius = static_cast<int>(weights.size()) - 1;
    const auto [width, height] = across.extent;
    const RowOf row_of = [&across](int j) { return across.row(j); };
    // All rows of the windows, including those beyond the border, which are computed unless they are plain copies.
    const int first = begin - radius, count = end - begin + 2 * radius;
    const int above = std::max(0, -first), below = std::max(0, first + count - height);
    Plane<float> beyond;
    if (wrap_y == Wrap::clamp && above + below > 0) beyond = Plane<float>(Extent{width, above + below});
    WorkingVector<const float*> rows;
    rows.reserve(static_cast<std::size_t>(count));
    for (int j = first, computed = 0; j < first + count; ++j) {
        const bool outside = wrap_y == Wrap::clamp && (j < 0 || j >= height);
        rows.push_back(height_row(row_of, across.extent, wrap_y, j, outside ? beyond.row(computed++) : nullptr));
    }
    WorkingVector<const float*> window(static_cast<std::size_t>(2 * radius + 1));
    // Work in tiles, so that the rows of a window stay in the cache from one row to the next.
    constexpr int kTile = 256;
    for (int i = 0; i < width; i += kTile) {
        for (int j = begin; j < end; ++j) {
            const auto top = rows.begin() + (j - begin);
            std::transform(top, top + static_cast<std::ptrdiff_t>(window.size()), window.begin(),
                           [i](const float* row) { return row + i; });
            smooth_column(window.data(), weights.data(), radius, std::min(kTile, width - i), out.row(j) + i);
        }
    }
}

}  // namespace tex::inline v1
