// SPDX-License-Identifier: Apache-2.0
// kernels/slopes.h: rows of slopes, and the sums of their differences.
//
// Rows may be read and written up to a whole vector (64 bytes) past their last texel. `count` is in texels.

#pragma once

#include "kernels/normal_row.h"

namespace tex::inline v1 {

// p[i] = -x[i] / z[i] and q[i] = -y[i] / z[i], limited to +-kMaxSlope (kernels/bake.h). Both are 0 if z[i] is below
// `least_z` > 0 or a component is NaN or infinite. Returns the number of such texels.
int slopes_of_normals(const VectorRow& normals, float least_z, int count, float* p, float* q);

// Slopes minus those of `made`, which bake() has made: p and q are 0 in those texels, too.
void excess_slopes(const VectorRow& normals, const VectorRow& made, float least_z, int count, float* p, float* q);

// The number of texels for which both make p and q 0.
int count_without_slope(const VectorRow& normals, float least_z, int count);

// values[i] = 0 where a component of the normal is NaN or infinite.
void zero_without_normal(const VectorRow& normals, int count, float* values);

// out[i] = x_factor (x_plus[i] - x_minus[i]) + y_factor (y_plus[i] - y_minus[i]).
void sum_differences(const float* x_plus, const float* x_minus, float x_factor, const float* y_plus,
                     const float* y_minus, float y_factor, int count, float* out);

// out[i] = a_factor a[i] + b_factor b[i].
void weighted_sum(const float* a, float a_factor, const float* b, float b_factor, int count, float* out);

// values[i] = (values[i] - offset) factor.
void shift_and_scale(float offset, float factor, int count, float* values);

}  // namespace tex::inline v1
