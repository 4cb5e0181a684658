// SPDX-License-Identifier: Apache-2.0
// measures.h: what the false colours show: a value for every texel of a normal map.

#pragma once

#include <tex/execution.h>
#include <tex/normal_map.h>
#include <tex/preview.h>

#include "preview/legend.h"

namespace tex::render {

struct Measure {
    Plane<float> values;
    ColorScale scale;
};

// True for slope, tilt, length, z_error and curl.
[[nodiscard]] bool is_measure(Show show);

// The measure `show` of preview.h, with a scale up to `maximum`, or a chosen one where that is 0. Errors: cancelled,
// out_of_memory.
[[nodiscard]] Result<Measure> measure(Show show, const NormalMap& map, float maximum, const Execution& execution);

// 1, 2 or 5 times a power of ten: the least such number that is not below the 99.5th percentile of |values|, and
// `least` at least.
[[nodiscard]] double round_maximum(const Plane<float>& values, double least);

}  // namespace tex::render
