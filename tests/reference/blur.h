// SPDX-License-Identifier: Apache-2.0
// blur.h: the Gaussian blur of heights, see HeightOptions::blur_sigma in tex/height.h.

#pragma once

#include <tex/height.h>

#include "reference/grid.h"

namespace tex::reference {

Grid<double> blur(const Grid<double>& heights, double sigma, Wrap wrap_x, Wrap wrap_y);

}  // namespace tex::reference
