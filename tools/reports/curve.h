// SPDX-License-Identifier: Apache-2.0
// curve.h: what rate-distortion optimisation costs and saves, measured, printed and drawn.

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tex/check.h>
#include <tex/pack.h>
#include <tex/types.h>

#include "cli/console.h"
#include "cli/exit_code.h"
#include "reports/comparison.h"

namespace tex::cli {

struct CurvePoint {
    float rdo_mean = 0.0f;   // degrees
    std::int64_t bytes = 0;  // of a KTX2 file with zstd -19
    AngularError error;      // from the normals to those of the blocks
};

// Packs the base level. Errors: those of pack() and encode_file().
[[nodiscard]] Result<CurvePoint> measure_point(const MipChain& map, const PackOptions& options,
                                               const Execution& execution);

// Prints the last of the points: as a line of a table (the first point has a heading above it) or as JSON. The change
// in bytes is relative to the first point.
[[nodiscard]] ExitCode print_point(Console& console, const ComparisonRun& run, const std::vector<CurvePoint>& points,
                                   const PackOptions& options, bool as_json);

// A picture in SVG, for light and dark backgrounds: bytes over the mean, over the 99.9th percentile and over the
// largest angle. `title` is escaped. Precondition: at least one point.
[[nodiscard]] std::string plot_curve(const std::string& title, const std::vector<CurvePoint>& points);

}  // namespace tex::cli
