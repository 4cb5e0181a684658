// SPDX-License-Identifier: Apache-2.0
// angle.h: computes the angles between rows of normals.

#pragma once

#include "kernels/normal_row.h"

namespace tex::inline v1 {

// degrees[i] = 2 asin(min(1, |a[i] - b[i]| / 2)), in degrees, for `count` texels. Whole vectors
// are read and written past the last texel.
void angle_row(const VectorRow& a, const VectorRow& b, int count, float* degrees);

}  // namespace tex::inline v1
