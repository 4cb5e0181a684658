// SPDX-License-Identifier: Apache-2.0
// fit.h: the quick block encoders, `fast` and `normal`, with one block in each lane of 16 bits.
//
// Each channel is fitted separately. Endpoints a and b (real numbers) give each texel the index k = round(n (v - a) /
// (b - a)), clamped to 0 to n. From the sums of k, k^2, v and k v follow the squared error of these indices and, by
// linear least squares, the endpoints that suit these indices best (alternating least squares, as Lloyd 1957). Each
// step rounds the endpoints to codes first, so that the error is that of the block as written. The best of all steps is
// kept.
//
// Starts: the palette may be finer or coarser than the block's range. In a start (g, j), n - j + g spacings span the
// range, with g / 2 of a spacing between the lower endpoint and the least texel.
//
//   fast     alpha: (0, 0), solved once; texels keep their indices. If all texels are whole codes of a range of at most
//                   7: a spacing of one code
//            green: the extremes less 1/16 of the range, solved once; texels take the nearest values
//   normal   alpha: 8 values: (0, 1), (1/2, 0), (1/2, 2), 2 steps; (0, 0), 3 steps; for ranges of at most 7 codes:
//                   a spacing of one code
//                   6 values: (0, 1), 2 steps
//            green: g = -0.4, 0.4; j = 0, 1, 2; 1 step, of which the end is scored; then all pairs within 2 codes
//                   of the best, then within 1 code of the best of these; (0, 0), 3 steps
//            both:  if the values lie on a palette, as in blocks that were decoded before: its endpoints
//                   (fit_palettes-inl.h)
//
// If a block of green needs a single value, it takes it from single_greens.h. Greens are scored by the thresholds
// between values (fit_greens-inl.h), which needs no indices.
//
// What is guaranteed. normal: the three steps of (0, 0) are a plain fit: the extremes, refined twice by least squares,
// with halves rounded up. If all texels of a block are whole codes, they are computed without rounding, so no block is
// worse than that fit. Otherwise texels or endpoints that lie almost in the middle (see Precision) may be rounded the
// other way, and the fit then takes another path: about one block in 1000 becomes worse. fast: the comparison is
// with the palette between the extremes (in green: less 1/16 of the range at both ends), exact and not refined. Least
// squares are not worse than that palette. Rounding then moves values by at most half a code of alpha (one code if the
// range is less) and by at most 2.8 codes of green. The root mean square error of a block exceeds that of this palette
// by at most that much, plus 1/400 of the range for the coarse sums of fast. It can be larger only if least squares
// leave the range of codes.
//
// Precision: values are rounded to 1/128 of a code, then scaled by a power of two such that 16 bits hold the block's
// range. The coarse sums, with which most starts of alpha are compared, use 9 of these bits; the full sums, which
// decide, use all of them. If not all texels are whole codes, those within 1/1300 of a spacing of the middle between
// two values may take either value. Errors are exact for whole codes of a range of at most 127, and otherwise rounded
// by less than range^2 / 10^6. Blocks lie in lanes; their order and number do not affect the result.

#pragma once

#include <cstddef>

#include <tex/pack.h>

#include "blocks/bc4.h"

namespace tex::inline v1 {

// The rows of texels of one channel (components in [-1, 1], clamped).
struct FitRows {
    const float* const* rows;  // four
    bool negate;
};

// Fit `count` blocks that lie entirely in the rows, and write 16 bytes for each: DXT5nm from x and y; BC5 from x and y.
//
// Blocks of 6 values also have the lowest and the greatest code, which these fits do not use. The functions return true
// if, at Effort::normal and in a channel of BC4, a block has texels with one of these codes and other texels too: such
// blocks may need a search.
[[nodiscard]] bool fit_dxt5nm_blocks(const FitRows& x, const FitRows& y, int count, Effort effort, std::byte* blocks);
[[nodiscard]] bool fit_bc5_blocks(const FitRows& x, const FitRows& y, int count, Bc4Codes codes, Effort effort,
                                  std::byte* blocks);

}  // namespace tex::inline v1
