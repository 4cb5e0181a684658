// SPDX-License-Identifier: Apache-2.0

#include "kernels/astc_guess.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>

#include "blocks/astc_ise.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/astc_guess.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE FloatVec AstcNumber(float value) { return hn::Set(FloatTag(), value); }

// Inserts what is better into the guesses, which are sorted.
HWY_INLINE void AddGuess(FloatVec error, int plan, FloatVec pattern, AstcGuesses& guesses) {
    const FloatTag d;
    const std::size_t lanes = hn::Lanes(d);
    const std::size_t last = static_cast<std::size_t>(guesses.count - 1) * lanes;
    if (hn::AllFalse(d, hn::Lt(error, hn::Load(d, guesses.error + last)))) return;
    FloatVec number = AstcNumber(static_cast<float>(plan));
    for (std::size_t at = 0; at <= last; at += lanes) {
        const FloatVec e = hn::Load(d, guesses.error + at), n = hn::Load(d, guesses.plan + at),
                       p = hn::Load(d, guesses.pattern + at);
        const auto better = hn::Lt(error, e);
        hn::Store(hn::IfThenElse(better, error, e), d, guesses.error + at);
        hn::Store(hn::IfThenElse(better, number, n), d, guesses.plan + at);
        hn::Store(hn::IfThenElse(better, pattern, p), d, guesses.pattern + at);
        error = hn::IfThenElse(better, e, error);
        number = hn::IfThenElse(better, n, number);
        pattern = hn::IfThenElse(better, p, pattern);
    }
}

HWY_INLINE void ClearGuesses(AstcGuesses& guesses) {
    const std::size_t count = static_cast<std::size_t>(guesses.count) * hn::Lanes(FloatTag());
    for (std::size_t k = 0; k < count; ++k) {
        guesses.error[k] = 1e30f;
        guesses.plan[k] = guesses.pattern[k] = 0;
    }
}

// Two channels without their means, and what is known about them.
struct AstcShape {
    alignas(64) float v[2][kAstcMostPlanned * kAstcLanes];
    FloatVec xx, yy, xy;          // sums of products
    FloatVec cos, sin;            // the direction in which they differ most
    FloatVec across;              // the energy perpendicular to it
    FloatVec ranges, line_range;  // squared: of both channels together, along the direction
    FloatVec least[2], greatest[2];
};

void MeasureShape(const AstcGroup& group, int texels, AstcShape& shape) {
    const FloatTag d;
    const std::size_t lanes = hn::Lanes(d), end = static_cast<std::size_t>(texels) * lanes;
    const FloatVec over = AstcNumber(1.0f / static_cast<float>(texels));
    FloatVec ranges = hn::Zero(d);
    for (int c = 0; c < 2; ++c) {
        FloatVec sum = hn::Zero(d), least = AstcNumber(1e6f), greatest = AstcNumber(-1e6f);
        for (std::size_t k = 0; k < end; k += lanes) {
            const FloatVec v = hn::Load(d, group.value[c] + k);
            sum = hn::Add(sum, v);
            least = hn::Min(least, v);
            greatest = hn::Max(greatest, v);
        }
        const FloatVec mean = hn::Mul(sum, over), range = hn::Sub(greatest, least);
        ranges = hn::Add(ranges, hn::Mul(range, range));
        shape.least[c] = hn::Sub(least, mean);
        shape.greatest[c] = hn::Sub(greatest, mean);
        for (std::size_t k = 0; k < end; k += lanes)
            hn::Store(hn::Sub(hn::Load(d, group.value[c] + k), mean), d, shape.v[c] + k);
    }
    FloatVec xx = hn::Zero(d), yy = xx, xy = xx;
    for (std::size_t k = 0; k < end; k += lanes) {
        const FloatVec x = hn::Load(d, shape.v[0] + k), y = hn::Load(d, shape.v[1] + k);
        xx = hn::Add(xx, hn::Mul(x, x));
        xy = hn::Add(xy, hn::Mul(x, y));
        yy = hn::Add(yy, hn::Mul(y, y));
    }
    const FloatVec half = hn::Mul(hn::Sub(xx, yy), AstcNumber(0.5f));
    const FloatVec root = hn::Sqrt(hn::Add(hn::Mul(half, half), hn::Mul(xy, xy)));
    const auto wide = hn::Ge(half, hn::Zero(d));
    const FloatVec dx = hn::IfThenElse(wide, hn::Add(root, half), xy);
    const FloatVec dy = hn::IfThenElse(wide, xy, hn::Sub(root, half));
    const FloatVec square = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
    const auto is_line = hn::Gt(square, AstcNumber(1e-12f));
    const FloatVec scale = hn::Div(AstcNumber(1.0f), hn::Sqrt(hn::IfThenElse(is_line, square, AstcNumber(1.0f))));
    shape.cos = hn::IfThenElse(is_line, hn::Mul(dx, scale), AstcNumber(1.0f));
    shape.sin = hn::IfThenElseZero(is_line, hn::Mul(dy, scale));
    shape.across = hn::Max(hn::Sub(hn::Mul(hn::Add(xx, yy), AstcNumber(0.5f)), root), hn::Zero(d));
    FloatVec least = AstcNumber(1e6f), greatest = AstcNumber(-1e6f);
    for (std::size_t k = 0; k < end; k += lanes) {
        const FloatVec along =
            hn::Add(hn::Mul(hn::Load(d, shape.v[0] + k), shape.cos), hn::Mul(hn::Load(d, shape.v[1] + k), shape.sin));
        least = hn::Min(least, along);
        greatest = hn::Max(greatest, along);
    }
    const FloatVec range = hn::Sub(greatest, least);
    shape.line_range = hn::Mul(range, range);
    shape.ranges = ranges;
    shape.xx = xx;
    shape.xy = xy;
    shape.yy = yy;
}

// Replaces each row of texels by its coordinates in the space that so many weights span.
void ProjectRows(const AstcGuide& guide, int weights, const AstcShape& shape, float* rows) {
    const FloatTag d;
    const std::size_t lanes = hn::Lanes(d);
    const Extent block = guide.plans->block;
    for (int c = 0; c < 2; ++c) {
        for (int j = 0; j < block.height; ++j) {
            const float* const from = shape.v[c] + static_cast<std::size_t>(j * block.width) * lanes;
            for (int w = 0; w < weights; ++w) {
                FloatVec sum = hn::Zero(d);
                for (int i = 0; i < block.width; ++i) {
                    const FloatVec v = hn::Load(d, from + static_cast<std::size_t>(i) * lanes);
                    sum = hn::Add(sum, hn::Mul(AstcNumber(guide.basis[0][weights][w][i]), v));
                }
                hn::Store(sum, d, rows + static_cast<std::size_t>((c * 8 + j) * 8 + w) * lanes);
            }
        }
    }
}

// The sums of products in the space of a grid, of rows that are projected.
struct AstcEnergies {
    FloatVec xx, yy, xy;
};
HWY_INLINE AstcEnergies ProjectColumns(const AstcGuide& guide, Extent grid, const float* rows) {
    const FloatTag d;
    const std::size_t lanes = hn::Lanes(d);
    const int height = guide.plans->block.height;
    AstcEnergies e = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (int w = 0; w < grid.width; ++w) {
        for (int h = 0; h < grid.height; ++h) {
            FloatVec sum[2] = {hn::Zero(d), hn::Zero(d)};
            for (int j = 0; j < height; ++j) {
                const FloatVec share = AstcNumber(guide.basis[1][grid.height][h][j]);
                for (int c = 0; c < 2; ++c) {
                    const float* const from = rows + static_cast<std::size_t>((c * 8 + j) * 8 + w) * lanes;
                    sum[c] = hn::Add(sum[c], hn::Mul(share, hn::Load(d, from)));
                }
            }
            e.xx = hn::Add(e.xx, hn::Mul(sum[0], sum[0]));
            e.yy = hn::Add(e.yy, hn::Mul(sum[1], sum[1]));
            e.xy = hn::Add(e.xy, hn::Mul(sum[0], sum[1]));
        }
    }
    return e;
}

// What evenly spaced levels between the least and the greatest values leave of both channels. Some maps have been
// rounded to few values, of which the model of noise knows nothing.
HWY_INLINE FloatVec LevelsLeave(const AstcShape& shape, float levels, Extent block) {
    const FloatTag d;
    const std::size_t end = static_cast<std::size_t>(block.width * block.height) * hn::Lanes(d);
    FloatVec left = hn::Zero(d);
    for (int c = 0; c < 2; ++c) {
        const FloatVec range = hn::Sub(shape.greatest[c], shape.least[c]);
        const FloatVec step = hn::Mul(hn::Max(range, AstcNumber(1e-3f)), AstcNumber(1.0f / (levels - 1.0f)));
        const FloatVec over = hn::Div(AstcNumber(1.0f), step);
        for (std::size_t k = 0; k < end; k += hn::Lanes(d)) {
            const FloatVec place = hn::Mul(hn::Sub(hn::Load(d, shape.v[c] + k), shape.least[c]), over);
            const FloatVec off = hn::Sub(place, hn::Floor(hn::Add(place, AstcNumber(0.5f))));
            left = hn::Add(left, hn::Mul(hn::Mul(off, off), hn::Mul(step, step)));
        }
    }
    return left;
}

void GuessAstc(const AstcGuide& guide, const AstcGroup& group, AstcGuesses& guesses) {
    const FloatTag d;
    AstcShape shape;
    const Extent block = guide.plans->block;
    MeasureShape(group, block.width * block.height, shape);
    ClearGuesses(guesses);
    hn::Store(shape.ranges, d, guesses.range);
    alignas(64) float rows[2 * 64 * kAstcLanes];
    int width = 0;
    for (const AstcGuide::Grid& grid : guide.grids) {
        // All energies inside the space of the grid; the rest is error.
        AstcEnergies in = {shape.xx, shape.yy, shape.xy};
        if (grid.extent != block) {
            if (grid.extent.width != width) ProjectRows(guide, grid.extent.width, shape, rows);
            width = grid.extent.width;
            in = ProjectColumns(guide, grid.extent, rows);
        }
        const FloatVec out_x = hn::Sub(shape.xx, in.xx), out_y = hn::Sub(shape.yy, in.yy);
        const FloatVec out_xy = hn::Sub(shape.xy, in.xy);
        const FloatVec two = hn::Max(hn::Add(out_x, out_y), hn::Zero(d));
        const FloatVec cross = hn::Mul(hn::Mul(shape.cos, shape.sin), hn::Add(out_xy, out_xy));
        const FloatVec along = hn::Add(
            hn::Add(hn::Mul(hn::Mul(shape.cos, shape.cos), out_x), hn::Mul(hn::Mul(shape.sin, shape.sin), out_y)),
            cross);
        const FloatVec one = hn::Add(hn::Max(along, hn::Zero(d)), shape.across);
        for (const AstcGuide::Choice& choice : grid.choices) {
            const FloatVec range = choice.planes == 2 ? shape.ranges : shape.line_range;
            FloatVec noise = hn::Add(hn::Mul(AstcNumber(choice.weights), range), AstcNumber(choice.ends));
            if (choice.levels > 0) noise = hn::Min(noise, LevelsLeave(shape, choice.levels, block));
            AddGuess(hn::Add(choice.planes == 2 ? two : one, noise), choice.plan, hn::Zero(d), guesses);
        }
    }
}

// Of a partition: the energy along the direction in which it differs most, and across.
struct AstcAxes {
    FloatVec along, across;
};
HWY_INLINE AstcAxes AxesOf(float count, FloatVec x, FloatVec y, FloatVec xx, FloatVec xy, FloatVec yy) {
    const FloatTag d;
    const FloatVec over = AstcNumber(1.0f / count), two = AstcNumber(0.5f);
    const FloatVec a = hn::Sub(xx, hn::Mul(hn::Mul(x, x), over)), b = hn::Sub(xy, hn::Mul(hn::Mul(x, y), over));
    const FloatVec c = hn::Sub(yy, hn::Mul(hn::Mul(y, y), over));
    const FloatVec half = hn::Mul(hn::Sub(a, c), two), middle = hn::Mul(hn::Add(a, c), two);
    const FloatVec root = hn::Sqrt(hn::Add(hn::Mul(half, half), hn::Mul(b, b)));
    return {hn::Add(middle, root), hn::Max(hn::Sub(middle, root), hn::Zero(d))};
}

// Patterns are ranked with the noise of 4 or 5 levels.
inline constexpr float kAstcRankNoise = 0.05f;

void GuessAstcPatterns(const AstcGuide& guide, const AstcGroup& group, int patterns, AstcGuesses& guesses) {
    const FloatTag d;
    const std::size_t lanes = hn::Lanes(d);
    const Extent block = guide.plans->block;
    const int texels = block.width * block.height;
    AstcShape shape;
    MeasureShape(group, texels, shape);
    alignas(64) float product[3][kAstcMostPlanned * kAstcLanes];
    for (std::size_t k = 0; k < static_cast<std::size_t>(texels) * lanes; k += lanes) {
        const FloatVec x = hn::Load(d, shape.v[0] + k), y = hn::Load(d, shape.v[1] + k);
        hn::Store(hn::Mul(x, x), d, product[0] + k);
        hn::Store(hn::Mul(x, y), d, product[1] + k);
        hn::Store(hn::Mul(y, y), d, product[2] + k);
    }
    AstcGuesses best;  // of patterns: `plan` holds the energy along the lines
    best.count = patterns;
    ClearGuesses(best);
    for (std::size_t n = 0; n < guide.patterns.size(); ++n) {
        FloatVec x = hn::Zero(d), y = x, xx = x, xy = x, yy = x;
        int count = 0;
        for (int k = 0; k < texels; ++k) {
            if ((guide.patterns[n].second >> k & 1) == 0) continue;
            const std::size_t at = static_cast<std::size_t>(k) * lanes;
            ++count;
            x = hn::Add(x, hn::Load(d, shape.v[0] + at));
            y = hn::Add(y, hn::Load(d, shape.v[1] + at));
            xx = hn::Add(xx, hn::Load(d, product[0] + at));
            xy = hn::Add(xy, hn::Load(d, product[1] + at));
            yy = hn::Add(yy, hn::Load(d, product[2] + at));
        }
        const AstcAxes second = AxesOf(static_cast<float>(count), x, y, xx, xy, yy);
        const AstcAxes first = AxesOf(static_cast<float>(texels - count), x, y, hn::Sub(shape.xx, xx),
                                      hn::Sub(shape.xy, xy), hn::Sub(shape.yy, yy));
        const FloatVec along = hn::Add(first.along, second.along), across = hn::Add(first.across, second.across);
        const FloatVec rank = hn::Add(across, hn::Mul(along, AstcNumber(kAstcRankNoise)));
        AddGuess(rank, static_cast<int>(n), along, best);
    }
    const int grids = static_cast<int>(guide.of_two.size());
    guesses.count = patterns * grids;
    ClearGuesses(guesses);
    for (int q = 0; q < patterns; ++q) {
        const std::size_t at = static_cast<std::size_t>(q) * lanes;
        const FloatVec along = hn::Load(d, best.pattern + at);
        const FloatVec across = hn::Sub(hn::Load(d, best.error + at), hn::Mul(along, AstcNumber(kAstcRankNoise)));
        for (int g = 0; g < grids; ++g) {
            const AstcGuide::Grid& grid = guide.of_two[static_cast<std::size_t>(g)];
            const bool two = grid.planes == 2;
            FloatVec least = AstcNumber(1e30f), plan = hn::Zero(d);
            for (const AstcGuide::Choice& choice : grid.choices) {
                const FloatVec range = two ? hn::Add(along, across) : along;
                const FloatVec error = hn::Add(hn::Mul(AstcNumber(choice.weights), range), AstcNumber(choice.ends));
                plan = hn::IfThenElse(hn::Lt(error, least), AstcNumber(static_cast<float>(choice.plan)), plan);
                least = hn::Min(error, least);
            }
            const std::size_t to = static_cast<std::size_t>(q * grids + g) * lanes;
            hn::Store(two ? least : hn::Add(least, across), d, guesses.error + to);
            hn::Store(plan, d, guesses.plan + to);
            hn::Store(hn::Load(d, best.plan + at), d, guesses.pattern + to);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex {

HWY_EXPORT(GuessAstc);
HWY_EXPORT(GuessAstcPatterns);

void guess_astc(const AstcGuide& guide, const AstcGroup& group, AstcGuesses& guesses) {
    HWY_DYNAMIC_DISPATCH(GuessAstc)(guide, group, guesses);
}

void guess_astc_patterns(const AstcGuide& guide, const AstcGroup& group, int patterns, AstcGuesses& guesses) {
    HWY_DYNAMIC_DISPATCH(GuessAstcPatterns)(guide, group, patterns, guesses);
}

namespace {

// What measured errors of rounded weights are of those of a uniform distribution between evenly spaced levels, by
// range: the median over the real maps.
constexpr float kMeasuredNoise[kAstcWeightRanges] = {0.26f, 0.455f, 0.555f, 0.61f, 0.65f, 0.65f,
                                                     0.69f, 0.69f,  0.7f,   0.7f,  0.7f,  0.7f};
constexpr float kMeasuredEnds = 0.6f;

// The squared range of texels along a line in terms of their mean energy; evenly spread, it would be 12.
constexpr float kLineEnergy = 10.0f;

AstcGuide::Choice choice_of(const AstcPlans& plans, int number) {
    const AstcPlan& plan = plans.plans[static_cast<std::size_t>(number)];
    const auto texels = static_cast<float>(plans.block.width * plans.block.height);
    const auto steps = static_cast<float>(kAstcRangeTable[plan.mode.range].levels - 1);
    float kept = 0;  // of the noise of the grid's weights, by interpolation
    for (int k = 0; k < plan.grid->texels; ++k) {
        for (const float share : plan.grid->infill[k]) kept += share * share / 256.0f;
    }
    const float step = 255.0f / static_cast<float>(kAstcRangeTable[plan.color_range].levels - 1);
    return {number, plan.mode.planes, kMeasuredNoise[plan.mode.range] * kept / (12.0f * steps * steps),
            2.0f * texels * kMeasuredEnds * step * step / 12.0f,
            plan.grid->is_full && plan.mode.planes == 2 && step < 1.5f ? steps + 1 : 0};
}

// Grids for two partitions, the most useful ones on the real maps first: full ones, and bands along an axis.
std::vector<AstcGuide::Grid> pair_grids(Extent block, int count) {
    const auto [w, h] = std::pair(block.width, block.height);
    const AstcGuide::Grid all[] = {{{w, h}, 1, {}},
                                   {{w, 2}, 1, {}},
                                   {{2, h}, 1, {}},
                                   {{w, h}, 2, {}},
                                   {{w, std::max(3, h / 2)}, 2, {}},
                                   {{std::max(3, w / 2), h}, 2, {}},
                                   {{w - 1, h - 1}, 1, {}},
                                   {{w, 2}, 2, {}},
                                   {{2, h}, 2, {}},
                                   {{w, h - 1}, 1, {}},
                                   {{w - 1, h}, 1, {}},
                                   {{2, (h + 2) / 2}, 1, {}}};
    return {std::begin(all), std::begin(all) + std::min<std::ptrdiff_t>(count, std::size(all))};
}

// Gram and Schmidt's method in double precision.
void make_basis(int texels, int weights, float basis[8][8]) {
    double made[8][8] = {};
    for (int w = 0; w < weights; ++w) {
        double* const row = made[w];
        for (int i = 0; i < texels; ++i) {
            const AstcInfill infill = astc_infill(i, texels, weights);
            row[i] = infill.first == w ? 16 - infill.part : infill.first + 1 == w ? infill.part : 0;
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

}  // namespace

AstcGuide make_astc_guide(const AstcPlans& plans, const AstcReach& reach) {
    AstcGuide guide{};
    guide.plans = &plans;
    guide.of_two = pair_grids(plans.block, reach.pair_grids);
    for (int number = 0; number < static_cast<int>(plans.plans.size()); ++number) {
        AstcGuide::Choice choice = choice_of(plans, number);
        const AstcMode& mode = plans.plans[static_cast<std::size_t>(number)].mode;
        if (number >= plans.first_of_two) {
            choice.weights *= kLineEnergy / static_cast<float>(plans.block.width * plans.block.height);
            for (AstcGuide::Grid& grid : guide.of_two) {
                if (grid.extent == mode.grid && grid.planes == mode.planes) grid.choices.push_back(choice);
            }
            continue;
        }
        if (mode.grid != plans.block && std::max(mode.grid.width, mode.grid.height) > reach.most_weights) continue;
        auto grid = std::find_if(guide.grids.begin(), guide.grids.end(),
                                 [&](const AstcGuide::Grid& made) { return made.extent == mode.grid; });
        if (grid == guide.grids.end()) {
            guide.grids.push_back({mode.grid, 0, {}});
            grid = guide.grids.end() - 1;
        }
        grid->choices.push_back(choice);
    }
    guide.of_two.erase(std::remove_if(guide.of_two.begin(), guide.of_two.end(),
                                      [](const AstcGuide::Grid& grid) { return grid.choices.empty(); }),
                       guide.of_two.end());
    std::stable_sort(guide.grids.begin(), guide.grids.end(), [](const AstcGuide::Grid& a, const AstcGuide::Grid& b) {
        return a.extent.width < b.extent.width;
    });
    for (std::size_t k = 0; k < plans.patterns.size(); k += static_cast<std::size_t>(reach.pattern_steps))
        guide.patterns.push_back(plans.patterns[k]);
    for (int weights = 2; weights <= plans.block.width; ++weights)
        make_basis(plans.block.width, weights, guide.basis[0][weights]);
    for (int weights = 2; weights <= plans.block.height; ++weights)
        make_basis(plans.block.height, weights, guide.basis[1][weights]);
    return guide;
}

}  // namespace tex
#endif
