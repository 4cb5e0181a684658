// SPDX-License-Identifier: Apache-2.0
// kernels/mip.h: turns rows of one level into a row of the next, and averages into unit vectors.
//
// Works on one plane at a time. Rows may be read and written up to a whole vector (64 bytes) past their last texel,
// unless a comment says otherwise. `count` is in texels of the output.

#pragma once

#include <cstddef>

namespace tex::inline v1 {

// out[i] = weights[0] rows[0][i] + weights[1] rows[1][i] + ..., summed in this order. taps >= 1.
void filter_rows(const float* const* rows, const float* weights, int taps, int count, float* out);

// Writes texels 0, 2, 4, ... of `row` to `even` and 1, 3, 5, ... to `odd`, `count` of each. Reads two vectors past the
// last texel.
void split_row(const float* row, int count, float* even, float* odd);

// out[i] = sum over k of weights[k * stride + i] row[2 i + k], summed in this order, of a row that split_row() has
// split. Every texel has its own weights (odd sizes).
void filter_columns(const float* even, const float* odd, const float* weights, std::ptrdiff_t stride, int taps,
                    int count, float* out);

// Filters with weights[k] for all texels (even sizes).
void filter_columns_evenly(const float* even, const float* odd, const float* weights, int taps, int count, float* out);

// The box filter for sizes that are both halved exactly. Gives the same bytes as filter_rows() and
// filter_columns_evenly() with weights of 1/2. Reads nothing past texel 2 count rounded up to 64 bytes.
void halve_rows(const float* upper, const float* lower, int count, float* out);

// p = x / z and q = y / z with z at least 1/256.
void slopes_of_vectors(const float* x, const float* y, const float* z, int count, float* p, float* q);

// Turns averages into stored values, in place (see build_mip_chain() in mip.h): z becomes at least least_z, and short
// vectors become (0, 0, 1). Vectors are normalised, moved towards (0, 0, 1) by fade (0 to 1), and normalised again.
void finish_vectors(float* x, float* y, float* z, int count, float fade, float least_z = 0.0f);

// Finishes averaged slopes p = x / z in x and q = y / z in y. z is only written.
void finish_slopes(float* x, float* y, float* z, int count, float fade);

}  // namespace tex::inline v1
