// SPDX-License-Identifier: Apache-2.0
// fit.h: the quick block encoders, `fast` and `normal`: one block in each lane of 16 bits.
//
// Each channel is fitted by itself. Endpoints a and b (real numbers) give each texel the index k = round(n (v - a) / (b
// - a)), clamped to 0 to n; from the sums of k, k^2, v and k v follow both the squared error of that choice and, by
// linear least squares, the endpoints that suit these indices best (alternating least squares, as Lloyd 1957). In a
// step, endpoints are rounded to codes first, so that the error is that of the block as written; the best of all steps
// is kept.
//
// Starts: the palette may be finer or coarser than the block's range. A start (g, j) lets n - j + g spacings span the
// range, with g / 2 of a spacing between the lower endpoint and the least texel.
//
//   fast     alpha: (0, 0), solved once; texels keep their indices. Where all are whole codes of a range of at most 7:
//   a spacing of one code
//            green: the extremes less 1/16 of the range, solved once; texels take the nearest values
//   normal   alpha: 8 values: (0, 1), (1/2, 0), (1/2, 2), 2 steps; (0, 0), 3 steps; ranges of at most 7 codes: a
//   spacing of one code
//                   6 values: (0, 1), 2 steps
//            green: g = -0.4, 0.4; j = 0, 1, 2; 1 step, of which the end is scored; then all pairs within 2 codes of
//            the best, then within 1 code of
//                   the best of these; (0, 0), 3 steps
//            both:  where the values lie on a palette, as those of blocks do that were decoded before: its endpoints
//            (fit_palettes-inl.h)
//
// A green that needs a single value takes it from single_greens.h. Greens are scored by the thresholds between values
// (fit_greens-inl.h), which needs no indices.
//
// What is promised. normal: the last three steps are those of a plain fit (the extremes, twice refined by least
// squares), so that no block is worse than that. fast: least squares do not lose to the palette between the extremes
// (in green: less 1/16 of the range at both ends), exact and not refined; rounding then moves values by half a code of
// alpha at most (one code where the range is less), by 2.8 codes of green. So much, and 1/400 of the range for its
// coarse sums, is the most by which the root mean square error of a block may be above that of this palette; more only
// where least squares leave the range of codes.
//
// Precision: values are rounded to 1/128 of a code, then scaled by a power of two such that 16 bits hold the block's
// range; 9 of these bits count in the coarse sums with which most starts of alpha are compared, all of them in the full
// sums that decide. Texels that lie within 1/2000 of a spacing of the middle between two values may take either. Blocks
// lie in lanes: their order and number change nothing.

#pragma once

#include <cstddef>

#include <tex/pack.h>

#include "blocks/bc4.h"

namespace tex {

// The rows of texels of one channel (components in [-1, 1], clamped).
struct FitRows {
    const float* const* rows;  // four
    bool negate;
};

// Fit `count` blocks that lie whole in the rows, and write 16 bytes for each: DXT5nm from x and y; BC5 from x and y.
//
// Blocks of 6 values hold the lowest and the greatest code besides, which these fits do not use. Return true where, at
// Effort::normal and in a channel of BC4, texels with one of these were met in a block that has others, too: such
// blocks may be for a search.
[[nodiscard]] bool fit_dxt5nm_blocks(const FitRows& x, const FitRows& y, int count, Effort effort, std::byte* blocks);
[[nodiscard]] bool fit_bc5_blocks(const FitRows& x, const FitRows& y, int count, Bc4Codes codes, Effort effort,
                                  std::byte* blocks);

}  // namespace tex
