// SPDX-License-Identifier: Apache-2.0
// kernels/blend.h: blends rows of normals. Rows are padded to whole vectors.

#pragma once

#include <tex/blend.h>

#include "kernels/normal_row.h"

namespace tex::inline v1 {

// Blends `detail` on `base`, in place: see BlendMode. If `weight` is given, with a value for each texel, the result is
// normalize(lerp(base, blended, weight)). A null pointer means 1.
void blend_row(BlendMode mode, NormalRow base, NormalRow detail, const float* weight, int count);

// Rotates vectors counter-clockwise about z by the angle with this cosine and sine.
void rotate_row(NormalRow row, float cosine, float sine, int count);

// a = a (1 - t) + b t for one component.
void mix_row(float* a, const float* b, float t, int count);

}  // namespace tex::inline v1
