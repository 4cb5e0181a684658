// SPDX-License-Identifier: Apache-2.0
// rdo_astc_band.h: the blocks of a band of ASTC, and the angles of their texels, for rate-distortion optimisation.

#pragma once

#include <cstddef>
#include <vector>

#include <tex/pack.h>

#include "blocks/astc_plan.h"
#include "rows/rdo_band.h"
#include "rows/rdo_parts.h"
#include "rows/rdo_runs.h"

namespace tex::inline v1 {

// Texels of a block in rows of its width; what follows the last one is outside.
struct RdoAstcBlock {
    float x[kAstcMostPlanned], y[kAstcMostPlanned], z[kAstcMostPlanned];  // of unit normals, y as it is stored
    float most[kAstcMostPlanned];                                         // the longest chord that is allowed
    float inside[kAstcMostPlanned];                                       // 1, or 0 outside the level
    float plain[kAstcMostPlanned];                                        // chords without optimisation
    double plain_sum = 0.0;                                               // of the angles, in degrees
};

struct RdoAstcBand : RdoBlocks {
    int across = 0;  // blocks
    RdoParts places;
    std::vector<RdoAstcBlock> blocks;

    // The part of texel k of a block.
    [[nodiscard]] int part_at(std::size_t index, int k) const {
        const int n = static_cast<int>(index);
        return places.at(n % across * block.width + k % block.width, n / across * block.height + k / block.width);
    }
    // Whether the texels of a block are in several parts. (Texels outside the level are in the last ones.)
    [[nodiscard]] bool is_divided(std::size_t index) const {
        return part_at(index, 0) != part_at(index, block_texels - 1) ||
               part_at(index, block.width - 1) != part_at(index, block_texels - block.width);
    }
};

// Reads blocks of `height` rows of texels, as encode_astc() takes and writes them; the first of them is row `first` of
// this level. Throws std::bad_alloc.
RdoAstcBand read_astc_band(const float* xy, int height, Extent level, int first, const PackOptions& options,
                           const std::byte* blocks);

// What 16 bytes decode to.
struct RdoAstcTexels {
    float x[kAstcMostPlanned] = {}, y[kAstcMostPlanned] = {};
};
void decode_astc_normals(Extent block, const std::byte* bytes, RdoAstcTexels& texels);

// The sum of the chords between a block and decoded texels, or kTooLong if one is longer than is allowed.
float astc_chord_sum(const RdoAstcBlock& block, int texels, const RdoAstcTexels& decoded);

// How much the angles in each part grow if a block decodes to these texels.
std::vector<double> astc_growths(const RdoAstcBand& band, std::size_t index, const RdoAstcTexels& decoded);

// The angles of decoded texels.
RdoAngles astc_angles(const RdoAstcBlock& block, int texels, const RdoAstcTexels& decoded);

}  // namespace tex::inline v1
