// SPDX-License-Identifier: Apache-2.0
// grid.h: traces of square blocks: JPEG's 8x8 transform, the 4x4 blocks of BC formats.

#pragma once

#include "checks/stored.h"

namespace tex {

// How much the step from a texel to the next stands out where a border of blocks lies: for each column (row) the mean
// step across its border divided by the mean of its two neighbours'; the median of those ratios over the borders of
// blocks, divided by the median over all other columns (rows). 1 where no grid is, or one of half the size; medians,
// because a map's own lines (joints between bricks) may lie on a few borders, but a codec's lie on all. The lesser of
// both directions, of channel x or y, whichever shows more.
double grid_ratio(const Stored& stored, int block);

// The share of aligned 4x4 blocks (of those that are not of one colour) whose texels have at most four different
// colours, as BC1 to BC3 leave them, less the same share at an offset of (2, 2).
double palette_share(const Stored& stored);

}  // namespace tex
