// SPDX-License-Identifier: Apache-2.0
// encode.h: four rows of normals to a row of texel blocks.

#pragma once

#include <algorithm>
#include <cstddef>

#include <tex/pack.h>

#include "blocks/extent.h"

namespace tex {

// The texel rows of a row of blocks, from the top, padded as those of a Plane. Where the level ends within the blocks,
// `height` says how many rows there are (1 to kBlockEdge); the other pointers repeat the last one.
struct BlockRow {
    const float* x[kBlockEdge];
    const float* y[kBlockEdge];
    int width = 0;
    int height = kBlockEdge;
    bool negate_y = false;
};

// The row of blocks from texel row j on, of two planes that have this extent.
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
// pack() for what the blocks promise. Effort::fast and normal fit (fit.h), best searches (bc4_search.h,
// green_search.h); blocks that lie partly outside the level are searched at every effort; at normal so are channels in
// BC4 that have the lowest or the greatest code and up to eight values, as blocks do that were decoded before.
void encode_dxt5nm(const BlockRow& row, Effort effort, std::byte* blocks);
void encode_bc5_unorm(const BlockRow& row, Effort effort, std::byte* blocks);
void encode_bc5_snorm(const BlockRow& row, Effort effort, std::byte* blocks);

// All that the options say of blocks: encoding (one in blocks), effort and metric.
void encode_blocks(const BlockRow& row, const PackOptions& options, std::byte* blocks);

}  // namespace tex
