// SPDX-License-Identifier: Apache-2.0
// nearest.h: finds, for each hole in a plane, the nearest texel that has a value.

#pragma once

#include <cstdint>
#include <functional>

#include <tex/height.h>
#include <tex/types.h>

#include "threads/parallel.h"

namespace tex::inline v1 {

// A hole, and the nearest texel that has a value.
struct NearestTexel {
    int i, j;
    int column, row;
    std::int64_t squared;  // the square of their distance, in texels^2
};

// Calls fill(hole) for every NaN in `values`. The distance is Euclidean, and goes around the border on an axis that
// repeats. If several texels are equally near, the one with the smallest row wins, then the one with the smallest
// column. The result is exact, and the time is proportional to the number of texels, however large the holes are:
// Meijster, Roerdink, Hesselink, A General Algorithm for Computing Distance Transforms in Linear Time, 2000 (see also
// Felzenszwalb, Huttenlocher, 2012). A mirror image is never nearer than its texel, so mirror and clamp need no special
// treatment.
//
// fill() is called from several threads at once, each time for another hole. It may give that hole its value.
//
// Precondition: at least one texel is not NaN. Errors: out_of_memory, cancelled.
Result<void> visit_holes(PlaneView<const float> values, Wrap wrap_x, Wrap wrap_y, const Execution& execution,
                         ProgressSpan span, const std::function<void(const NearestTexel& hole)>& fill);

// Replaces every NaN in `heights` by the value of the nearest other texel. As visit_holes().
Result<void> fill_from_nearest(PlaneView<float> heights, Wrap wrap_x, Wrap wrap_y, const Execution& execution,
                               ProgressSpan span);

}  // namespace tex::inline v1
