// SPDX-License-Identifier: Apache-2.0

#include "rows/blur.h"

#include <algorithm>
#include <cmath>

#include "kernels/bake.h"
#include "kernels/height_field.h"
#include "rows/border.h"
#include "rows/math.h"

namespace tex {
namespace {

// The rows of a plane from `first` on, `count` of them, those beyond the top and the bottom included.
class ExtendedRows {
public:
    ExtendedRows(PlaneView<const float> plane, Wrap wrap, int first, int count)
        : rows_(static_cast<std::size_t>(count)) {
        const auto [width, height] = plane.extent;
        int computed = 0;
        for (int k = 0; k < count; ++k) computed += height_index(wrap, first + k, height).plain() ? 0 : 1;
        if (computed > 0) beyond_ = Plane<float>(Extent{width, computed});
        computed = 0;
        for (int k = 0; k < count; ++k) {
            const HeightIndex at = height_index(wrap, first + k, height);
            const float* row = plane.row(at.index);
            if (!at.plain()) {
                float* out = beyond_.row(computed++);
                continue_heights(row, plane.row(at.edge), plane.row(at.other), at.reflected,
                                 static_cast<float>(at.drift), width, out);
                row = out;
            }
            rows_[static_cast<std::size_t>(k)] = row;
        }
    }
    // Row first + k.
    [[nodiscard]] const float* operator[](int k) const { return rows_[static_cast<std::size_t>(k)]; }

private:
    std::vector<const float*> rows_;
    Plane<float> beyond_;
};

void blur_rows(PlaneView<const float> in, const std::vector<float>& weights, Wrap wrap, int begin, int end,
               Plane<float>& out) {
    const int radius = static_cast<int>(weights.size()) - 1;
    HeightRows rows(in, wrap, wrap, radius, 1);
    for (int j = begin; j < end; ++j) {
        smooth_row(rows.fetch(j), weights.data(), radius, in.extent.width, out.row(j));
    }
}

void blur_columns(PlaneView<const float> in, const std::vector<float>& weights, Wrap wrap, int begin, int end,
                  Plane<float>& out) {
    const int radius = static_cast<int>(weights.size()) - 1;
    const ExtendedRows rows(in, wrap, begin - radius, end - begin + 2 * radius);
    std::vector<const float*> window(static_cast<std::size_t>(2 * radius + 1));
    // Tiles, so that the rows of a window stay in the cache from one row to the next.
    constexpr int kTile = 256;
    for (int i = 0; i < in.extent.width; i += kTile) {
        const int count = std::min(kTile, in.extent.width - i);
        for (int j = begin; j < end; ++j) {
            for (int k = 0; k <= 2 * radius; ++k) window[static_cast<std::size_t>(k)] = rows[j - begin + k] + i;
            smooth_column(window.data(), weights.data(), radius, count, out.row(j) + i);
        }
    }
}

}  // namespace

std::vector<float> gaussian_weights(double sigma) {
    const int radius = static_cast<int>(std::ceil(3.0 * sigma));
    std::vector<double> g;
    double sum = 0.0;
    for (int k = 0; k <= radius; ++k) {
        g.push_back(math::exp(-0.5 * k * k / (sigma * sigma)));
        sum += k == 0 ? g.back() : 2.0 * g.back();
    }
    std::vector<float> weights;
    weights.reserve(g.size());
    for (const double value : g) weights.push_back(static_cast<float>(value / sum));
    return weights;
}

Result<void> blur(Plane<float>& heights, double sigma, Wrap wrap_x, Wrap wrap_y, const Execution& execution,
                  ProgressSpan span) {
    const Extent extent = heights.extent();
    const std::vector<float> weights = gaussian_weights(sigma);
    const int radius = static_cast<int>(weights.size()) - 1;
    const double half = (span.from + span.to) / 2;
    const int strip = std::max(1, (1 << 16) / extent.width);
    Plane<float> across(extent);
    const auto rows = [&](int begin, int end) { blur_rows(heights.view(), weights, wrap_x, begin, end, across); };
    if (auto done = parallel_for(execution, extent.height, strip, rows, {span.from, half}); !done) return done;
    const auto columns = [&](int begin, int end) { blur_columns(across.view(), weights, wrap_y, begin, end, heights); };
    return parallel_for(execution, extent.height, std::max(strip, radius), columns, {half, span.to});
}

}  // namespace tex
