// SPDX-License-Identifier: Apache-2.0
// roughness.h: roughness maps of mip chains, see tex/mip.h.

#pragma once

#include <vector>

#include <tex/mip.h>

#include "reference/grid.h"

namespace tex::reference {

// alpha'^2 if averaged vectors have the length m. Toksvig's model uses powers of lobes, as he wrote it.
double rougher_alpha2(RoughnessModel model, double m, double alpha2);

std::vector<Grid<double>> build_roughness_chain(const Grid<Vector>& base, const Grid<double>& roughness,
                                                RoughnessModel model, const MipOptions& options);

}  // namespace tex::reference
