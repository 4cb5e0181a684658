// SPDX-License-Identifier: Apache-2.0
// smooth_heights.h: a map that was baked from heights of few values, baked again from the heights between these values.

#pragma once

#include "repairs/stored_levels.h"

namespace tex::inline v1 {

// Finds the heights behind the base level, whose slopes are multiples of about `step`, smooths their steps as deband()
// does, and bakes them again. What is no such surface stays. Errors: unsupported (central differences of whole heights
// do not explain the slopes), out_of_memory, cancelled.
[[nodiscard]] Result<void> smooth_heights(StoredLevels& levels, double step, const Execution& execution);

}  // namespace tex::inline v1
