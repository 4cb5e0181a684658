// SPDX-License-Identifier: Apache-2.0
// bc7_planes.h: fits endpoints and indices of BC7 in two planes.

#pragma once

#include "kernels/bc7_fit.h"

namespace tex::inline v1 {

// Blocks of two planes: the scalar one has the component 0 of `value`, the colours have 1 and 2, of which 2 is the
// greatest. If `starts`, the endpoints of 0 and 1 are there and those of 2 are found.
void fit_bc7_planes(const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group);

}  // namespace tex::inline v1
