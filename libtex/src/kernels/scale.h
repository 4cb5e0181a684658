// SPDX-License-Identifier: Apache-2.0
// kernels/scale.h: scales rows of normals.

#pragma once

#include <tex/types.h>

#include "kernels/normal_row.h"

namespace tex::inline v1 {

// Scales `count` normals, which may be those of `out`: see scale() in scale.h. In ScaleMode::slope, vectors need not
// have unit length; a scale of 1 normalises them. Rows are padded to whole vectors.
void scale_row(const VectorRow& in, float scale, ScaleMode mode, int count, const NormalRow& out);

}  // namespace tex::inline v1
