// SPDX-License-Identifier: Apache-2.0
// grid.h: traces of square blocks: JPEG's 8x8 transform, the 4x4 blocks of BC formats.

#pragma once

#include "checks/stored.h"

namespace tex::inline v1 {

// How much the step from one texel to the next stands out at the borders of blocks. For each column (row), the mean
// step across its border is divided by the mean of its two neighbours' steps. The result is the median of those ratios
// over the borders of blocks, divided by the median over all other columns (rows). It is 1 if there is no grid, or a
// grid of half the size. Medians are used because a map's own lines (joints between bricks) may lie on a few borders,
// but a codec's lie on all. The result is the lesser of both directions, for channel x or y, whichever shows more.
double grid_ratio(const Stored& stored, int block);

// Such a ratio, divided by the largest of the medians at the other places within blocks. It is 1 if the grid is that of
// a map which was enlarged by a divisor of `block`: its lines are all alike.
double grid_lead(const Stored& stored, int block);

// By how much the mean step across the borders of blocks exceeds the mean step inside them, in stored values (1 is the
// full scale of unorm). The result is the lesser of both directions, for channel x or y, whichever shows more.
double grid_excess(const Stored& stored, int block);

// The share of aligned 4x4 blocks whose texels form a palette of BC1 to BC3: two colours and one or two evenly spaced
// between them. Blocks of one or two colours, or of little contrast, do not count. The same share of blocks at an
// offset of (2, 2) is subtracted, which is high too only in a map of few values. 0 in maps with fewer than 64 blocks
// that count.
double palette_share(const Stored& stored);

}  // namespace tex::inline v1
