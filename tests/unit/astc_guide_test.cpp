// SPDX-License-Identifier: Apache-2.0
// What guesses about ASTC rest on: orthonormal bases of what grids can express, every plan once, and guesses that are
// near the errors of fits.

#include "kernels/astc_guide.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "kernels/astc_guess.h"
#include "kernels/astc_parts.h"

namespace tex {
namespace {

constexpr AstcReach kAll{.part_planes = true};

TEST(AstcGuide, BasesAreOrthonormalAndSpanTheInfill) {
    const AstcGuide guide = make_astc_guide(astc_plans({8, 5}), kAll);
    for (int axis = 0; axis < 2; ++axis) {
        const int texels = axis == 0 ? 8 : 5;
        for (int weights = 2; weights <= texels; ++weights) {
            const auto& basis = guide.basis[axis][weights];
            for (int a = 0; a < weights; ++a) {
                for (int b = 0; b < weights; ++b) {
                    double product = 0;
                    for (int i = 0; i < texels; ++i) product += static_cast<double>(basis[a][i]) * basis[b][i];
                    EXPECT_NEAR(product, a == b ? 1.0 : 0.0, 1e-5);
                }
            }
            // A ramp of weights gives a ramp of texels, rounded to sixteenths: it has no part outside the space.
            double ramp[8], inside = 0, all = 0;
            for (int i = 0; i < texels; ++i) {
                const AstcInfill infill = astc_infill(i, texels, weights);
                ramp[i] = infill.first + infill.part / 16.0;
                all += ramp[i] * ramp[i];
            }
            for (int a = 0; a < weights; ++a) {
                double product = 0;
                for (int i = 0; i < texels; ++i) product += static_cast<double>(basis[a][i]) * ramp[i];
                inside += product * product;
            }
            EXPECT_NEAR(inside, all, 1e-4 * all);
        }
    }
}

TEST(AstcGuide, HasEveryPlanOfOnePartitionOnce) {
    const AstcPlans& plans = astc_plans({6, 6});
    const AstcGuide guide = make_astc_guide(plans, kAll);
    std::set<int> seen;
    for (const AstcGuide::Grid& grid : guide.grids) {
        for (const AstcGuide::Choice& choice : grid.choices) {
            EXPECT_TRUE(seen.insert(choice.plan).second);
            EXPECT_EQ(plans.plans[static_cast<std::size_t>(choice.plan)].mode.grid, grid.extent);
        }
    }
    EXPECT_EQ(seen.size(),
              static_cast<std::size_t>(std::count_if(plans.plans.begin(), plans.plans.end(),
                                                     [](const AstcPlan& plan) { return plan.partitions == 1; })));
    for (int p = 0; p < 2; ++p) {
        EXPECT_FALSE(guide.of_parts[p].empty());
        EXPECT_EQ(guide.patterns[p].size(), plans.patterns[p].size());
    }
}

// A block of a sine: guesses of the best plans are within a factor of what fits reach.
TEST(AstcGuide, GuessesAreNearTheErrorsOfFits) {
    const Extent block{6, 6};
    const AstcPlans& plans = astc_plans(block);
    const AstcGuide guide = make_astc_guide(plans, kAll);
    const int lanes = astc_lanes();
    alignas(64) static float value[2][kAstcMostPlanned * kAstcLanes];
    for (int k = 0; k < 36 * lanes; ++k) {
        const int l = k % lanes, i = k / lanes % 6, j = k / lanes / 6;
        value[0][k] = static_cast<float>(128 + 60 * std::sin(0.5 * i + 0.1 * l) + 9 * std::sin(2.1 * j));
        value[1][k] = static_cast<float>(120 + 50 * std::cos(0.6 * j + 0.2 * l) + 11 * std::sin(1.9 * i * j));
    }
    alignas(64) static float no_offsets[kAstcLanes];
    const AstcGroup group{{value[0], value[1]}, nullptr, no_offsets, nullptr};
    static AstcGuesses guesses;
    static AstcFits fits;
    guesses.count = 8;
    guess_astc(guide, group, guesses);
    for (int l = 0; l < lanes; ++l) {
        for (int q = 0; q < guesses.count; ++q) {
            const int at = q * lanes + l;
            fit_astc(plans.plans[static_cast<std::size_t>(guesses.plan[at])], {3, 1, 2, 2, true, 1}, group, fits);
            EXPECT_GT(fits.error[l], 0.4f * guesses.error[at]);
            EXPECT_LT(fits.error[l], 2.5f * guesses.error[at]);
            EXPECT_GE(guesses.error[at], guesses.error[std::max(at - lanes, l)]);
        }
    }
}

// Noise of many amplitudes: the guides agree on the best plan.
TEST(AstcGuide, PlansThatAreLeftOutAreNeverTheBestGuess) {
    const AstcPlans& plans = astc_plans({5, 5});
    const AstcGuide all = make_astc_guide(plans, {}), best = make_astc_guide(plans, {.best_alone = true});
    const int lanes = astc_lanes();
    std::mt19937 random(2);
    alignas(64) static float value[2][kAstcMostPlanned * kAstcLanes];
    std::size_t choices[2] = {};
    for (const AstcGuide::Grid& grid : all.grids) choices[0] += grid.choices.size();
    for (const AstcGuide::Grid& grid : best.grids) choices[1] += grid.choices.size();
    EXPECT_LT(2 * choices[1], choices[0]);
    static AstcGuesses guesses[2];
    for (int amplitude = 1; amplitude < 250; amplitude += 2) {
        for (int k = 0; k < 25 * lanes; ++k) {
            for (auto& channel : value)
                channel[k] = static_cast<float>(random() % 1000) * 0.001f * static_cast<float>(amplitude);
        }
        guesses[0].count = 2;  // in order
        guesses[1].count = 1;
        guess_astc(all, {{value[0], value[1]}, nullptr, nullptr, nullptr}, guesses[0]);
        guess_astc(best, {{value[0], value[1]}, nullptr, nullptr, nullptr}, guesses[1]);
        for (int l = 0; l < lanes; ++l) EXPECT_LE(guesses[1].error[l], 1.001f * guesses[0].error[l]);
    }
}

// Two halves, each with a ramp of its own: the pattern divides them, and fits come near the guesses.
TEST(AstcGuide, FindsThePatternOfTwoHalves) {
    const AstcPlans& plans = astc_plans({6, 6});
    const AstcGuide guide = make_astc_guide(plans, kAll);
    const int lanes = astc_lanes();
    alignas(64) static float value[2][kAstcMostPlanned * kAstcLanes], part[kAstcMostPlanned * kAstcLanes];
    alignas(64) static float offset[2 * kAstcLanes], turn[2 * kAstcLanes];
    for (int k = 0; k < 36 * lanes; ++k) {
        const int i = k / lanes % 6, j = k / lanes / 6;
        value[0][k] = static_cast<float>(i < 3 ? 40 + 3 * j : 200 - 4 * j);
        value[1][k] = static_cast<float>(i < 3 ? 90 + 2 * j : 30 + 5 * j);
    }
    const AstcGroup group{{value[0], value[1]}, part, offset, turn};
    static AstcGuesses guesses;
    static AstcFits fits;
    guess_astc_patterns(guide, group, 2, 1, 1, guesses);
    ASSERT_EQ(guesses.count, 1);
    const AstcPattern& pattern = guide.patterns[0][static_cast<std::size_t>(guesses.pattern[0])];
    for (int k = 0; k < 36; ++k)
        EXPECT_EQ(pattern.later[0] >> k & 1, (pattern.later[0] & 1) ^ (k % 6 < 3 ? 0u : 1u)) << k;
    EXPECT_EQ(static_cast<int>(guesses.bits[0]) & 3, 3);  // both are narrow
    for (int k = 0; k < 36 * lanes; ++k) part[k] = static_cast<float>(pattern.later[0] >> (k / lanes) & 1);
    for (int l = 0; l < lanes; ++l) {
        for (int p = 0; p < 2; ++p) {
            offset[p * lanes + l] = 1.0f;
            turn[p * lanes + l] = static_cast<float>(static_cast<int>(guesses.bits[l]) >> (4 + p) & 1);
        }
    }
    fit_astc(plans.plans[static_cast<std::size_t>(guesses.plan[0])], {3, 1, 2, 2, true, 1}, group, fits);
    EXPECT_LT(fits.error[0], 2.0f * guesses.error[0] + 4.0f);
}

}  // namespace
}  // namespace tex
