// SPDX-License-Identifier: Apache-2.0

#include "kernels/astc_effort.h"

namespace tex::inline v1 {

AstcEffort astc_effort(Format format, Effort effort) {
    const bool is_small = format == Format::astc_4x4_unorm;
    AstcEffort spends;
    if (effort == Effort::fast) {
        spends.steps = {.insets = 0, .iterations = is_small ? 1 : 2};
        spends.reach.best_alone = true;
    } else if (effort == Effort::normal) {
        spends.guesses = 2;
        spends.likely = 1.5f;
        // Many weights make up for endpoints that are not the best to begin with.
        spends.steps = {.insets = is_small ? 3 : 2, .iterations = 3, .near_ends = true};
        spends.patterns[0] = 1;
        spends.part_plans[0] = 3;
        spends.worth = 3.0f;
        spends.reach.pattern_steps = is_small ? 2 : 4;
    } else {
        spends.guesses = 32;
        spends.steps = {.insets = 2, .iterations = 2, .sweeps = 2, .near_ends = true};
        for (int p = 0; p < 2; ++p) {
            spends.patterns[p] = p == 0 ? 5 : 4;
            spends.part_plans[p] = p == 0 ? 12 : 4;
        }
        spends.both_ends = true;
        spends.polished = 6;
        spends.polish = {.insets = 3, .starts = 2, .iterations = 3, .sweeps = 3, .near_ends = true, .polishes = 3};
        spends.reach.measures_coarse = spends.reach.part_planes = true;
    }
    return spends;
}

}  // namespace tex::inline v1
