// SPDX-License-Identifier: Apache-2.0
// bc7_guess.h: what blocks of BC7 would lose in each mode, before they are fitted.

#pragma once

#include "kernels/bc7_fit.h"

namespace tex::inline v1 {

inline constexpr int kBc7MostParts = 32;
struct Bc7Guesses {
    // Two planes, by kind, and by which of the other two components is in the scalar plane.
    alignas(64) float error[3][2][kBc7Lanes];
    alignas(64) float ends[3][2][2][2][kBc7Lanes];  // of the scalar plane, of the colours
    alignas(64) float axis[kBc7Lanes];              // the greatest component of the mean
    alignas(64) float line[kBc7Lanes];              // one line
    // The likeliest kinds times 64 plus partition, and their guessed errors.
    alignas(64) float part[kBc7MostParts][kBc7Lanes], part_error[kBc7MostParts][kBc7Lanes];
    // Alpha in a plane of its own, with the levels of a kind.
    alignas(64) float alpha_error[3][kBc7Lanes], alpha_ends[3][2][kBc7Lanes];
};
struct Bc7Search {
    int parts;            // partitions that are kept
    unsigned partitions;  // of so many of each number of subsets
    bool three;           // also of three subsets
    int rounds;           // of moving the endpoints of a plane
};
void guess_bc7(const Bc7Group& group, const Bc7Search& search, Bc7Guesses& guesses);

[[nodiscard]] int bc7_lanes();

}  // namespace tex::inline v1
