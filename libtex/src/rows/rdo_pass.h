// SPDX-License-Identifier: Apache-2.0
// rdo_pass.h: one pass of rate-distortion optimisation over the blocks of a band.
//
// The pass goes through the blocks in the order of the file, and through the halves of each block, x first. For each
// half it compares
//
//     literals    the half as it is without optimisation, or with the angles improved
//     copies      the indices of a half in the window, with endpoints fitted again by least squares; the indices and
//                 one endpoint; all 8 bytes; the same at the same distance for x and y, which a coder writes as one
//                 match; and at the last three distances, which a coder writes in a few bits
//
// and takes the one with the least D + lambda R. rdo_sources.h picks the halves that are worth a copy, by estimates;
// rdo_candidates.h fits and decodes the copies, which are then measured as angles, all at once. R is estimated by
// rdo_rate.h.

#pragma once

#include <cstddef>
#include <vector>

#include <tex/pack_options.h>

#include "rows/rdo_rate.h"

namespace tex {

// The normals of a block, as its texels store them: y is negated if the texture's y points down.
struct RdoBlock {
    float x[16], y[16], z[16];
    float most[16];    // the longest chord that is allowed
    float inside[16];  // 1, or 0 outside the level
};

struct RdoBand {
    Encoding encoding;
    int window;  // bytes
    std::vector<RdoBlock> blocks;
    std::vector<std::byte> plain;     // 16 bytes a block
    std::vector<std::byte> improved;  // the same or better literals
};

struct RdoResult {
    std::vector<std::byte> blocks;
    ByteCounts literals{};
};

// `literals` are those of the pass before. `lambda` is in degrees for each bit. Throws std::bad_alloc.
RdoResult rdo_pass(const RdoBand& band, float lambda, const ByteCounts& literals);

}  // namespace tex
