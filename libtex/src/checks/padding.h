// SPDX-License-Identifier: Apache-2.0
// padding.h: how many mip levels keep the charts of a mesh apart.

#pragma once

#include <cstdint>

#include <tex/types.h>

#include "checks/stored.h"

namespace tex::inline v1 {

// In a plane of charts: no triangle covers the texel.
inline constexpr std::int32_t kNoChart = -1;

// What the texels of a level mix that lie on the border of a chart, that is, that also cover texels outside of it.
struct PaddingMeasure {
    int level = 0;            // the first level that is not clean; 0 if all that were measured are
    double share = 0.0;       // of its texels on borders: those that mix in background or another chart
    bool background = false;  // there, more of them mix in background than another chart
};

// Measures level 1 and the smaller ones, as long as the longer side has kPaddedSide texels or more (thresholds.h).
// `charts` has the chart of each texel, or kNoChart, and is overwritten.
//
// Background is the most frequent value of x and y outside of the charts. It harms where the nearest texel of a chart
// differs from it: padding that continues a flat chart looks like flat background.
//
// Errors: out_of_memory, cancelled.
Result<PaddingMeasure> measure_padding(const Stored& stored, Plane<std::int32_t>& charts, const Execution& execution);

}  // namespace tex::inline v1
