// SPDX-License-Identifier: Apache-2.0
// texel_steps.h: the steps of a repair, applied to stored values.

#pragma once

#include <tex/repair.h>

#include "repairs/stored_levels.h"

namespace tex::inline v1 {

// Applies a step to all levels. `figure` is that of its finding; `current` is the texture as it stands, from which the
// background is found.
// Errors: unsupported (the step does not suit this layout), out_of_memory, cancelled.
[[nodiscard]] Result<void> apply_step(const RepairStep& step, double figure, const RepairOptions& options,
                                      const Texture& current, StoredLevels& levels, const Execution& execution);

}  // namespace tex::inline v1
