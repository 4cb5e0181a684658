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

#include <memory>

#include "rows/rdo_band.h"
#include "rows/rdo_rate.h"
#include "rows/rdo_runs.h"

namespace tex::inline v1 {

// A pass. What is kept are the improved literals. `literals` are those of the pass before. Throws std::bad_alloc.
[[nodiscard]] std::unique_ptr<RdoRuns> rdo_pass(const RdoBand& band, const ByteCounts& literals);

}  // namespace tex::inline v1
