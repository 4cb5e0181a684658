// SPDX-License-Identifier: Apache-2.0
// astc_guess.h: guesses the errors of blocks in the plans of ASTC, many blocks side by side, before anything is fitted.
//
// The error of a plan is guessed as what its grid cannot express (the energy outside the space that the grid spans),
// and noise from rounding weights and endpoints: in proportion to the squared range of the texels over the squared
// number of levels.

#pragma once

#include <cstddef>

#include "kernels/astc_fit.h"
#include "kernels/astc_guide.h"

namespace tex::inline v1 {

inline constexpr int kAstcMostGuesses = 64;

// Guesses of each block: errors, numbers of plans, and numbers of patterns in the guide.
struct AstcGuesses {
    int count = 0;  // at most kAstcMostGuesses; set by the caller
    alignas(64) float error[kAstcMostGuesses * kAstcLanes];
    alignas(64) float plan[kAstcMostGuesses * kAstcLanes];
    alignas(64) float pattern[kAstcMostGuesses * kAstcLanes];
    // A bit for each partition that is narrow; 16 times as high, one if its line should be turned.
    alignas(64) float bits[kAstcMostGuesses * kAstcLanes];
    alignas(64) float range[kAstcLanes];   // of both channels, the sum of the squares; guess_astc() sets it
    alignas(64) float widest[kAstcLanes];  // the greater one of the channels' ranges; guess_astc() sets it
};

// Parts `count` pairs of x and y, limits them to [-1, 1], adds 1 and multiplies by `scale`.
void astc_planes(const float* xy, std::size_t count, float scale, float* x, float* y);

// Guesses the `count` best plans with one partition, from the best.
void guess_astc(const AstcGuide& guide, const AstcGroup& group, AstcGuesses& guesses);

}  // namespace tex::inline v1
