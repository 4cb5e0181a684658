// SPDX-License-Identifier: Apache-2.0
// debander.h: what deband() does, for the sources of heights.

#pragma once

#include <tex/deband_options.h>
#include <tex/execution.h>
#include <tex/height_field.h>
#include <tex/image.h>
#include <tex/result.h>

#include "threads/parallel.h"

namespace tex {

// As deband(), on heights with those wraps. Errors: out_of_memory, cancelled. May throw std::bad_alloc.
Result<DebandReport> deband_heights(Plane<float>& heights, Wrap wrap_x, Wrap wrap_y, Deband when,
                                    const Execution& execution, ProgressSpan span);

}  // namespace tex
