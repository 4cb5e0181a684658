// SPDX-License-Identifier: Apache-2.0

#include "kernels/astc_parts.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/astc_parts.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/astc_shape-inl.h"
#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

// A partition's energy along the direction in which it differs most, and across.
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

// Ranks the patterns. Of the best ones, `plan` becomes the number and `pattern` the energy along the lines.
void RankPatterns(const AstcGuide& guide, const AstcShape& shape, int partitions, AstcGuesses& best) {
    const FloatTag d;
    const std::vector<AstcPattern>& all = guide.patterns[partitions - 2];
    const std::size_t lanes = hn::Lanes(d);
    const int texels = guide.plans->block.width * guide.plans->block.height;
    alignas(64) float product[3][kAstcMostPlanned * kAstcLanes];
    for (std::size_t k = 0; k < static_cast<std::size_t>(texels) * lanes; k += lanes) {
        const FloatVec x = hn::Load(d, shape.v[0] + k), y = hn::Load(d, shape.v[1] + k);
        hn::Store(hn::Mul(x, x), d, product[0] + k);
        hn::Store(hn::Mul(x, y), d, product[1] + k);
        hn::Store(hn::Mul(y, y), d, product[2] + k);
    }
    ClearGuesses(best);
    for (std::size_t n = 0; n < all.size(); ++n) {
        // The first partition is what the others leave.
        FloatVec x1 = hn::Zero(d), y1 = x1, xx1 = shape.xx, xy1 = shape.xy, yy1 = shape.yy, along = x1, across = x1;
        int first = texels;
        for (int p = 0; p < partitions - 1; ++p) {
            FloatVec x = hn::Zero(d), y = x, xx = x, xy = x, yy = x;
            int count = 0;
            for (int k = 0; k < texels; ++k) {
                if ((all[n].later[p] >> k & 1) == 0) continue;
                const std::size_t at = static_cast<std::size_t>(k) * lanes;
                ++count;
                x = hn::Add(x, hn::Load(d, shape.v[0] + at));
                y = hn::Add(y, hn::Load(d, shape.v[1] + at));
                xx = hn::Add(xx, hn::Load(d, product[0] + at));
                xy = hn::Add(xy, hn::Load(d, product[1] + at));
                yy = hn::Add(yy, hn::Load(d, product[2] + at));
            }
            const AstcAxes axes = AxesOf(static_cast<float>(count), x, y, xx, xy, yy);
            along = hn::Add(along, axes.along);
            across = hn::Add(across, axes.across);
            x1 = hn::Sub(x1, x);
            y1 = hn::Sub(y1, y);
            xx1 = hn::Sub(xx1, xx);
            xy1 = hn::Sub(xy1, xy);
            yy1 = hn::Sub(yy1, yy);
            first -= count;
        }
        const AstcAxes axes = AxesOf(static_cast<float>(first), x1, y1, xx1, xy1, yy1);
        along = hn::Add(along, axes.along);
        across = hn::Add(across, axes.across);
        const FloatVec rank = hn::Add(across, hn::Mul(along, AstcNumber(kAstcRankNoise)));
        AddGuess(rank, static_cast<int>(n), along, best);
    }
}

// Texels of patterns, which differ by block, beside the middles of their partitions.
struct AstcPartShape {
    // Along the lines of partitions; x; y.
    alignas(64) float field[3][kAstcMostPlanned * kAstcLanes];
    alignas(64) float line[3][kAstcMostPlanned * kAstcLanes];  // the first one, for each partition; 0 outside
    FloatVec line_range, ranges;    // the mean over the texels of the squared ranges of their partitions
    FloatVec narrow, narrow_share;  // bits of the partitions that are narrow; how many of all that is
    // What 2, 3 ... levels leave along the lines, as shares of what they leave of even spreads.
    FloatVec coarse[kAstcCoarseLevels];
};

struct AstcSpan {
    FloatVec least, greatest;
};
HWY_NOINLINE AstcSpan SpanOf(const float* value, const float* part, int p, std::size_t end) {
    const FloatTag d;
    AstcSpan span = {AstcNumber(1e6f), AstcNumber(-1e6f)};
    for (std::size_t k = 0; k < end; k += hn::Lanes(d)) {
        const FloatVec v = hn::Load(d, value + k), of = hn::Load(d, part + k);
        span.least = hn::Min(span.least, AstcInside(of, p, v, span.least));
        span.greatest = hn::Max(span.greatest, AstcInside(of, p, v, span.greatest));
    }
    return span;
}

HWY_NOINLINE void MovePart(float* value, const float* part, int p, FloatVec by, std::size_t end) {
    const FloatTag d;
    for (std::size_t k = 0; k < end; k += hn::Lanes(d)) {
        const FloatVec v = hn::Load(d, value + k);
        hn::Store(AstcInside(hn::Load(d, part + k), p, hn::Sub(v, by), v), d, value + k);
    }
}

void MeasureParts(const AstcShape& shape, const float* part, int partitions, int texels, AstcPartShape& made) {
    const FloatTag d;
    const std::size_t lanes = hn::Lanes(d), end = static_cast<std::size_t>(texels) * lanes;
    const FloatVec zero = hn::Zero(d), one = AstcNumber(1.0f);
    made.line_range = made.ranges = made.narrow = made.narrow_share = zero;
    FloatVec leave[kAstcCoarseLevels];
    for (FloatVec& l : leave) l = zero;
    for (int c = 0; c < 2; ++c) {
        for (std::size_t k = 0; k < end; k += lanes) hn::Store(hn::Load(d, shape.v[c] + k), d, made.field[c + 1] + k);
    }
    for (int p = 0; p < partitions; ++p) {
        FloatVec n = zero, x = zero, y = zero, xx = zero, xy = zero, yy = zero;
        for (std::size_t k = 0; k < end; k += lanes) {
            const FloatVec in = AstcInside(hn::Load(d, part + k), p, one, zero);
            const FloatVec u = hn::Load(d, shape.v[0] + k), v = hn::Load(d, shape.v[1] + k);
            const FloatVec inside_u = hn::Mul(in, u), inside_v = hn::Mul(in, v);
            n = hn::Add(n, in);
            x = hn::Add(x, inside_u);
            y = hn::Add(y, inside_v);
            xx = hn::Add(xx, hn::Mul(inside_u, u));
            xy = hn::Add(xy, hn::Mul(inside_u, v));
            yy = hn::Add(yy, hn::Mul(inside_v, v));
        }
        const FloatVec over = hn::Div(one, hn::Max(n, one));
        const AstcDirection line =
            DirectionOf(hn::Sub(xx, hn::Mul(hn::Mul(x, x), over)), hn::Sub(xy, hn::Mul(hn::Mul(x, y), over)),
                        hn::Sub(yy, hn::Mul(hn::Mul(y, y), over)));
        for (std::size_t k = 0; k < end; k += lanes) {
            const FloatVec along =
                hn::Add(hn::Mul(hn::Load(d, shape.v[0] + k), line.cos), hn::Mul(hn::Load(d, shape.v[1] + k), line.sin));
            hn::Store(AstcInside(hn::Load(d, part + k), p, along, hn::Load(d, made.field[0] + k)), d,
                      made.field[0] + k);
        }
        FloatVec range[3];
        for (int f = 0; f < 3; ++f) {
            const AstcSpan span = SpanOf(made.field[f], part, p, end);
            range[f] = hn::Sub(span.greatest, span.least);
            const FloatVec middle = hn::Mul(hn::Add(span.greatest, span.least), AstcNumber(0.5f));
            MovePart(made.field[f], part, p, middle, end);
        }
        const FloatVec share = hn::Mul(n, AstcNumber(1.0f / static_cast<float>(texels)));
        made.line_range = hn::Add(made.line_range, hn::Mul(share, hn::Mul(range[0], range[0])));
        const FloatVec both = hn::Add(hn::Mul(range[1], range[1]), hn::Mul(range[2], range[2]));
        made.ranges = hn::Add(made.ranges, hn::Mul(share, both));
        const auto is_narrow = hn::Le(hn::Max(range[1], range[2]), AstcNumber(kAstcNarrow));
        made.narrow = hn::Add(made.narrow, hn::IfThenElseZero(is_narrow, AstcNumber(static_cast<float>(1 << p))));
        made.narrow_share = hn::Add(made.narrow_share,
                                    hn::IfThenElseZero(is_narrow, AstcNumber(1.0f / static_cast<float>(partitions))));
        for (std::size_t k = 0; k < end; k += lanes) {
            const FloatVec along = hn::Load(d, made.field[0] + k);
            hn::Store(AstcInside(hn::Load(d, part + k), p, along, zero), d, made.line[p] + k);
        }
        for (int l = 0; l < kAstcCoarseLevels; ++l) {
            leave[l] =
                hn::Add(leave[l], CoarseLeave(made.field[0], zero, part, p, range[0], static_cast<float>(l + 1), end));
        }
    }
    for (int l = 0; l < kAstcCoarseLevels; ++l) made.coarse[l] = CoarseShare(leave[l], made.line_range, l, texels);
}

// What a grid cannot express of lines whose directions are free: the directions of the second and third partitions are
// turned where that helps, which bits say.
struct AstcTurned {
    FloatVec left, turns;
};
HWY_NOINLINE AstcTurned TurnedLines(const AstcGuide& guide, Extent grid, const float* rows, int partitions,
                                    FloatVec energy) {
    const FloatTag d;
    const FloatVec zero = hn::Zero(d);
    FloatVec sum[6];
    if (partitions == 2) {
        ProjectColumns<3>(guide, grid, rows, sum);
        const FloatVec cross = hn::Abs(sum[2]), inside = hn::Add(hn::Add(sum[0], sum[1]), hn::Add(cross, cross));
        return {hn::Sub(energy, inside), hn::IfThenElseZero(hn::Lt(sum[2], zero), AstcNumber(2.0f))};
    }
    ProjectColumns<6>(guide, grid, rows, sum);
    const FloatVec squares = hn::Add(hn::Add(sum[0], sum[1]), sum[2]);
    FloatVec most = AstcNumber(-1e30f), turns = zero;
    for (int turn = 0; turn < 8; turn += 2) {
        FloatVec cross = (turn & 2) != 0 ? hn::Neg(sum[3]) : sum[3];
        cross = (turn & 4) != 0 ? hn::Sub(cross, sum[4]) : hn::Add(cross, sum[4]);
        cross = turn == 2 || turn == 4 ? hn::Sub(cross, sum[5]) : hn::Add(cross, sum[5]);
        turns = hn::IfThenElse(hn::Gt(cross, most), AstcNumber(static_cast<float>(turn)), turns);
        most = hn::Max(most, cross);
    }
    return {hn::Sub(energy, hn::Add(squares, hn::Add(most, most))), turns};
}

// Guesses all plans for a pattern of each block. Keeps the `guesses.count` best. Folds the texels of the shape.
void GuessParts(const AstcGuide& guide, AstcPartShape& shape, FloatVec across, int partitions, AstcGuesses& guesses) {
    const FloatTag d;
    const std::size_t lanes = hn::Lanes(d);
    const Extent block = guide.plans->block;
    const std::size_t end = static_cast<std::size_t>(block.width * block.height) * lanes;
    FloatVec energy[3];
    for (int f = 0; f < 3; ++f) {
        energy[f] = hn::Zero(d);
        for (std::size_t k = 0; k < end; k += lanes) {
            const FloatVec v = hn::Load(d, shape.field[f] + k);
            energy[f] = hn::Add(energy[f], hn::Mul(v, v));
        }
    }
    const FloatVec energies = hn::Add(energy[1], energy[2]);
    alignas(64) float rows[kAstcPairs * 2 * kAstcLanes], line_rows[kAstcPairs * 6 * kAstcLanes];
    const float* const channels[2] = {shape.field[1], shape.field[2]};
    const float* const lines[3] = {shape.line[0], shape.line[1], shape.line[2]};
    const auto& grids = guide.of_parts[partitions - 2];
    const bool has_planes =
        std::any_of(grids.begin(), grids.end(), [](const AstcGuide::Grid& grid) { return grid.has_planes; });
    for (int f = 1; f <= 2; ++f) FoldTexels(block, shape.field[f]);
    for (int p = 0; p < partitions; ++p) FoldTexels(block, shape.line[p]);
    int width = 0;
    for (const AstcGuide::Grid& grid : grids) {
        FloatVec two = hn::Zero(d);
        AstcTurned one = {two, two};
        if (grid.extent != block) {
            if (grid.extent.width != width) {
                width = grid.extent.width;
                if (has_planes) ProjectRows(guide, width, channels, 2, false, rows);
                ProjectRows(guide, width, lines, partitions, true, line_rows);
            }
            one = TurnedLines(guide, grid.extent, line_rows, partitions, energy[0]);
            if (grid.has_planes) {
                FloatVec in[2];
                ProjectColumns<2>(guide, grid.extent, rows, in);
                two = hn::Max(two, hn::Sub(energies, hn::Add(in[0], in[1])));
            }
        }
        one.left = hn::Add(hn::Max(one.left, hn::Zero(d)), across);
        const FloatVec bits = hn::Add(shape.narrow, hn::Mul(one.turns, AstcNumber(16.0f)));
        for (const AstcGuide::Choice& choice : grid.choices) {
            const FloatVec better = hn::Mul(shape.narrow_share, AstcNumber(choice.ends - choice.offsets));
            const FloatVec ends = hn::Sub(AstcNumber(choice.ends), better);
            FloatVec noise = hn::Mul(AstcNumber(choice.weights), choice.planes == 2 ? shape.ranges : shape.line_range);
            if (choice.coarse >= 0 && choice.planes == 1) noise = hn::Mul(noise, shape.coarse[choice.coarse]);
            AddGuess(hn::Add(choice.planes == 2 ? two : one.left, hn::Add(noise, ends)), choice.plan, bits, guesses);
        }
    }
}

void GuessAstcPatterns(const AstcGuide& guide, const AstcGroup& group, int partitions, int patterns, int plans,
                       AstcGuesses& guesses) {
    const std::vector<AstcPattern>& all = guide.patterns[partitions - 2];
    const FloatTag d;
    const std::size_t lanes = hn::Lanes(d);
    const int texels = guide.plans->block.width * guide.plans->block.height;
    AstcShape shape;
    MeasureShape(group, texels, shape);
    AstcGuesses best;
    best.count = patterns;
    ClearGuesses(best);
    RankPatterns(guide, shape, partitions, best);
    guesses.count = patterns * plans;
    alignas(64) float part[kAstcMostPlanned * kAstcLanes];
    AstcPartShape parts;
    AstcGuesses of_pattern;
    of_pattern.count = plans;
    for (int q = 0; q < patterns; ++q) {
        const std::size_t at = static_cast<std::size_t>(q) * lanes;
        for (std::size_t l = 0; l < lanes; ++l) {
            const auto& later = all[static_cast<std::size_t>(best.plan[at + l])].later;
            for (int k = 0; k < texels; ++k) {
                part[static_cast<std::size_t>(k) * lanes + l] =
                    static_cast<float>((later[0] >> k & 1) + 2 * (later[1] >> k & 1));
            }
        }
        MeasureParts(shape, part, partitions, texels, parts);
        const FloatVec along = hn::Load(d, best.pattern + at);
        const FloatVec across = hn::Sub(hn::Load(d, best.error + at), hn::Mul(along, AstcNumber(kAstcRankNoise)));
        ClearGuesses(of_pattern);
        GuessParts(guide, parts, across, partitions, of_pattern);
        for (int k = 0; k < plans; ++k) {
            const std::size_t from = static_cast<std::size_t>(k) * lanes;
            const std::size_t to = static_cast<std::size_t>(q * plans + k) * lanes;
            hn::Store(hn::Load(d, of_pattern.error + from), d, guesses.error + to);
            hn::Store(hn::Load(d, of_pattern.plan + from), d, guesses.plan + to);
            hn::Store(hn::Load(d, of_pattern.pattern + from), d, guesses.bits + to);
            hn::Store(hn::Load(d, best.plan + at), d, guesses.pattern + to);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, guess_astc_patterns, GuessAstcPatterns,
           (const AstcGuide& guide, const AstcGroup& group, int partitions, int patterns, int plans,
            AstcGuesses& guesses),
           (guide, group, partitions, patterns, plans, guesses))

}  // namespace tex::inline v1
#endif
