// SPDX-License-Identifier: Apache-2.0
// clusters.h: how well any k values can stand for the texels of a block.

#pragma once

#include "blocks/texels.h"

namespace tex {

inline constexpr int kMaxClusters = 8;

// bound[k] is at most the least squared error, in codes squared, with which any k + 1 values approximate the 16 texels;
// it falls with k. A palette of which k + 1 entries lie within reach of the block cannot do better.
struct ClusterBounds {
    float bound[kMaxClusters];
};

// Optimal one-dimensional clustering: sort the texels, then dynamic programming over the last cluster's first texel
// (Fisher 1958; Wang and Song, Ckmeans.1d.dp, 2011), for several blocks at once. Clusters of sorted values are
// intervals, so their least error is
//
//     f[1][j] = c(0, j)      f[k][j] = min over i of f[k-1][i-1] + c(i, j)      c(i, j) = sum of v^2 - (sum of v)^2 /
//     (j - i + 1)
//
// Rounding is allowed for: what is returned is less than the true value by up to 1e-5 of the block's range squared.
// Blocks with texels outside the level get bounds of 0.
void cluster_bounds(const BlockTexels* blocks, int count, ClusterBounds* bounds);

}  // namespace tex
