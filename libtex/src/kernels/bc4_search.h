// SPDX-License-Identifier: Apache-2.0
// bc4_search.h: finds the endpoints of BC4 blocks with the least squared error of all.
//
// Let the palette be p_0 < p_1 < ... < p_n, and the thresholds between its entries t_j = (p_(j-1) + p_j) / 2. Let m be
// the mean of the N texels v, and V the sum of their squared deviations. The nearest entry changes only at the
// thresholds, so the squared error of the block is
//
//     E = V + N (m - nearest(m))^2 - 2 sum over j of (p_j - p_(j-1)) G(t_j)
//     G(t) = sum of max(v, t) - max(N m, N t)
//
// (write min over p of (v - p)^2 = v^2 + a concave broken line in v, and subtract the same line at m). G does not
// depend on the palette. It is 0 outside the block's range, and the thresholds of all palettes lie on a grid of 1/14
// code (8 values) or 1/10 code (6 values). G is therefore tabulated once for each block, and the error of a pair of
// endpoints is the sum of at most 7 entries. For equal distances D between the endpoints, neighbouring pairs read
// neighbouring entries: 16 pairs are scored at once, with one load and one addition for each threshold.
//
// The search, and why it misses nothing. `least` is the smallest error found so far, s its square root, R = max - min.
//   * A texel outside the endpoints costs at least its squared distance. So the lower endpoint is at most min + s, the
//     greater one at least max - s, and (R - D)^2 / 2 <= least. (With 6 values, if 0 or the greatest code is within s
//     of the block's range, texels may use that code: then all endpoints on that side are tried.)
//   * At most floor(R / spacing) + 1 thresholds fall into the range, so at most one more entry than that is in use, and
//     k values cannot do better than the best k clusters (see clusters.h). That bound grows with D: the search goes up
//     from D = R and ends when the bound exceeds `least`.
//   * If R < spacing / 2 and a threshold falls into the range, every texel is at least spacing / 2 - R from the
//     palette. If none does, one entry serves all texels, and a palette with D <= 1 has an entry as near: all
//     sevenths and fifths are available.
//   * If an endpoint moves by one code, each entry moves by at most one, so the root of E changes by at most
//     sqrt(16) = 4. If no pair of one D comes nearer to s than 4 k, the next k distances hold nothing better and are
//     skipped.
//   * A block without error ends the search.
// Tables and sums are float. Pairs within their rounding of the least error (at most 1e-4 R^2) are scored again in
// whole numbers, so the result is exact. Among equal pairs that the search found, it prefers the nearest endpoints,
// then 8 values, then the greatest endpoints.

#pragma once

#include "blocks/bc4.h"
#include "kernels/clusters.h"

namespace tex::inline v1 {

void search_bc4_blocks(const BlockTexels* blocks, const ClusterBounds* bounds, int count, Bc4Codes codes,
                       Bc4Endpoints* endpoints);

}  // namespace tex::inline v1
