// SPDX-License-Identifier: Apache-2.0
// kernels/scale.h: rows of normals, scaled.

#pragma once

#include <tex/normal_map.h>

namespace tex {

// Scales `count` normals in place: see scale() in scale.h. Vectors need not have unit length in ScaleMode::slope; a scale of 1
// normalises them. Rows are padded to whole vectors.
void scale_row(float* x, float* y, float* z, float scale, ScaleMode mode, int count);

}  // namespace tex
