// SPDX-License-Identifier: Apache-2.0
// kernels/deband.h: rows of heights in steps ("codes"), their bounds, and their bending.
//
// Rows may be read and written up to a whole vector (64 bytes) past their last texel. `count` is in texels of the
// output. Codes may be NaN: no height is known there.

#pragma once

namespace tex::inline v1 {

// No height is below `least` or above `greatest`, in steps. Where there is a code, heights are also at most half a step
// from it.
struct CodeRange {
    float least = 0.0f;
    float greatest = 0.0f;
};

// In place: the number of the step that each height lies on. NaN stays.
void codes_of_heights(float lowest, float step, int count, float* row);

// In place: the heights `row`, in steps, become lowest + step row. If that does not round to the code, it is replaced
// by the height of the code; without a code, by NaN.
void heights_of_codes(const float* codes, float lowest, float step, int count, float* row);

// out[i] = a[i] + factor (a[i] - b[i]).
void extrapolate_row(const float* a, const float* b, float factor, int count, float* out);

// out[i] = (above[i] + below[i]) + (row[i - 1] + row[i + 1]) - 4 row[i], for i from -1 to count.
void laplace_row(const float* above, const float* row, const float* below, int count, float* out);

// row[i] = row[i]^2, at most 1e6; 0 for NaN.
void square_row(int count, float* row);

// One step of the projected gradient, within the bounds. The rows of Laplacians begin at texel -1, as laplace_row()
// writes them.
struct BendingRow {
    const float* above;  // Laplacians of the rows above, at and below
    const float* at;
    const float* below;
    const float* heights;
    const float* codes;
    const float* weights;
};
void relax_row(const BendingRow& in, CodeRange range, int count, float* out);

// Rows for a grid of half the size. Two rows of `2 count` texels become one: of each square of 2x2 texels, the upper
// left code, or the next one that is known; or the mean of the four.
void halve_codes(const float* upper, const float* lower, int count, float* out);
void halve_means(const float* upper, const float* lower, int count, float* out);

// Rows for a grid of twice the size, between the texels of which those of the coarse one lie: cubic interpolation half
// way between the second and the third of four rows, or texels (Dubuc 1986). `count` is that of the input.
void between_rows(const float* const rows[4], int count, float* out);
void double_row(const float* row, int count, float* out);  // out[2 i] = row[i]; reads row[-1] to row[count + 1]

// out[2 i] = out[2 i + 1] = row[i]. `count` is that of `row`.
void repeat_texels(const float* row, int count, float* out);

// In place: row[i], or range.least if it is NaN, within the bounds.
void limit_row(const float* codes, CodeRange range, int count, float* row);

// In place: energies become weights: factor max(0, energy - noise); 0 if the energy is at most `significant`; and
// beyond 300, one that holds heights at their codes.
void weights_of_energy(float noise, float significant, float factor, int count, float* row);

// row[i] = min(row[i], other[i]), and row[i] = max(factor row[i], factor_of_other other[i]).
void least_of(const float* other, int count, float* row);
void greatest_of(float factor, float factor_of_other, const float* other, int count, float* row);

}  // namespace tex::inline v1
