// SPDX-License-Identifier: Apache-2.0
// rdo_rgb_pass.h: one pass of rate-distortion optimisation over the blocks of a band of BC7 or UASTC.
//
// For each block it compares
//
//     literals    the block as it is without optimisation
//     wholes      all 16 bytes of a block in the window
//     fronts      all that is in front of the indices of one, its mode, partition, endpoints and (UASTC) hints, with
//                 indices that are chosen again: each texel takes the closest entry
//
// also of the block before and of those at the last three distances, which a coder writes in a few bits, and takes the
// one with the least D + lambda R. rdo_rgb_sources.h picks the blocks that are worth a copy.

#pragma once

#include <memory>

#include "rows/rdo_rate.h"
#include "rows/rdo_rgb_band.h"
#include "rows/rdo_runs.h"

namespace tex::inline v1 {

// A pass. What is kept are the plain blocks. `literals` are those of the pass before. Throws std::bad_alloc.
[[nodiscard]] std::unique_ptr<RdoRuns> rdo_rgb_pass(const RdoRgbBand& band, const ByteCounts& literals);

}  // namespace tex::inline v1
