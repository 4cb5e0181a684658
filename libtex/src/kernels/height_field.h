// SPDX-License-Identifier: Apache-2.0
// kernels/height_field.h: rows of pictures to rows of heights, and smoothing.
//
// Rows may be read and written up to a whole vector (64 bytes) past their last texel. `count` is in texels.

#pragma once

#include <cstdint>

namespace tex {

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

// The largest; NaN where one of them is.
void max_row(ColorRow in, int count, float* out);

// r where r = g = b, luma elsewhere. Returns the number of texels whose luma is finite and was taken.
std::int64_t automatic_row(ColorRow in, int count, float* out);

// In place: NaN, infinite heights and those equal to no_data (NaN: none is) become NaN, all others 1 - h if
// `invert`. Returns the number of NaN.
std::int64_t clean_row(float* row, int count, float no_data, bool invert);

// out[i] = smoothing[0] row[i] + sum over k = 1 to radius of smoothing[k] (row[i - k] + row[i + k]), the
// outermost first.
void smooth_row(const float* row, const float* smoothing, int radius, int count, float* out);

// The same down the columns, through the 2 radius + 1 rows `rows`, of which rows[0] is the top one.
void smooth_column(const float* const* rows, const float* smoothing, int radius, int count, float* out);

}  // namespace tex
