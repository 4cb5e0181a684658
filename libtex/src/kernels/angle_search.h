// SPDX-License-Identifier: Apache-2.0
// angle_search.h: both channels of a block together, for the least angles.
//
// The measure of a texel is the squared chord |n - m|^2 = 2 - 2 cos(angle) between the normals that source and block
// stand for, z = sqrt(1 - min(1, x^2 + y^2)): for small angles their square. It is summed over the texels of the level.
// For given endpoints each texel takes the best one of all pairs of values (8 of x with 4 or 8 of y), which need not be
// the nearest ones of x and of y; the endpoints go, from those that have the least squared error in each channel,
// wherever one step of up to 3 codes of one endpoint, or of both endpoints of a channel, gains most, until none gains.
//
// So the sum is never greater than that of the block it starts from, the indices are the best for the endpoints, and no
// such step is left; that no endpoints elsewhere are better is not proved. A block keeps its kinds of palette (8 or 6
// values).

#pragma once

#include <cstddef>

#include <tex/format.h>

#include "kernels/encode.h"

namespace tex {

// Improves the blocks of a row, which encode_dxt5nm() and its like wrote.
void improve_angles(const BlockRow& row, Encoding encoding, std::byte* blocks);

}  // namespace tex
