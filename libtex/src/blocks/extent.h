// SPDX-License-Identifier: Apache-2.0
// extent.h: converts between texels and whole blocks.

#pragma once

namespace tex::inline v1 {

// Texels along an edge of a block of BC1 to BC5. Code for every format takes the edges from FormatInfo::block.
inline constexpr int kBlockEdge = 4;
inline constexpr int kBlockTexels = kBlockEdge * kBlockEdge;

// The number of blocks that cover `texels` texels along an axis; the last block may be partly outside.
constexpr int blocks_across(int texels, int edge = kBlockEdge) { return (texels + edge - 1) / edge; }

// The number of texels in these blocks: `texels`, rounded up.
constexpr int whole_blocks(int texels, int edge = kBlockEdge) { return blocks_across(texels, edge) * edge; }

}  // namespace tex::inline v1
