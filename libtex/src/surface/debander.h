// SPDX-License-Identifier: Apache-2.0
// debander.h: what deband() does, for the sources of heights.

#pragma once

#include <tex/height.h>
#include <tex/types.h>

#include "threads/parallel.h"

namespace tex::inline v1 {

// Does what deband() does, on heights with these wraps. Errors: out_of_memory, cancelled. May throw std::bad_alloc.
Result<DebandReport> deband_heights(Plane<float>& heights, Wrap wrap_x, Wrap wrap_y, Deband when,
                                    const Execution& execution, ProgressSpan span);

}  // namespace tex::inline v1
