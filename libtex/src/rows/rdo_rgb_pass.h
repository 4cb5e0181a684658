// SPDX-License-Identifier: Apache-2.0
// rdo_rgb_pass.h: a pass of rate-distortion optimisation over the blocks of a band of BC7 or UASTC (rdo_copy_pass.h).
// Fronts are all that is in front of the indices, mode, partition, endpoints and (UASTC) hints; each texel takes the
// closest entry.

#pragma once

#include <memory>

#include "rows/rdo_rate.h"
#include "rows/rdo_rgb_band.h"
#include "rows/rdo_runs.h"

namespace tex::inline v1 {

// A pass. What is kept are the plain blocks. `literals` are those of the pass before. Throws std::bad_alloc.
[[nodiscard]] std::unique_ptr<RdoRuns> rdo_rgb_pass(const RdoRgbBand& band, const ByteCounts& literals);

}  // namespace tex::inline v1
