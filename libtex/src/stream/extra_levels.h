// SPDX-License-Identifier: Apache-2.0
// extra_levels.h: the smaller levels of data beside normals, in memory. The same values as those of level_stage.h.

#pragma once

#include <vector>

#include <tex/mip.h>
#include <tex/types.h>

#include "threads/parallel.h"

namespace tex::inline v1 {

// Returns levels 1 to count - 1 of data that values_to_average() has made ready. `normals` is their base level, which
// matters to kinds that follow it. Errors: out_of_memory, cancelled. May throw std::bad_alloc.
Result<std::vector<Plane<float>>> smaller_levels(const NormalMap& normals, Plane<float> averages, ExtraKind kind,
                                                 RoughnessModel model, const MipOptions& options, int count,
                                                 const Execution& execution, ProgressSpan span);

// Adds the data beside the base level of a chain to its smaller levels. Errors and exceptions: as smaller_levels().
Result<void> add_extras(MipChain& chain, const MipOptions& options, const Execution& execution);

}  // namespace tex::inline v1
