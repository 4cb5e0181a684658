// SPDX-License-Identifier: Apache-2.0
// encode_bc7.h: encodes normals, and data in alpha, as blocks of BC7 with the least error of direction.
//
// What each block would lose in each mode is guessed (bc7_guess.cpp). It is fitted in those that seem best, together
// with other blocks of the same mode (bc7_planes.cpp, bc7_lines.cpp), and the best of these are improved. The least
// error, as decoders make it, decides.
//
// Tried, and not better (mean angles over those of bc7e -u6 or, for fast, -u4; tests/bench/BC7.md has the maps):
//   partitions chosen by the guesses of two planes instead of their fitted errors: normal 0.930 instead of 0.907
//   modes 1 and 3 guessed with less difference between their steps: normal 1.105 instead of 0.984 on sharp edges
//   three subsets in fast, with two partitions in all: 1.23 instead of 0.97 on sharp edges

#pragma once

#include <cstddef>

#include <tex/format.h>
#include <tex/pack.h>

namespace tex::inline v1 {

// Encodes rows of blocks of 4x4 texels. `texels` holds x, y, z and alpha (0 to 1) of each, `extent.height` rows of
// `extent.width`. Blocks that are partly outside repeat the last texels. A block depends on its texels alone. Throws
// std::bad_alloc.
//
// Without lent memory, which takes bc7_memory(), it comes from the heap.
void encode_bc7(Format format, Effort effort, const float* texels, Extent extent, std::byte* blocks);

// Blocks of which red and alpha are exchanged: A = x, G = y, B = z, and the fourth value of a texel in red.
void encode_bc7_rxgb(Format format, Effort effort, const float* texels, Extent extent, std::byte* blocks);

[[nodiscard]] std::size_t bc7_memory(Format format, Effort effort, int width, int rows);
// So many rows of blocks are encoded together best.
[[nodiscard]] int bc7_rows_at_once(Format format, int width);

}  // namespace tex::inline v1
