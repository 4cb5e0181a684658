// SPDX-License-Identifier: Apache-2.0
// uastc_kinds.h: the ways in which the encoder uses the modes of UASTC. Modes 1 and 9 to 17 are not tried: mode 5 has
// more levels than mode 1, and the others store alpha (uastc_xy_fit.h).

#pragma once

#include "kernels/bc7_fit.h"

namespace tex::inline v1 {

// In this order; UastcBatch depends on it.
enum UastcKindNumber {
    kUastcPlanes = 0,  // two planes, of which the second one has a component of the normal
    kUastcOne = 1,     // 3 of one line
    kUastcParts = 4,   // 4 of several subsets
    kUastcKinds = 8,
};

// Kinds as those of BC7; instead of bits they name ranges of endpoints, of kAstcRangeTable.
inline constexpr Bc7Kind kUastcKindTable[kUastcKinds] = {
    {6, 1, 18, 4, Bc7Lowest::none, false, false, 18, 4}, {0, 1, 19, 16, Bc7Lowest::none, false, false, 0, 0},
    {5, 1, 20, 8, Bc7Lowest::none, false, false, 0, 0},  {18, 1, 11, 32, Bc7Lowest::none, false, false, 0, 0},
    {2, 2, 8, 8, Bc7Lowest::none, false, false, 0, 0},   {4, 2, 12, 4, Bc7Lowest::none, false, false, 0, 0},
    {7, 2, 12, 4, Bc7Lowest::none, false, false, 0, 0},  {3, 3, 7, 4, Bc7Lowest::none, false, false, 0, 0},
};

}  // namespace tex::inline v1
