// SPDX-License-Identifier: Apache-2.0
// kernels/height_field.h: turns rows of pictures into rows of heights, and smooths them.
//
// Rows may be read and written up to a whole vector (64 bytes) past their last texel. `count` is in texels.

#pragma once

#include <cstdint>

namespace tex::inline v1 {

// A row of colours.
struct ColorRow {
    const float* r;
    const float* g;
    const float* b;
};

// 0.2126 r + 0.7152 g + 0.0722 b.
void luma_row(ColorRow in, int count, float* out);

// (r + g + b) / 3.
void average_row(ColorRow in, int count, float* out);

// The largest of r, g and b; NaN if one of them is NaN.
void max_row(ColorRow in, int count, float* out);

// r if r = g = b, otherwise luma. Returns the number of texels for which luma was taken and is finite.
std::int64_t automatic_row(ColorRow in, int count, float* out);

// In place: NaN, infinite heights and heights equal to no_data become NaN (if no_data is NaN, no height equals it). All
// others become 1 - h if `invert` is set. Returns the number of NaN.
std::int64_t clean_row(float* row, int count, float no_data, bool invert);

// out[i] = smoothing[0] row[i] + sum over k = 1 to radius of smoothing[k] (row[i - k] + row[i + k]), outermost texels
// first.
void smooth_row(const float* row, const float* smoothing, int radius, int count, float* out);

// Smooths down the columns, through the 2 radius + 1 rows `rows`, of which rows[0] is the top one.
void smooth_column(const float* const* rows, const float* smoothing, int radius, int count, float* out);

}  // namespace tex::inline v1
