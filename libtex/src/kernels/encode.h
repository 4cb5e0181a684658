// SPDX-License-Identifier: Apache-2.0
// encode.h: encodes four rows of normals as a row of texel blocks.

#pragma once

#include <algorithm>
#include <cstddef>

#include <tex/pack.h>

#include "blocks/extent.h"

namespace tex::inline v1 {

// The texel rows of a row of blocks, from the top, padded like the rows of a Plane. If the level ends within the
// blocks, `height` is the number of its rows here (1 to kBlockEdge); the other pointers repeat the last row.
struct BlockRow {
    const float* x[kBlockEdge];
    const float* y[kBlockEdge];
    int width = 0;
    int height = kBlockEdge;
    bool negate_y = false;
};

// The row of blocks that begins at texel row j, of two planes with this extent.
template <class Plane>
BlockRow block_row(const Plane& x, const Plane& y, Extent extent, int j, bool negate_y) {
    BlockRow row;
    row.width = extent.width;
    row.height = std::min(kBlockEdge, extent.height - j);
    row.negate_y = negate_y;
    for (int k = 0; k < kBlockEdge; ++k) {
        row.x[k] = x.row(j + std::min(k, row.height - 1));
        row.y[k] = y.row(j + std::min(k, row.height - 1));
    }
    return row;
}

// Encode blocks_across(width) blocks of 16 bytes each, one after the other. Components are clamped to [-1, 1]. See
// pack() for what the blocks guarantee. Effort::fast and normal use fits (fit.h); best uses searches (bc4_search.h,
// green_search.h). Blocks that lie partly outside the level are searched at every effort. At normal, a BC4 channel that
// has the lowest or the greatest code and up to eight values, as in blocks that were decoded before, also tries
// palettes of 6 values (six_values.h).
void encode_dxt5nm(const BlockRow& row, Effort effort, std::byte* blocks);
void encode_bc5_unorm(const BlockRow& row, Effort effort, std::byte* blocks);
void encode_bc5_snorm(const BlockRow& row, Effort effort, std::byte* blocks);

// Encodes EAC RG11: see eac_search.h.
void encode_eac_unorm(const BlockRow& row, Effort effort, std::byte* blocks);
void encode_eac_snorm(const BlockRow& row, Effort effort, std::byte* blocks);

}  // namespace tex::inline v1
