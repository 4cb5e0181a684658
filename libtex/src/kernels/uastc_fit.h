// SPDX-License-Identifier: Apache-2.0
// uastc_fit.h: guesses and fits blocks of UASTC side by side, as bc7_guess.h, bc7_planes.h and bc7_lines.h do for BC7.

#pragma once

#include "kernels/bc7_fit.h"

namespace tex::inline v1 {

inline constexpr int kUastcMostParts = 32;
struct UastcGuesses {
    // Two planes, by which of the other two components is in the second one.
    alignas(64) float error[2][kBc7Lanes];
    alignas(64) float ends[2][2][kBc7Lanes];  // of either component
    alignas(64) float axis[kBc7Lanes];        // the greatest component of the mean
    alignas(64) float line[3][kBc7Lanes];     // the kinds of one line
    // The likeliest kinds times 64 plus pattern, and their guessed errors.
    alignas(64) float part[kUastcMostParts][kBc7Lanes], part_error[kUastcMostParts][kBc7Lanes];
};
struct UastcSearch {
    int parts;      // patterns that are kept
    unsigned most;  // of so many of each kind
    bool three;     // also of three subsets
    int rounds;     // of moving the endpoints of a plane
};
void guess_uastc(const Bc7Group& group, const UastcSearch& search, UastcGuesses& guesses);

// `kind` is one of kUastcKindTable. In mode 6, the second plane has the component 0 of `value`.
void fit_uastc_planes(const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group);
void fit_uastc_lines(const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group);

}  // namespace tex::inline v1
