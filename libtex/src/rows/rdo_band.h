// SPDX-License-Identifier: Apache-2.0
// rdo_band.h: the blocks of a band, and the angles of their texels, for rate-distortion optimisation.

#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <tex/pack.h>

#include "blocks/block_half.h"
#include "kernels/encode.h"
#include "rows/rdo_runs.h"

namespace tex::inline v1 {

// The normals of a block, as its texels store them: y is negated if the texture's y points down.
struct RdoBlock {
    float x[16], y[16], z[16];
    float most[16];    // the longest chord that is allowed
    float inside[16];  // 1, or 0 outside the level
};

// The angles of a block's texels in the level.
struct RdoAngles {
    double sum = 0.0;          // degrees
    double most_raised = 0.0;  // degrees: the greatest of those that are greater than without optimisation
};

struct RdoBand : RdoBlocks {
    const HalfKind* kinds = nullptr;  // of x and y
    std::vector<RdoBlock> blocks;
    std::vector<std::byte> improved;      // the same or better literals
    std::vector<float> plain_chords;      // 16 a block
    std::vector<double> improved_angles;  // the sum of the angles of each block of `improved`
};

// Reads `count` rows of blocks, which encode_blocks() has written one after the other; the first of them begins at row
// `first` of this level. Throws std::bad_alloc.
RdoBand read_band(const std::function<BlockRow(int row)>& rows, int count, Extent level, int first,
                  const PackOptions& options, const std::byte* blocks);

// The texels of a block, each with its chord, what that was without optimisation, and 1 or 0: see RdoBlock.
RdoAngles angles_of(const float* chords, const float* plain, const float* inside, int texels);

// The sum of the chords of a block, or kTooLong if one is longer than is allowed.
float chord_sum_of(const float* chords, const float* most, const float* inside, int texels);

// The angle of a chord between unit vectors, in degrees.
double degrees_of_chord(float chord);

// The longest chord that a texel of a part may get.
float longest_chord(const RdoOptions& options, const RdoPart& part);

// A normal with x and y within [-1, 1], made unit.
struct RdoNormal {
    float x, y, z;
};
RdoNormal rdo_normal(float x, float y);

// The angles of 16 bytes as block `index`.
RdoAngles rdo_angles(const RdoBand& band, std::size_t index, const std::byte* bytes);

}  // namespace tex::inline v1
