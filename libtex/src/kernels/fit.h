// SPDX-License-Identifier: Apache-2.0
// fit.h: the quick block encoders, `fast` and `normal`: one block in each lane of 16 bits.
//
// Each channel is fitted by itself. Endpoints a and b (real numbers) give each texel the index k = round(n (v - a) / (b - a)), clamped to 0
// to n; from the sums of k, k^2, v and k v follow both the squared error of that choice and, by linear least squares, the endpoints
// that suit these indices best (alternating least squares, as Lloyd 1957). Endpoints are rounded to codes before each
// step, so that the error is that of the block as written; the best of all steps is kept.
//
// Starts: the palette may be finer or coarser than the block's range. A start (g, j) lets n - j + g spacings span the range, with g / 2
// of a spacing between the lower endpoint and the least texel.
//
//   fast     alpha: (0, 0), 2 steps                  green: the extremes less 1/16 of the range, 2 steps
//   normal   alpha: g = 0, 1/2; j = 0, 1, 2; 2 steps green: g = -0.4, 0, 0.4; j = 0, 1, 2; 3 steps; then all pairs within 2 codes
//
// normal then compares its endpoints with those of a plain fit (the extremes, twice refined by least squares) in values of 1/256 code, and takes
// the better ones: no block is worse than the plain fit (fit_exact-inl.h).
//
// The order in which texels come does not matter, 8 values only are used. A green that needs a single value takes it from the table of
// single_greens(). Inside, values are counted from the code below the block's least texel on, in units of 1/16 to 1/2 of a code,
// such that 9 bits hold them: whole codes are exact, smooth blocks keep up to 4 bits of fraction.

#pragma once

#include <cstddef>

#include <tex/pack.h>

#include "blocks/bc4.h"

namespace tex {

// Fits `count` blocks that lie whole in the four rows (components in [-1, 1], clamped), and writes 8 bytes for each, 16 bytes apart.
void fit_bc4_blocks(const float* const rows[4], int count, Bc4Codes codes, bool negate, Effort effort, std::byte* blocks);
void fit_green_blocks(const float* const rows[4], int count, bool negate, Effort effort, std::byte* blocks);

}  // namespace tex
