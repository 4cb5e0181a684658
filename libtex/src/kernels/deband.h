// SPDX-License-Identifier: Apache-2.0
// kernels/deband.h: rows of heights in steps ("codes"), their bounds, and their bending.
//
// Rows may be read and written up to a whole vector (64 bytes) past their last texel. `count` is in texels of the
// output. Codes may be NaN: no height is known there.

#pragma once

namespace tex {

// The bounds of heights without a code.
inline constexpr float kUnbounded = 1e30f;

// In place: the number of the step that each height lies on. NaN stays.
void codes_of_heights(float lowest, float step, int count, float* row);

// In place: the heights `row`, in steps, become lowest + step row. If that does not round to the code, it is replaced
// by the height of the code; without a code, by NaN.
void heights_of_codes(const float* codes, float lowest, float step, int count, float* row);

// The bounds of the heights: half a step around the code, from `least` to `greatest`.
void bounds_of_codes(const float* codes, float least, float greatest, int count, float* low, float* high);

// out[i] = a[i] + factor (a[i] - b[i]).
void extrapolate_row(const float* a, const float* b, float factor, int count, float* out);

// out[i] = (above[i] + below[i]) + (row[i - 1] + row[i + 1]) - 4 row[i], for i from -1 to count.
void laplace_row(const float* above, const float* row, const float* below, int count, float* out);

// row[i] = row[i]^2, at most 1e6; 0 for NaN.
void square_row(int count, float* row);

// One step of the projected gradient. The rows of Laplacians begin at texel -1, as laplace_row() writes them.
struct BendingRow {
    const float* above;  // Laplacians of the rows above, at and below
    const float* at;
    const float* below;
    const float* heights;
    const float* codes;
    const float* weights;
    const float* low;
    const float* high;
};
void relax_row(const BendingRow& in, int count, float* out);

// Rows for a grid of half the size. Two rows of `2 count` texels become one.
void halve_codes(const float* upper, const float* lower, int count, float* out);  // the mean of those that are not NaN
void halve_means(const float* upper, const float* lower, int count, float* out);
// The largest of the lower bounds and the smallest of the upper ones, in order.
struct BoundsRow {
    const float* low;
    const float* high;
};
void halve_bounds(BoundsRow upper, BoundsRow lower, int count, float* low, float* high);

// Rows for a grid of twice the size: out[2 i] = 3/4 row[i] + 1/4 row[i - 1], out[2 i + 1] = 3/4 row[i] + 1/4 row[i +
// 1]. `count` is that of `row`.
void double_row(const float* row, int count, float* out);

// out[2 i] = out[2 i + 1] = row[i]. `count` is that of `row`.
void repeat_texels(const float* row, int count, float* out);

// In place: row[i], or `otherwise` if it is NaN, from low[i] to high[i].
void limit_row(const float* low, const float* high, float otherwise, int count, float* row);

// In place: energies become factor max(0, energy - noise).
void weights_of_energy(float noise, float factor, int count, float* row);

// row[i] = min(row[i], other[i]), and row[i] = max(row[i], factor other[i]).
void least_of(const float* other, int count, float* row);
void greatest_of(const float* other, float factor, int count, float* row);

}  // namespace tex
