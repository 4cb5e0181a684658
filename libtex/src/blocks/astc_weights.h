// SPDX-License-Identifier: Apache-2.0
// astc_weights.h: fits the weights of a block to endpoints that are given.

#pragma once

#include <cstddef>

#include "blocks/astc_decode.h"
#include "blocks/astc_plan.h"

namespace tex::inline v1 {

// Writes a block that differs from another one by its weights alone. They suit the texels `x` and `y`, as codes from 0
// to 255, with fractions: least squares, then weights are rounded one after the other, so that later ones make up for
// earlier ones. `lines` are those of the other block, `grid` is the grid of its mode.
void write_astc_weights(const AstcGrid& grid, const AstcLines& lines, const float* x, const float* y,
                        const std::byte* from, std::byte* block);

}  // namespace tex::inline v1
