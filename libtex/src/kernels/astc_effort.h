// SPDX-License-Identifier: Apache-2.0
// astc_effort.h: how much the efforts of the encoder of ASTC guess, fit and improve.

#pragma once

#include <tex/format.h>
#include <tex/pack.h>

#include "kernels/astc_fit.h"
#include "kernels/astc_guide.h"

namespace tex::inline v1 {

// More than any error.
inline constexpr float kAstcNone = 1e30f;

// What an effort spends.
struct AstcEffort {
    int guesses = 1;           // plans of one partition that a block is fitted to
    float likely = kAstcNone;  // unless their guesses are above this times the best guess
    AstcSteps steps;
    int patterns[2] = {};    // of two, of three partitions
    int part_plans[2] = {};  // for each of them
    float worth = 0;         // the squared error of a texel from which several partitions are tried
    bool both_ends = false;  // of narrow partitions, also tries endpoints without offsets
    int polished = 0;        // the best of all of these are fitted again, with
    AstcSteps polish;
    AstcReach reach;

    // The most candidates that a block has.
    [[nodiscard]] int most_candidates() const {
        const int parts = patterns[0] * part_plans[0] + patterns[1] * part_plans[1];
        return (guesses + parts) * (both_ends ? 2 : 1);
    }
};
[[nodiscard]] AstcEffort astc_effort(Format format, Effort effort);

}  // namespace tex::inline v1
