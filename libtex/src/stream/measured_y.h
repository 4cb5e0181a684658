// SPDX-License-Identifier: Apache-2.0
// measured_y.h: SourceOptions::measure_y: finds out where y points before the normals are read.

#pragma once

#include <tex/source.h>

#include "stream/map_source.h"

namespace tex {

// The options with which the normals of `map` are read: with the direction of y that its base level shows. Reads the
// base level once, row by row. The caller opens the map again. Errors: those of read_normals().
Result<SourceOptions> with_measured_y(MapSource& map, const SourceOptions& options);

// The error for a map whose texels do not show it.
[[nodiscard]] Error undecided_y(const std::string& path);

}  // namespace tex
