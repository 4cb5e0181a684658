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

#include <tex/pack.h>

#include "rows/rdo_band.h"
#include "rows/rdo_budget.h"
#include "rows/rdo_rate.h"

namespace tex::inline v1 {

struct RdoResult {
    std::vector<std::byte> blocks;
    ByteCounts literals{};
    double growth = 0.0;       // of the sum of angles, in degrees, from that of the improved literals
    double most_raised = 0.0;  // see RdoAngles
    bool is_whole = false;     // unless the pass stopped early
};

// Optimises all blocks. Those for which the budget has nothing left become improved literals. `literals` are those of
// the pass before. If `may_stop` is set, it returns as soon as the budget has wandered. Throws std::bad_alloc.
RdoResult rdo_pass(const RdoBand& band, RdoBudget& budget, bool may_stop, const ByteCounts& literals);

// Optimises one of `stride` runs of blocks, at one lambda, in degrees for each bit; the others become improved
// literals.
struct RdoSample {
    std::vector<double> growths;  // one for each sampled run
    ByteCounts literals{};
};
RdoSample rdo_sample(const RdoBand& band, float lambda, int stride, const ByteCounts& literals);

}  // namespace tex::inline v1
