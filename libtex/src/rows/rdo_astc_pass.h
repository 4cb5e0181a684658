// SPDX-License-Identifier: Apache-2.0
// rdo_astc_pass.h: one pass of rate-distortion optimisation over the blocks of a band of ASTC.
//
// For each block it compares
//
//     literals    the block as it is without optimisation
//     wholes      all 16 bytes of a block in the window
//     fronts      the mode and the endpoints of one, with weights that are fitted again. Weights are at the end of a
//                 block, so that the bytes in front of them are the same
//
// also of the block before and of those at the last three distances, which a coder writes in a few bits, and takes the
// one with the least D + lambda R. rdo_astc_sources.h picks the blocks that are worth a copy. (Copying the weights and
// fitting the endpoints was tried: beside the other two, it saves next to nothing.)

#pragma once

#include <memory>

#include "rows/rdo_astc_band.h"
#include "rows/rdo_rate.h"
#include "rows/rdo_runs.h"

namespace tex::inline v1 {

// A pass. What is kept are the plain blocks. `literals` are those of the pass before. Throws std::bad_alloc.
[[nodiscard]] std::unique_ptr<RdoRuns> rdo_astc_pass(const RdoAstcBand& band, const ByteCounts& literals);

}  // namespace tex::inline v1
