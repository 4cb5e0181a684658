// SPDX-License-Identifier: Apache-2.0
// measures.h: the data behind the false colours: a value for every texel of a normal map.

#pragma once

#include <tex/preview.h>
#include <tex/types.h>

#include "preview/legend.h"

namespace tex::inline v1::render {

struct Measure {
    Plane<float> values;
    ColorScale scale;
};

// The measure options.show of preview.h, with a scale up to options.maximum, or up to a suitable value if that is 0.
// Precondition: it is slope, tilt, length, z_error, curl or curvature. Errors: cancelled, out_of_memory.
[[nodiscard]] Result<Measure> measure(const PreviewOptions& options, const NormalMap& map, const Execution& execution);

// The least number of the form 1, 2 or 5 times a power of ten that is not below the 99.5th percentile of |values|, and
// not below `least`.
[[nodiscard]] double round_maximum(const Plane<float>& values, double least);

// The least of 0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 20, 30, 45, 60, 90 and 180 degrees that is not below `degrees`.
[[nodiscard]] double round_angle(double degrees);

}  // namespace tex::inline v1::render
