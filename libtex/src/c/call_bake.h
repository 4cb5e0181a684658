// SPDX-License-Identifier: Apache-2.0
// call_bake.h: what tex_bake() and tex_integrate() share.

#pragma once

#include <tex/bake.h>

#include "c/call.h"
#include "rows/bake_rows.h"

namespace tex::inline v1 {

// Whether these are options of a bake.
bool is_bake(int32_t kernel, float gaussian_sigma, int32_t wrap_x, int32_t wrap_y);
BakeOptions bake_options(int32_t kernel, float gaussian_sigma);

// The radius of gradient_of(), which allocates.
int gradient_radius(const BakeOptions& options);

// What a Gradient and BakeRows take.
void add_gradient(ScratchSize& size, int radius);
void add_bake_rows(ScratchSize& size, int width, int radius);

}  // namespace tex::inline v1
