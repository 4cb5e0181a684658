// SPDX-License-Identifier: Apache-2.0
// rdo_astc_pass.h: a pass of rate-distortion optimisation over the blocks of a band of ASTC (rdo_copy_pass.h). Fronts
// are the mode and the endpoints, with weights that are fitted again. (Copying the weights and fitting the endpoints
// was tried: beside the other two, it saves next to nothing.)

#pragma once

#include <memory>

#include "rows/rdo_astc_band.h"
#include "rows/rdo_rate.h"
#include "rows/rdo_runs.h"

namespace tex::inline v1 {

// A pass. What is kept are the plain blocks. `literals` are those of the pass before. Throws std::bad_alloc.
[[nodiscard]] std::unique_ptr<RdoRuns> rdo_astc_pass(const RdoAstcBand& band, const ByteCounts& literals);

}  // namespace tex::inline v1
