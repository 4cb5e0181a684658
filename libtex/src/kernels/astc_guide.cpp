// SPDX-License-Identifier: Apache-2.0

#include "kernels/astc_guide.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blocks/astc_ise.h"

namespace tex::inline v1 {
namespace {

// What measured errors of rounded weights are of those of a uniform distribution between evenly spaced levels, by
// range: the median over the real maps.
constexpr float kMeasuredNoise[kAstcWeightRanges] = {0.26f, 0.455f, 0.555f, 0.61f, 0.65f, 0.65f,
                                                     0.69f, 0.69f,  0.7f,   0.7f,  0.7f,  0.7f};
constexpr float kMeasuredEnds = 0.6f;

AstcGuide::Choice choice_of(const AstcPlans& plans, int number) {
    const AstcPlan& plan = plans.plans[static_cast<std::size_t>(number)];
    const auto texels = static_cast<float>(plans.block.width * plans.block.height);
    const auto steps = static_cast<float>(kAstcRangeTable[plan.mode.range].levels - 1);
    float kept = 0;  // of the noise of the grid's weights, by interpolation
    for (int k = 0; k < plan.grid->texels; ++k) {
        for (const float share : plan.grid->infill[k]) kept += share * share / 256.0f;
    }
    const float step = 255.0f / static_cast<float>(kAstcRangeTable[plan.color_range].levels - 1);
    const auto ends = [&](float s) {
        return static_cast<float>(plan.channels) * texels * kMeasuredEnds * s * s / 12.0f;
    };
    return {number,
            plan.mode.planes,
            kMeasuredNoise[plan.mode.range] * kept / (12.0f * steps * steps),
            ends(step),
            ends(plan.channels == 2 ? std::max(1.0f, 0.5f * step) : step),
            plan.mode.range < kAstcCoarseLevels ? plan.mode.range : -1,
            plan.grid->is_full && plan.mode.planes == 2 && step < 1.5f ? steps + 1 : 0};
}

// Guesses of choices of one grid differ by noise alone. Leaves out those that are the best for no range.
void keep_best(std::vector<AstcGuide::Choice>& choices) {
    constexpr float kMostRange = 255.0f * 255.0f, kNarrowRange = kAstcNarrow * kAstcNarrow, kStep = 1.05f;
    std::vector<bool> is_best(choices.size());
    for (const bool is_narrow : {false, true}) {
        for (int planes = 1; planes <= 2; ++planes) {
            const auto most = static_cast<float>(planes) * (is_narrow ? kNarrowRange : kMostRange);
            for (float range = 0.1f; range < most; range *= kStep) {
                const auto noise = [&](const AstcGuide::Choice& choice) {
                    if (choice.planes != planes) return std::numeric_limits<float>::max();
                    return choice.weights * range + (is_narrow ? choice.offsets : choice.ends);
                };
                const auto best = std::min_element(choices.begin(), choices.end(),
                                                   [&](const auto& a, const auto& b) { return noise(a) < noise(b); });
                if (best != choices.end()) is_best[static_cast<std::size_t>(best - choices.begin())] = true;
            }
        }
    }
    std::size_t kept = 0;
    for (std::size_t k = 0; k < choices.size(); ++k) {
        if (is_best[k] || choices[k].levels > 0) choices[kept++] = choices[k];
    }
    choices.erase(choices.begin() + static_cast<std::ptrdiff_t>(kept), choices.end());
}

// Gram and Schmidt's method in double precision, of sums of weights and their mirror images, then of differences.
void make_basis(int texels, int weights, float basis[8][8]) {
    double made[8][8] = {};
    const int even = (weights + 1) / 2;
    for (int w = 0; w < weights; ++w) {
        double* const row = made[w];
        const int first = w < even ? w : w - even;
        for (int i = 0; i < texels; ++i) {
            const AstcInfill infill = astc_infill(i, texels, weights);
            const double share = infill.first == first ? 16 - infill.part : infill.first + 1 == first ? infill.part : 0;
            row[i] += share;
            row[texels - 1 - i] += w < even ? share : -share;
        }
        for (int other = 0; other < w; ++other) {
            double product = 0;
            for (int i = 0; i < texels; ++i) product += row[i] * made[other][i];
            for (int i = 0; i < texels; ++i) row[i] -= product * made[other][i];
        }
        double square = 0;
        for (int i = 0; i < texels; ++i) square += row[i] * row[i];
        for (int i = 0; i < texels; ++i) {
            row[i] /= std::sqrt(square);
            basis[w][i] = static_cast<float>(row[i]);
        }
    }
}

void make_pairs(int texels, int weights, const float basis[8][8], float* pairs) {
    const int even = (weights + 1) / 2, middle = (texels + 1) / 2;
    for (int j = 0; j < texels; ++j) {
        for (int k = j < middle ? 0 : middle; k <= j; ++k, ++pairs) {
            for (int w = j < middle ? 0 : even; w < (j < middle ? even : weights); ++w)
                *pairs += basis[w][j] * basis[w][k];
        }
    }
}

}  // namespace

AstcGuide make_astc_guide(const AstcPlans& plans, const AstcReach& reach) {
    AstcGuide guide{};
    guide.plans = &plans;
    guide.measures_coarse = reach.measures_coarse;
    for (int number = 0; number < static_cast<int>(plans.plans.size()); ++number) {
        const AstcGuide::Choice choice = choice_of(plans, number);
        const AstcPlan& plan = plans.plans[static_cast<std::size_t>(number)];
        const AstcMode& mode = plan.mode;
        if (plan.is_mixed || (plan.partitions > 1 && mode.planes == 2 && !reach.part_planes)) continue;
        auto& grids = plan.partitions == 1 ? guide.grids : guide.of_parts[plan.partitions - 2];
        auto grid = std::find_if(grids.begin(), grids.end(),
                                 [&](const AstcGuide::Grid& made) { return made.extent == mode.grid; });
        if (grid == grids.end()) {
            const auto wider = std::find_if(grids.begin(), grids.end(), [&](const AstcGuide::Grid& made) {
                return made.extent.width > mode.grid.width;
            });
            grid = grids.insert(wider, {mode.grid, {}, false});
        }
        grid->choices.push_back(choice);
        grid->has_planes = grid->has_planes || mode.planes == 2;
    }
    if (reach.best_alone) {
        for (AstcGuide::Grid& grid : guide.grids) keep_best(grid.choices);
    }
    for (int p = 0; p < 2; ++p) {
        for (std::size_t k = 0; k < plans.patterns[p].size(); k += static_cast<std::size_t>(reach.pattern_steps))
            guide.patterns[p].push_back(plans.patterns[p][k]);
    }
    for (int weights = 2; weights <= plans.block.width; ++weights)
        make_basis(plans.block.width, weights, guide.basis[0][weights]);
    for (int weights = 2; weights <= plans.block.height; ++weights) {
        make_basis(plans.block.height, weights, guide.basis[1][weights]);
        make_pairs(plans.block.height, weights, guide.basis[1][weights], guide.pairs[weights]);
    }
    return guide;
}

}  // namespace tex::inline v1
