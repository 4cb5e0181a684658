// SPDX-License-Identifier: Apache-2.0
// rdo_rgb_band.h: the blocks of a band of BC7 or UASTC, and the angles of their texels, for
// rate-distortion optimisation.
//
// Only directions count: decoded vectors of x, y and z are made unit. Where alpha holds data, a texel is a vector of
// four components, the last of which is twice alpha, as the encoder weighs it; the "angle" of such texels is that whose
// chord is as long as the distance of these vectors.

#pragma once

#include <cstddef>
#include <vector>

#include <tex/pack.h>

#include "blocks/block_entries.h"
#include "rows/rdo_band.h"
#include "rows/rdo_runs.h"

namespace tex::inline v1 {

// Texels as vectors of four components.
struct RdoRgbTexels {
    float value[4][16];
};

struct RdoRgbBlock {
    RdoRgbTexels texels;     // of the source, y as it is stored
    float most[16];          // the longest chord that is allowed
    float inside[16];        // 1, or 0 outside the level
    float plain[16];         // chords without optimisation
    double plain_sum = 0.0;  // of the angles, in degrees
};

// The entries of a block as vectors, and which texels can have them.
struct RdoRgbEntries {
    RdoRgbEntries() = default;
    // `is_xy`: R and A are x and y, and z follows from them.
    RdoRgbEntries(const BlockEntries& block, bool is_xy);

    BlockEntries block;
    float value[4][BlockEntries::kMost] = {};
    unsigned char row[BlockEntries::kMost] = {};
    float distances[6][16] = {};
};

struct RdoRgbBand : RdoBlocks {
    BlockEntries (*read_entries)(const std::byte* block) = nullptr;
    bool is_xy = false;

    [[nodiscard]] RdoRgbEntries entries(const std::byte* bytes) const { return {read_entries(bytes), is_xy}; }
    std::vector<RdoRgbBlock> blocks;
};

// Reads blocks of `height` rows of texels of `values` components, as encode_bc7() and encode_uastc() take and write
// them; the first of them is row `first` of this level. Throws std::bad_alloc.
RdoRgbBand read_rgb_band(const float* texels, int height, Extent level, int first, const PackOptions& options,
                         const std::byte* blocks);

// The texels of the block `bytes`, whose entries these are.
void decode_rgb_entries(const RdoRgbEntries& entries, const std::byte* bytes, RdoRgbTexels& texels);

// The sum of chords of these squares, or kTooLong if one is longer than is allowed.
float rgb_chord_sum(const RdoRgbBlock& block, const float squares[16]);

// The angles of decoded texels.
RdoAngles rgb_angles(const RdoRgbBlock& block, const RdoRgbTexels& decoded);

}  // namespace tex::inline v1
