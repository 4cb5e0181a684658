// SPDX-License-Identifier: Apache-2.0
// bc7_fit.h: what bc7_planes.h and bc7_lines.h fit: blocks or subsets side by side, one in each lane.
//
// The error of a texel is the squared chord between the normal and the decoded vector after both are normalised. So the
// length of the decoded vector is free. Where alpha holds data, its squared error counts as much as that of a component
// of a unit vector: 4 times the squared difference of values from 0 to 1.

#pragma once

#include "kernels/bc7_kinds.h"

namespace tex::inline v1 {

// More than any error.
inline constexpr float kBc7None = 1e30f;

// The most lanes of a vector.
inline constexpr int kBc7Lanes = 16;

// Texels of as many blocks or subsets as a vector has lanes.
struct Bc7Group {
    int texels;  // of the lane that has most
    bool has_alpha;
    alignas(64) float value[16][4][kBc7Lanes];  // x, y, z of unit vectors, alpha as a code of 255
    alignas(64) float weight[16][kBc7Lanes];    // 0 or 1; only lines read it
    alignas(64) float ends[2][4][kBc7Lanes];    // codes as they are stored, with their lowest bits
    alignas(64) float error[kBc7Lanes];
    alignas(64) float color[16][kBc7Lanes], scalar[16][kBc7Lanes];  // indices
};

// How a group is fitted.
struct Bc7Steps {
    bool starts;     // finds endpoints, else improves those that are there
    int rounds;      // of moving each endpoint by a step
    bool pairs;      // also moves both endpoints of a channel, and changes lowest bits
    bool indices;    // also stores indices
    int solves = 0;  // of two planes: least squares for the best pairs of indices, if the rules say so
};

// A round whose moves are single steps in all formats.
inline constexpr int kBc7LateRound = 4;

// Moves of the two endpoints of a channel, in steps; the first four are those of one endpoint.
inline constexpr int kBc7Moves = 8;
inline constexpr float kBc7MoveTable[kBc7Moves][2] = {{-1, 0}, {1, 0},   {0, -1}, {0, 1},
                                                      {1, 1},  {-1, -1}, {1, -1}, {-1, 1}};

}  // namespace tex::inline v1
