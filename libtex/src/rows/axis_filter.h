// SPDX-License-Identifier: Apache-2.0
// axis_filter.h: the weights that turn one axis of a level into that of the next smaller level.

#pragma once

#include <cstddef>

#include <tex/mip.h>
#include <tex/types.h>

#include "memory/lent_memory.h"

namespace tex::inline v1 {

// At least the taps of any filter: the widest reaches 3 texels of the smaller level to each side, which has at least a
// third as many texels as the larger one; footprints of odd sizes may begin one texel apart.
inline constexpr int kMostTaps = 24;

// Texel i of the smaller level is the sum over k of weight(k, i) texel[2 i + first + k], 0 <= k < taps, of the larger
// level, in which the texel may lie beyond the border. (If the larger size is odd, texels are a little more than 2
// apart, by less than 1 over the whole axis. The window is wide enough for that.) Weights are computed in double
// (rows/math.h), normalised to a sum of 1 and rounded to float once.
struct AxisFilter {
    int first = 0;
    int taps = 1;
    bool even = false;             // the larger size is even: all texels have the same weights
    std::ptrdiff_t stride = 0;     // of the weights: the number of texels, padded to whole vectors
    WorkingVector<float> weights;  // [k * stride + i]

    [[nodiscard]] float weight(int k, int i) const { return weights[static_cast<std::size_t>(k * stride + i)]; }
};

// The filter from n texels to max(1, n / 2).
AxisFilter make_axis_filter(MipFilter filter, int n);

// At least its number of taps.
int most_taps(MipFilter filter, int n);

// Filters rows along their length, one after the other, including the texels beyond their ends.
class RowFilter {
public:
    // `filter` comes from make_axis_filter(..., width) and must outlive this object.
    RowFilter(const AxisFilter& filter, Wrap wrap, int width);

    // Write the row here before run(): `width` texels, with room for whole vectors.
    [[nodiscard]] float* row() { return row_.row(0) + lead_; }

    // Filters the row into `out`, which has max(1, width / 2) texels and room for whole vectors. The row's texels do
    // not change.
    void run(float* out);

private:
    const AxisFilter& filter_;
    const Wrap wrap_;
    const int width_;
    const int count_;           // texels of the result
    const int before_, after_;  // texels needed beyond each end
    const int lead_;
    const int pairs_;  // texels in each half of the row: even ones, then odd ones
    Plane<float> row_;
    Plane<float> halves_;
    WorkingVector<float> weights_;  // the weights that all texels share, if the size is even
};

}  // namespace tex::inline v1
