// SPDX-License-Identifier: Apache-2.0
// uastc_hints.h: hints for transcoders that make blocks of ETC1 and BC1 from blocks of UASTC.
//
// A transcoder makes the base colour of each half of a block from the mean of its texels, adds a bias to it, takes the
// table of modifiers that the hint names, and gives each texel the modifier that comes nearest in luminance. So what a
// hint makes is known beforehand: here, its error of direction. Blocks of BC1 get endpoints and weights of the first
// plane as they are, or endpoints that are fitted to these weights, or a fit of their own (Basis Universal).

#pragma once

#include <tex/pack.h>

#include "kernels/bc7_fit.h"

namespace tex::inline v1 {

// Blocks side by side, one in each lane.
struct UastcHintGroup {
    alignas(64) float value[16][3][kBc7Lanes];  // unit vectors
    alignas(64) float code[16][3][kBc7Lanes];   // of the decoded block, 0 to 255
    // Whether the block has one subset; then its endpoints, and its weights in the first plane as steps of four.
    alignas(64) float is_one[kBc7Lanes], end[2][3][kBc7Lanes], step[16][kBc7Lanes];
    alignas(64) float bc1[kBc7Lanes];          // 2: endpoints and weights as they are; 1: these weights; 0: neither
    alignas(64) float bc1_cosines[kBc7Lanes];  // the sum over the texels, with this one
    alignas(64) float flip[kBc7Lanes], diff[kBc7Lanes], table[2][kBc7Lanes], bias[kBc7Lanes];
};

// Finds the hints with the least error: fast, of those without a bias; normal, with all biases for the best of these;
// best, of all.
void find_etc1_hints(Effort effort, UastcHintGroup& group);
void find_bc1_hints(UastcHintGroup& group);

}  // namespace tex::inline v1
