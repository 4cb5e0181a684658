// SPDX-License-Identifier: Apache-2.0
// clusters.h: how well k arbitrary values can represent the texels of a block.

#pragma once

#include "blocks/texels.h"

namespace tex::inline v1 {

inline constexpr int kMaxClusters = 8;

// bound[k] does not exceed the least squared error, in codes squared, with which any k + 1 values approximate the 16
// texels. It falls with k. A palette with k + 1 entries within reach of the block cannot do better.
struct ClusterBounds {
    float bound[kMaxClusters];
};

// Optimal one-dimensional clustering, for several blocks at once: sort the texels, then use dynamic programming over
// the first texel of the last cluster (Fisher 1958; Wang and Song, Ckmeans.1d.dp, 2011). Clusters of sorted values are
// intervals, so their least error is
//
//     f[1][j] = c(0, j)      f[k][j] = min over i of f[k-1][i-1] + c(i, j)
//     c(i, j) = sum of v^2 - (sum of v)^2 / (j - i + 1)
//
// To allow for rounding, the result is less than the true value by up to 1e-5 of the square of the block's range.
// Blocks with texels outside the level get bounds of 0.
void cluster_bounds(const BlockTexels* blocks, int count, ClusterBounds* bounds);

}  // namespace tex::inline v1
