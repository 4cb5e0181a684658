// SPDX-License-Identifier: Apache-2.0

#include "rows/curvature_rows.h"

#include <algorithm>

#include "kernels/slopes.h"
#include "rows/border.h"

namespace tex::inline v1 {
namespace {

constexpr float kLeastZ = 1e-6f;
constexpr int kX = 0, kAbove = 1, kBelow = 2, kScratch = 3, kRows = 4;

}  // namespace

// A quarter: half a central difference, of which the sum is halved. Slopes have the opposite sign of x and y.
CurvatureRows::CurvatureRows(const NormalMap& map, bool of_slopes, Wrap wrap_x, Wrap wrap_y)
    : map_(map), of_slopes_(of_slopes), wrap_x_(wrap_x), wrap_y_(wrap_y),
      factor_x_(map.extent().width > 1 ? (of_slopes ? -0.25f : 0.25f) : 0.0f),
      factor_y_(map.extent().height > 1 ? (of_slopes ? -0.25f : 0.25f) : 0.0f),
      rows_(Extent{2 * aligned_count(1) + map.extent().width, kRows}, 0.0f) {}

// The components x and y of row j, or the slopes.
void CurvatureRows::load(int j, float* x, float* y) const {
    const int width = map_.extent().width;
    const VectorRow normals = {map_.x.row(j), map_.y.row(j), map_.z.row(j)};
    if (of_slopes_) {
        slopes_of_normals(normals, kLeastZ, width, x, y);
        return;
    }
    std::copy_n(map_.x.row(j), width, x);
    std::copy_n(map_.y.row(j), width, y);
    zero_without_normal(normals, width, x);
    zero_without_normal(normals, width, y);
}

CurvatureRows::Neighbour CurvatureRows::neighbour(Wrap wrap, int i, int n) {
    if (i >= 0 && i < n) return {i, 1.0f};
    return {border_index(wrap, i, n), wrap == Wrap::mirror ? -1.0f : 1.0f};
}

void CurvatureRows::make(int j, float* out) {
    const int width = map_.extent().width, height = map_.extent().height;
    const int lead = aligned_count(1);
    float* const x = rows_.row(kX) + lead;
    float* const scratch = rows_.row(kScratch) + lead;
    const auto load_y = [&](int row, float* y) {
        const Neighbour from = neighbour(wrap_y_, row, height);
        load(from.index, scratch, y);
        if (from.sign < 0.0f) shift_and_scale(0.0f, from.sign, width, y);
    };
    float* const above = rows_.row(kAbove) + lead;
    float* const below = rows_.row(kBelow) + lead;
    load_y(j - 1, above);
    load_y(j + 1, below);
    load(j, x, scratch);
    const bool at_border = wrap_y_ == Wrap::clamp && (j == 0 || j == height - 1);
    for (const int i : {-1, width}) {
        const Neighbour from = neighbour(wrap_x_, i, width);
        x[i] = from.sign * x[from.index];
    }
    // At a clamped border, the row itself takes the place of the missing one: twice the difference is one-sided.
    sum_differences(x + 1, x - 1, factor_x_, above, below, at_border ? 2.0f * factor_y_ : factor_y_, width, out);
    if (wrap_x_ != Wrap::clamp || width < 2) return;
    for (const int i : {0, width - 1}) out[i] += factor_x_ * (x[i + 1] - x[i - 1]);
}

double sum_of_squares(const float* values, int count) {
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
        const double value = values[i];
        sum += value * value;
    }
    return sum;
}

}  // namespace tex::inline v1
