// SPDX-License-Identifier: Apache-2.0
// kernels/roughness.h: roughness, alpha^2 and the lengths of averaged vectors (see tex/mip.h).
//
// Rows may be read and written up to a whole vector (64 bytes) past their last texel.

#pragma once

#include <tex/mip.h>

namespace tex::inline v1 {

// `clean` becomes the roughness limited to [0, 1], with NaN as 0; alpha2 becomes its fourth power.
void clean_roughness(const float* roughness, int count, float* clean, float* alpha2);

// The fourth roots of alpha^2, limited to [0, 1].
void roughness_of_alpha2(const float* alpha2, int count, float* roughness);

// The roughness of a row of a smaller level, from averaged vectors and averaged alpha^2.
void roughness_of_averages(RoughnessModel model, const float* x, const float* y, const float* z, const float* alpha2,
                           int count, float* roughness);

}  // namespace tex::inline v1
