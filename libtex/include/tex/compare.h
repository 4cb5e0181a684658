// SPDX-License-Identifier: Apache-2.0
// compare.h: the angles between two normal maps, in degrees.

#pragma once

#include <cstdint>

#include <tex/execution.h>
#include <tex/image.h>
#include <tex/normal_map.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// The distribution of the angle between the normals of two maps, in degrees (0 to 180).
//
// Percentiles are exact, by nearest rank: p99 is the smallest angle that at least 99 % of the texels do not exceed.
struct AngularError {
    std::int64_t texels = 0;
    double mean = 0.0;
    double rms = 0.0;  // square root of the mean square
    double p50 = 0.0;  // the median
    double p99 = 0.0;
    double p999 = 0.0;  // 99.9 %
    double max = 0.0;
    int max_column = 0;  // the first texel, in rows from the top, that has the largest angle
    int max_row = 0;
};

struct Comparison {
    AngularError error;
    Plane<float> degrees;  // the angle of each texel
};

// Compares two maps of unit vectors, texel by texel:
//
//     angle = 2 asin(|a - b| / 2)
//
// This is accurate near 0, unlike acos(dot(a, b)): in float, acos returns no angle between 0 and 0.02 degrees. Here
// equal vectors are exactly 0 degrees apart. The error is below 0.0001 degrees up to 170 degrees, and below 0.03
// degrees beyond.
//
// Preconditions (asserted): both maps have the same extent, at least 1x1.
// Errors: out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<Comparison> compare(const NormalMap& a, const NormalMap& b, const Execution& execution = {});

}  // namespace tex
#pragma GCC visibility pop
