// SPDX-License-Identifier: Apache-2.0
// uastc_xy_fit.h: guesses and fits blocks of UASTC that hold x as luminance and y as alpha, side by side.
//
// A texel's normal is (x, y, sqrt(1 - x^2 - y^2)), so that a block is a choice among directions: the error is the
// squared chord between unit vectors, as for UASTC of three components (uastc_fit.h).

#pragma once

#include "kernels/bc7_fit.h"

namespace tex::inline v1 {

// In this order; UastcXyBatch depends on it. (The modes of RGBA have what these have, with coarser endpoints.)
enum UastcXyKindNumber {
    kUastcXyPlanes = 0,  // x and y each on its own: a grid of 4x4
    kUastcXyLine = 1,    // 16 steps between two points
    kUastcXyParts = 2,   // two subsets, each with 4 steps
    kUastcXyKinds = 3,
};

// Instead of bits, ranges of endpoints are named, of kAstcRangeTable.
inline constexpr Bc7Kind kUastcXyKindTable[kUastcXyKinds] = {
    {17, 1, 20, 4, Bc7Lowest::none, false, false, 20, 4},
    {15, 1, 20, 16, Bc7Lowest::none, false, false, 0, 0},
    {16, 2, 20, 4, Bc7Lowest::none, false, false, 0, 0},
};

inline constexpr int kUastcXyMostParts = 8;
struct UastcXyGuesses {
    alignas(64) float part[kUastcXyMostParts][kBc7Lanes];  // the likeliest patterns of two subsets, or -1
    alignas(64) float part_error[kUastcXyMostParts][kBc7Lanes];
};
void guess_uastc_xy(const Bc7Group& group, int parts, UastcXyGuesses& guesses);

// In Bc7Group, x has the colour indices; y has them, too, or the scalar ones of a second plane.
void fit_uastc_xy(const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group);

}  // namespace tex::inline v1
