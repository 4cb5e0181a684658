// SPDX-License-Identifier: Apache-2.0
// heat_map.h: angles as a picture with a legend.

#pragma once

#include <tex/execution.h>
#include <tex/image.h>
#include <tex/result.h>

#pragma GCC visibility push(default)
namespace tex {

// The rows of the legend under the picture, and its minimum width.
inline constexpr int kHeatMapLegendRows = 36;
inline constexpr int kHeatMapLeastWidth = 128;

// A picture of angles in degrees, one pixel for each texel: planes R, G, B in [0, 1]. Black is 0, pale yellow is
// `full_scale` degrees or more. (The colours are those of matplotlib's "inferno", Smith and van der Walt 2015, in ten
// linear pieces. Their lightness grows evenly, so they are also readable in grey and with red-green colour blindness.)
// A legend of kHeatMapLegendRows rows is below the map: the colours from 0 on the left to full_scale on the right, with
// the values at both ends. If a map is narrower than kHeatMapLeastWidth, the rest of the picture is black.
//
// Precondition: `degrees` has no NaN.
// Errors: bad_option (`degrees` has no texels; full_scale is not above 0 and at most 180), out_of_memory, cancelled.
// The same bytes for every number of threads, processor and compiler.
[[nodiscard]] Result<Image> heat_map(const Plane<float>& degrees, double full_scale, const Execution& execution = {});

// The angles for a smaller picture. The longer side is divided into at most `side` cells; each cell holds its largest
// angle, so that none is lost. Cells are square and span a whole number of texels, except those at the right and lower
// border.
// Errors: bad_option (`degrees` has no texels; side is below 1), out_of_memory.
[[nodiscard]] Result<Plane<float>> largest_of_cells(const Plane<float>& degrees, int side);

}  // namespace tex
#pragma GCC visibility pop
