// SPDX-License-Identifier: Apache-2.0
// kernels/bake.h: turns rows of heights into rows of normals.
//
// Rows may be read and written up to a whole vector (64 bytes) past their last texel. `count` is in texels. On both
// axes the derivative is taken before smoothing: heights are subtracted unchanged, before anything is rounded, so a
// constant field gives exactly 0.

#pragma once

#include "kernels/normal_row.h"

namespace tex::inline v1 {

// Heights are limited to this after they are scaled. Beyond it, sums of differences could become infinite, and infinity
// minus infinity is NaN.
inline constexpr float kMaxHeight = 1e34f;

// The scale at which no finite height reaches kMaxHeight. A power of two, so that it rounds no height above 1e-33.
inline constexpr float kHeightScale = 0x1p-16f;

// Slopes are clamped to this, so that their squares are finite.
inline constexpr float kMaxSlope = 1e15f;

// Whether no height of the row is NaN or infinite.
bool are_finite(const float* row, int count);

// out[i] = scale in[i], limited to +-kMaxHeight.
void limit_heights(const float* in, float scale, int count, float* out);

// A row of heights beyond the border (see HeightIndex in rows/border.h):
//
//     out[i] = (reflected ? 2 edge[i] - inner[i] : inner[i]) + drift (edge[i] - other[i])
//
// where all inputs are scaled and limited to +-kMaxHeight first.
void continue_heights(const float* inner, const float* edge, const float* other, bool reflected, float drift,
                      float scale, int count, float* out);

// normalize(-slope_x, -slope_y, 1) with slope_x = (right - left) scale_x, slope_y = (up - down) scale_y.
void normals_by_difference(const float* left, const float* right, const float* down, const float* up, float scale_x,
                           float scale_y, int count, NormalRow out);

// out[i] = sum over k = 1 to radius of derivative[k - 1] (row[i + k] - row[i - k]).
void derive_row(const float* row, const float* derivative, int radius, int count, float* out);

// Derives upwards, through the 2 radius + 1 rows `rows`, of which rows[0] is the top one:
// out[i] = sum of derivative[k - 1] (rows[radius - k][i] - rows[radius + k][i]).
void derive_column(const float* const* rows, const float* derivative, int radius, int count, float* out);

// Normals of slopes that are smoothed at right angles to their derivative:
//
//     slope_x = scale_x (smoothing[0] du[radius][i] + sum of smoothing[k] (du[radius - k][i] + du[radius + k][i]))
//     slope_y = scale_y (smoothing[0] dv[i]         + sum of smoothing[k] (dv[i - k] + dv[i + k]))
void normals_by_smoothing(const float* const* du, const float* dv, const float* smoothing, int radius, float scale_x,
                          float scale_y, int count, NormalRow out);

// The least and greatest slopes, -x/z and -y/z, with z at least 1e-16. No slope is infinite, and slopes of bake(), up
// to 1e15, are not changed.
struct SlopeBounds {
    float min_x, max_x;
    float min_y, max_y;
};

// Widens `bounds` by a row of normals. Texels past `count` are ignored.
void widen_slope_bounds(const float* x, const float* y, const float* z, int count, SlopeBounds& bounds);

// The number of texels in a row whose value is less than `limit`.
int count_below(const float* values, float limit, int count);

}  // namespace tex::inline v1
