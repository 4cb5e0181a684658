// SPDX-License-Identifier: Apache-2.0
// angle_search.h: searches both channels of a block together for the least angles.
//
// The measure of a texel is the squared chord |n - m|^2 = 2 - 2 cos(angle) between the normals of the source and of the
// block, with z = sqrt(1 - min(1, x^2 + y^2)). For small angles it is the square of the angle. It is summed over the
// texels of the level. For given endpoints, each texel takes the best of all pairs of values (8 of x with 4 or 8 of y),
// which need not be the nearest values of x and of y. The search starts from the endpoints with the least squared error
// in each channel. It then changes one endpoint, or both endpoints of a channel, by up to 3 codes, takes the step with
// the greatest gain, and repeats this until no step gains.
//
// So the sum is never greater than that of the block from which the search starts, the indices are the best for the
// endpoints, and no step of this type would improve the block. It is not proved that no better endpoints exist
// elsewhere. Each channel keeps its type of palette (8 or 6 values).

#pragma once

#include <cstddef>

#include "blocks/block_half.h"
#include "kernels/encode.h"

namespace tex::inline v1 {

// Improves the blocks of a row that were written by encode_dxt5nm() or a similar function. Steps change endpoints by up
// to `reach` codes, at most kAngleReach. `kinds`: of the halves, BC4 or green.
inline constexpr int kAngleReach = 3;
void improve_angles(const BlockRow& row, const HalfKind kinds[2], int reach, std::byte* blocks);

}  // namespace tex::inline v1
