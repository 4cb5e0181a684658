// SPDX-License-Identifier: Apache-2.0
// encode_uastc.h: encodes normals as blocks of UASTC with the least error of direction, and with the hints that give
// transcoders the least one, too.
//
// As for BC7 (encode_bc7.h), modes are guessed, blocks of the same mode are fitted side by side, the best fits are
// improved, and the least error, as decoders make it, decides. In two planes x, y and z span a grid of four by four
// directions, whose endpoints are solved for by least squares of the distances from the rays through the normals.
//
// Of the two or three best ways of a block, that is taken whose error is least with a twentieth of its error as BC1,
// which old desktops and PlayCanvas show: 1.5 to 4 % less there, for 0.2 to 0.4 % of the angle of the file.
//
// Tried, and not better (mean angles over those of basis_universal's level 4; tests/bench/UASTC.md has the maps):
//   endpoints in two planes moved step by step only, as for BC7: on water fast 1.041 instead of 0.953, normal 0.873
//   instead of 0.858, best 0.843 instead of 0.831
//   lengths freer (a weight of 0.01, not 0.05): 1 % smaller angles, but 2.5 % larger ones as BC1, 2 % as ETC1
//   z of both endpoints tilted as further starts: 1.3 % smaller angles, but 3 % larger ones as BC1

#pragma once

#include <cstddef>

#include <tex/format.h>
#include <tex/pack.h>

namespace tex::inline v1 {

// Encodes rows of blocks of 4x4 texels. `texels` holds x, y and z of each, `extent.height` rows of `extent.width`.
// Blocks that are partly outside repeat the last texels. A block depends on its texels alone. Throws
// std::bad_alloc.
//
// Without lent memory, which takes uastc_memory() or uastc_xy_memory(), it comes from the heap.
void encode_uastc(Format format, Effort effort, const float* texels, Extent extent, std::byte* blocks);

// `xy` holds x and y, which become luminance and alpha: R = G = B = x, A = y. The error is that of the normals
// (x, y, sqrt(1 - x^2 - y^2)), in the modes of luminance and alpha.
void encode_uastc_xy(Format format, Effort effort, const float* xy, Extent extent, std::byte* blocks);
[[nodiscard]] std::size_t uastc_xy_memory(Format format, Effort effort, int width, int rows);

[[nodiscard]] std::size_t uastc_memory(Format format, Effort effort, int width, int rows);
// So many rows of blocks are encoded together best.
[[nodiscard]] int uastc_rows_at_once(Format format, int width);

}  // namespace tex::inline v1
