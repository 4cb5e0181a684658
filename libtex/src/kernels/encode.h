// SPDX-License-Identifier: Apache-2.0
// encode.h: four rows of normals to a row of texel blocks.

#pragma once

#include <cstddef>

#include <tex/pack.h>

namespace tex {

// The texel rows of a row of blocks, from the top, padded as those of a Plane. Where the level ends within the blocks,
// `height` says how many rows there are (1 to 4); the other pointers repeat the last one.
struct BlockRow {
    const float* x[4];
    const float* y[4];
    int width = 0;
    int height = 4;
    bool negate_y = false;
};

// Encode (width + 3) / 4 blocks of 16 bytes each, one after the other. Components are clamped to [-1, 1]. See pack()
// for what the blocks promise. Effort::fast and normal fit (fit.h), best searches (bc4_search.h, green_search.h);
// blocks that lie partly outside the level are searched at every effort; at normal so are channels in BC4 that have the
// lowest or the greatest code and up to eight values, as blocks do that were decoded before.
void encode_dxt5nm(const BlockRow& row, Effort effort, std::byte* blocks);
void encode_bc5_unorm(const BlockRow& row, Effort effort, std::byte* blocks);
void encode_bc5_snorm(const BlockRow& row, Effort effort, std::byte* blocks);

// All that the options say of blocks: encoding (dxt5nm, bc5 or bc5_snorm), effort and metric.
void encode_blocks(const BlockRow& row, const PackOptions& options, std::byte* blocks);

}  // namespace tex
