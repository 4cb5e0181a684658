// SPDX-License-Identifier: Apache-2.0
// nearest.h: gives each hole in a height field the value of the nearest texel that has one.

#pragma once

#include <tex/execution.h>
#include <tex/height_field.h>
#include <tex/result.h>

#include "threads/parallel.h"

namespace tex {

// Replaces every NaN in `heights` by the value of the nearest other texel. The distance is Euclidean, and goes around
// the border on an axis that repeats. If several texels are equally near, the one with the smallest row wins, then the
// one with the smallest column. The result is exact, and the time is proportional to the number of texels, however
// large the holes are: Meijster, Roerdink, Hesselink, A General Algorithm for Computing Distance Transforms in Linear
// Time, 2000 (see also Felzenszwalb, Huttenlocher, 2012). A mirror image is never nearer than its texel, so mirror and
// clamp need no special treatment.
//
// Precondition: at least one texel is not NaN. Errors: out_of_memory, cancelled.
Result<void> fill_from_nearest(PlaneView<float> heights, Wrap wrap_x, Wrap wrap_y, const Execution& execution,
                               ProgressSpan span);

}  // namespace tex
