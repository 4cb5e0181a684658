// SPDX-License-Identifier: Apache-2.0
// astc_guess.h: guesses the errors of blocks in the plans of ASTC, many blocks side by side, before anything is fitted.
//
// The error of a plan is guessed as what its grid cannot express (the energy outside the space that the grid spans),
// and noise from rounding weights and endpoints: in proportion to the squared range of the texels over the squared
// number of levels. Of two partitions, the grid is taken to be full.

#pragma once

#include <vector>

#include "kernels/astc_fit.h"

namespace tex {

// Plans that blocks of a size may use, in an order that the guesses need.
struct AstcGuide {
    struct Choice {
        int plan;  // of AstcPlans
        int planes;
        float weights;  // times the squared range of the texels: the noise of rounded weights
        float ends;     // the noise of rounded endpoints
        float levels;   // of weights, if they are few, each texel has its own and each channel, too; otherwise 0
    };
    struct Grid {
        Extent extent;
        int planes;  // of grids for two partitions
        std::vector<Choice> choices;
    };
    const AstcPlans* plans = nullptr;
    std::vector<Grid> grids;   // with one partition, by width
    std::vector<Grid> of_two;  // with two partitions
    std::vector<AstcPattern> patterns;
    // Orthonormal bases of what so many weights can express along an axis: by texels (of width, of height), weights.
    float basis[2][9][8][8];
};

// How much of it an effort uses.
struct AstcReach {
    int most_weights = 64;  // along an axis, of grids with one partition that are not full
    int pair_grids = 0;     // grids for two partitions
    int pattern_steps = 1;  // of so many patterns, one
};
[[nodiscard]] AstcGuide make_astc_guide(const AstcPlans& plans, const AstcReach& reach);

inline constexpr int kAstcMostGuesses = 64;

// Guesses of each block: errors, numbers of plans, and numbers of patterns in the guide.
struct AstcGuesses {
    int count = 0;  // at most kAstcMostGuesses; set by the caller
    alignas(64) float error[kAstcMostGuesses * kAstcLanes];
    alignas(64) float plan[kAstcMostGuesses * kAstcLanes];
    alignas(64) float pattern[kAstcMostGuesses * kAstcLanes];
    alignas(64) float range[kAstcLanes];  // of both channels, the sum of the squares; guess_astc() sets it
};

// Of plans with one partition: the `count` best, from the best.
void guess_astc(const AstcGuide& guide, const AstcGroup& group, AstcGuesses& guesses);

// Of plans with two partitions: for each of the `patterns` best patterns and each grid, the best plan. Sets `count`.
// What the grid cannot express is left out, so the guess is a low one.
void guess_astc_patterns(const AstcGuide& guide, const AstcGroup& group, int patterns, AstcGuesses& guesses);

}  // namespace tex
