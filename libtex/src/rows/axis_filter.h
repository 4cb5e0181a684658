// SPDX-License-Identifier: Apache-2.0
// axis_filter.h: the weights with which one axis of a level becomes that of the next smaller one.

#pragma once

#include <cstddef>
#include <vector>

#include <tex/image.h>
#include <tex/mip.h>

namespace tex {

// Texel i of the smaller level is the sum over k of weight(k, i) texel[2 i + first + k], 0 <= k < taps, of
// the larger one, which may lie beyond the border. (From an odd size texels are a little more than 2 apart,
// by less than 1 over the whole axis: the window is wide enough for that.) Weights are computed in double
// (base/math.h), normalised to sum 1 and rounded to float once.
struct AxisFilter {
    int first = 0;
    int taps = 1;
    bool even = false;           // from an even size: all texels have the same weights
    std::ptrdiff_t stride = 0;   // of the weights: the number of texels padded for whole vectors
    std::vector<float> weights;  // [k * stride + i]

    [[nodiscard]] float weight(int k, int i) const { return weights[static_cast<std::size_t>(k * stride + i)]; }
};

// From n texels to max(1, n / 2).
AxisFilter make_axis_filter(MipFilter filter, int n);

// Filters rows across, one after the other, with what lies beyond their ends.
class RowFilter {
public:
    // `filter` is from make_axis_filter(..., width) and must outlive this.
    RowFilter(const AxisFilter& filter, Wrap wrap, int width);

    // Where the row goes before run(): `width` texels, and room for whole vectors.
    [[nodiscard]] float* row() { return row_.row(0) + lead_; }

    // Filters the row into `out`, max(1, width / 2) texels with room for whole vectors. The row's texels stay.
    void run(float* out);

private:
    const AxisFilter& filter_;
    const Wrap wrap_;
    const int width_;
    const int count_;           // texels of the result
    const int before_, after_;  // texels that are needed beyond the ends
    const int lead_;
    const int pairs_;  // texels in each half of the row: the even ones, the odd ones
    Plane<float> row_;
    Plane<float> halves_;
    std::vector<float> weights_;  // those of every texel, from an even size
};

}  // namespace tex
