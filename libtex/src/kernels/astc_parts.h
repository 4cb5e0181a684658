// SPDX-License-Identifier: Apache-2.0
// astc_parts.h: guesses which patterns of partitions suit blocks, and which plans suit these, many blocks side by side.
//
// Patterns are ranked by the energy across the lines of their partitions. Then texels are measured from the middles of
// their partitions, and plans are guessed as in astc_guess.h, from what a grid cannot express of that and from the
// noise of rounded weights and endpoints; the noise of few levels is that of the texels themselves.

#pragma once

#include "kernels/astc_guess.h"

namespace tex::inline v1 {

// Guesses plans with two or three partitions: for each of the `patterns` best patterns, the `plans` best plans; their
// product is at most kAstcMostGuesses. Sets `count`.
void guess_astc_patterns(const AstcGuide& guide, const AstcGroup& group, int partitions, int patterns, int plans,
                         AstcGuesses& guesses);

}  // namespace tex::inline v1
