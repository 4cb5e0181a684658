// SPDX-License-Identifier: Apache-2.0
// mip.h: mip chains, see tex/mip.h.

#pragma once

#include <vector>

#include <tex/mip.h>

#include "reference/grid.h"

namespace tex::reference {

// What texel i of a level of max(1, n / 2) texels takes from texel `first + k` of one of n: weights[k]; sum
// 1.
struct Weights {
    int first = 0;
    std::vector<double> weights;
};
Weights mip_weights(MipFilter filter, int n, int i);

// The averages of each level, before anything is normalised: vectors, or (x/z, y/z, 0) in the slope domain.
std::vector<Grid<Vector>> mip_averages(const Grid<Vector>& base, const MipOptions& options);

// What is stored.
std::vector<Grid<Vector>> build_mip_chain(const Grid<Vector>& base, const MipOptions& options);

}  // namespace tex::reference
