// SPDX-License-Identifier: Apache-2.0
// kernels/bilinear.h: rows of bilinear samples. Rows are padded to whole vectors, which are read and written past the
// last sample.

#pragma once

#include <cstdint>

#include <tex/height.h>

namespace tex::inline v1 {

// Along one axis of texels, sample i lies between texels first[i] and second[i], at weight[i] from the first (0) to the
// second (1).
struct TapRow {
    std::int32_t* first;
    std::int32_t* second;
    float* weight;
};

// Taps of samples 0 <= i < count at (start + step (i + 1/2)) + rest widths of an axis of n texels, in double precision.
// Texel centres are at half texels. `wrap` says which texels follow beyond the border. Precondition: |start|, |step|
// count and |rest| below 2^40; count padded to whole vectors.
void tap_row(double start, double step, double rest, Wrap wrap, int n, int count, TapRow taps);

// If the taps of a vector lie within two vectors of texels, these are loaded and permuted, which takes a fifth of the
// time of a gather. For the taps of vector k, writes the first of those texels to start[k]; or -1, if the taps are too
// far apart or not all within a row of `readable` texels. `start` has room for `count`.
void find_runs(const TapRow& taps, int count, int readable, std::int32_t* start);

// Samples between two rows of texels, `weight` from the upper to the lower: out = mix(mix(upper), mix(lower)), where
// mix(a, b, t) = a (1 - t) + b t. `runs` is what find_runs() found for the columns, on the same instruction set.
void bilinear_row(const float* upper, const float* lower, const TapRow& columns, const std::int32_t* runs, float weight,
                  int count, float* out);

}  // namespace tex::inline v1
