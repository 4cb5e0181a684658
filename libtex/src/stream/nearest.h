// SPDX-License-Identifier: Apache-2.0
// nearest.h: holes in a height field take the value of the nearest texel that has one.

#pragma once

#include <tex/execution.h>
#include <tex/height_field.h>
#include <tex/result.h>

#include "threads/parallel.h"

namespace tex {

// Replaces every NaN of `heights` by the value of the nearest other texel: Euclidean distance, around the
// border where an axis repeats; of equally near ones that of the smallest row, then column. Exact, in time
// proportional to the texels however large the holes are: Meijster, Roerdink, Hesselink, A General
// Algorithm for Computing Distance Transforms in Linear Time, 2000 (see also Felzenszwalb, Huttenlocher,
// 2012). A mirror image is never nearer than its texel, so that mirror and clamp need no care.
//
// Precondition: at least one texel is not NaN. Errors: out_of_memory, cancelled.
Result<void> fill_from_nearest(PlaneView<float> heights, Wrap wrap_x, Wrap wrap_y, const Execution& execution,
                               ProgressSpan span);

}  // namespace tex
