// SPDX-License-Identifier: Apache-2.0
// angular_error.h: the distribution of the angles between two normal maps.

#pragma once

#include <cstdint>

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

}  // namespace tex
#pragma GCC visibility pop
