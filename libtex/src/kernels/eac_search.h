// SPDX-License-Identifier: Apache-2.0
// eac_search.h: finds the palettes of EAC blocks with the least squared error of all, or ones near it.
//
// All lengths count bases, that is 8 codes. Entry k of a palette is b + middle + s p_k for base b, with the modifiers
// p_k in ascending order and the scale s = multiplier (1/8 if it is 0). As for BC4 (bc4_search.h), the squared error of
// N texels v with the mean m and the sum V of squared deviations is
//
//     E = V + N (m - nearest(m))^2 - 2 sum over k of s (p_k - p_(k-1)) G(t_k)
//     t_k = b + middle + s (p_k + p_(k-1)) / 2,    G(t) = sum of max(v, t) - max(N m, N t)
//
// so palettes whose bases are neighbours read neighbouring entries of tables of G: a grid of 1/2 for multipliers from 1
// on, and of 1/16 for multiplier 0. G is 0 outside the block's range. Several bases are scored at once.
//
// The search, and why it misses nothing. `least` is the smallest error found so far, r its square root, R = max - min.
//   * A texel outside the palette costs at least its squared distance: the lowest entry is at most min + r, the
//   greatest
//     at least max - r, and if the palette is narrower than R by d, d^2 / 2 <= least.
//   * k entries cannot do better than the best k clusters (clusters.h). If n entries are needed to come below `least`,
//     n - 1 neighbouring thresholds lie within the block's range: only bases for which some do are tried.
//   * A single entry for all texels is best if it is the code nearest to the mean. Multiplier 0 has all codes, so n is
//   at
//     least 2 for the others.
//   * If a threshold between entries D apart lies in the range, and R < D / 2, every texel is at least D / 2 - R from
//     the palette.
//   * Entries below 0 and above the greatest code are clamped. This changes a block only if texels are within r of
//   these
//     codes, because the clamped entry is nearer than the entry that the formula uses. Then clamped palettes are scored
//     directly, without tables.
// Tables and sums are float. Palettes within their rounding of the least error are scored again in whole numbers, so
// the result is exact. Among equal palettes it prefers the smallest multiplier, then the first table, then the greatest
// base; a palette without error ends the search.

#pragma once

#include <tex/pack.h>

#include "blocks/eac.h"
#include "kernels/clusters.h"

namespace tex::inline v1 {

// Encodes `count` blocks into the first 8 of each 16 bytes. best needs the bounds and finds the least squared error of
// all palettes; normal, the best of the palettes near the middle of the block's range.
void encode_eac_blocks(const BlockTexels* texels, const ClusterBounds* bounds, int count, EacCodes codes, Effort effort,
                       std::byte* blocks);

}  // namespace tex::inline v1
