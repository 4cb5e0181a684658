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

// By how much the mean step across the borders of blocks exceeds the mean step inside them, in stored values (1 is the
// full scale of unorm): the lesser of both directions, of channel x or y, whichever shows more.
double grid_excess(const Stored& stored, int block);

// The share of aligned 4x4 blocks whose texels are those of a palette of BC1 to BC3: two colours and one or two evenly
// spaced between them. Blocks of one or two colours, or of little contrast, do not count. Less the same share of blocks
// at an offset of (2, 2), which only a map of few values reaches too. 0 in maps of fewer than 64 blocks that count.
double palette_share(const Stored& stored);

}  // namespace tex
