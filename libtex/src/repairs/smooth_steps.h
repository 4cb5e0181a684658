// SPDX-License-Identifier: Apache-2.0
// smooth_steps.h: the values between the steps of a map that was reduced to few values.

#pragma once

#include "repairs/stored_levels.h"

namespace tex::inline v1 {

// Smooths x, y and z of the base level, each value within half a step. Errors: unsupported (the values lie on no steps
// of 4 codes of 8 bits or more), out_of_memory, cancelled.
[[nodiscard]] Result<void> smooth_base(StoredLevels& levels, const Execution& execution);

}  // namespace tex::inline v1
