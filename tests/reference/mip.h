// SPDX-License-Identifier: Apache-2.0
// mip.h: mip chains, see tex/mip.h.

#pragma once

#include <vector>

#include <tex/mip.h>

#include "reference/grid.h"

namespace tex::reference {

// weights[k] is the weight of texel `first + k` in a level of n texels for texel i of the next level, which has max(1,
// n / 2) texels. The sum of the weights is 1.
struct Weights {
    int first = 0;
    std::vector<double> weights;
};
Weights mip_weights(MipFilter filter, int n, int i);

// The averages of each level before normalisation: vectors or, in the slope domain, (x/z, y/z, 0).
std::vector<Grid<Vector>> mip_averages(const Grid<Vector>& base, const MipOptions& options);

// The stored levels.
std::vector<Grid<Vector>> build_mip_chain(const Grid<Vector>& base, const MipOptions& options);

}  // namespace tex::reference
