// SPDX-License-Identifier: Apache-2.0

#include "kernels/astc_guess.h"

#include <algorithm>

#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/astc_guess.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
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

HWY_INLINE FloatVec AstcPlaneValue(FloatVec n, FloatVec scale) {
    const FloatVec one = AstcNumber(1.0f), minus_one = AstcNumber(-1.0f);
    const FloatVec low = hn::IfThenElse(hn::Lt(n, minus_one), minus_one, n);
    return hn::Mul(hn::Add(hn::IfThenElse(hn::Lt(one, low), one, low), one), scale);
}

void AstcPlanes(const float* xy, std::size_t count, float scale, float* x, float* y) {
    const FloatTag d;
    const std::size_t lanes = hn::Lanes(d);
    const FloatVec by = AstcNumber(scale);
    std::size_t k = 0;
    for (; k + lanes <= count; k += lanes) {
        FloatVec u, v;
        hn::LoadInterleaved2(d, xy + 2 * k, u, v);
        hn::StoreU(AstcPlaneValue(u, by), d, x + k);
        hn::StoreU(AstcPlaneValue(v, by), d, y + k);
    }
    for (; k < count; ++k) {
        x[k] = (std::clamp(xy[2 * k], -1.0f, 1.0f) + 1.0f) * scale;
        y[k] = (std::clamp(xy[2 * k + 1], -1.0f, 1.0f) + 1.0f) * scale;
    }
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

void GuessAstcPatterns(const AstcGuide& guide, const AstcGroup& group, int partitions, int patterns,
                       AstcGuesses& guesses) {
    const std::vector<AstcPattern>& all = guide.patterns[partitions - 2];
    const std::vector<AstcGuide::Grid>& of_parts = guide.of_parts[partitions - 2];
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
    const int grids = static_cast<int>(of_parts.size());
    guesses.count = patterns * grids;
    ClearGuesses(guesses);
    for (int q = 0; q < patterns; ++q) {
        const std::size_t at = static_cast<std::size_t>(q) * lanes;
        const FloatVec along = hn::Load(d, best.pattern + at);
        const FloatVec across = hn::Sub(hn::Load(d, best.error + at), hn::Mul(along, AstcNumber(kAstcRankNoise)));
        for (int g = 0; g < grids; ++g) {
            const AstcGuide::Grid& grid = of_parts[static_cast<std::size_t>(g)];
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
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

HWY_EXPORT(GuessAstc);
HWY_EXPORT(GuessAstcPatterns);
HWY_EXPORT(AstcPlanes);

void astc_planes(const float* xy, std::size_t count, float scale, float* x, float* y) {
    HWY_DYNAMIC_DISPATCH(AstcPlanes)(xy, count, scale, x, y);
}

void guess_astc(const AstcGuide& guide, const AstcGroup& group, AstcGuesses& guesses) {
    HWY_DYNAMIC_DISPATCH(GuessAstc)(guide, group, guesses);
}

void guess_astc_patterns(const AstcGuide& guide, const AstcGroup& group, int partitions, int patterns,
                         AstcGuesses& guesses) {
    HWY_DYNAMIC_DISPATCH(GuessAstcPatterns)(guide, group, partitions, patterns, guesses);
}

}  // namespace tex::inline v1
#endif
