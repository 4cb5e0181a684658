// SPDX-License-Identifier: Apache-2.0

#include "kernels/astc_guess.h"

#include <algorithm>

#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/astc_guess.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/astc_shape-inl.h"
#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

// What evenly spaced levels between the least and the greatest values leave of both channels. Some maps have been
// rounded to few values, of which the model of noise knows nothing.
HWY_INLINE FloatVec LevelsLeave(const AstcShape& shape, float levels, Extent block) {
    const FloatTag d;
    const std::size_t end = static_cast<std::size_t>(block.width * block.height) * hn::Lanes(d);
    FloatVec left = hn::Zero(d);
    for (int c = 0; c < 2; ++c) {
        const FloatVec range = hn::Max(hn::Sub(shape.greatest[c], shape.least[c]), AstcNumber(1e-3f));
        const FloatVec over = hn::Div(AstcNumber(levels - 1.0f), range), half = AstcNumber(0.5f);
        const FloatVec first = hn::Sub(half, hn::Mul(shape.least[c], over));
        FloatVec sum = hn::Zero(d);
        for (std::size_t k = 0; k < end; k += hn::Lanes(d)) {
            const FloatVec place = hn::Add(hn::Mul(hn::Load(d, shape.v[c] + k), over), first);
            const FloatVec off = hn::Sub(hn::Sub(place, hn::Floor(place)), half);
            sum = hn::Add(sum, hn::Mul(off, off));
        }
        const FloatVec step = hn::Mul(range, AstcNumber(1.0f / (levels - 1.0f)));
        left = hn::Add(left, hn::Mul(sum, hn::Mul(step, step)));
    }
    return left;
}

// `line` holds the places along the direction in which texels differ most.
void MeasureCoarse(const AstcShape& shape, const float* line, int texels, FloatVec coarse[kAstcCoarseLevels]) {
    const std::size_t lanes = hn::Lanes(FloatTag()), end = static_cast<std::size_t>(texels) * lanes;
    for (int l = 0; l < kAstcCoarseLevels; ++l) {
        const FloatVec leave = CoarseLeave(line, shape.line_middle, nullptr, 0, hn::Sqrt(shape.line_range),
                                           static_cast<float>(l + 1), end);
        coarse[l] = CoarseShare(leave, shape.line_range, l, texels);
    }
}

// What is not a number becomes the least value.
HWY_INLINE FloatVec AstcPlaneValue(FloatVec n, FloatVec scale) {
    const FloatVec one = AstcNumber(1.0f), minus_one = AstcNumber(-1.0f);
    const FloatVec low = hn::IfThenElse(hn::Gt(n, minus_one), n, minus_one);
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
        x[k] = (std::min(std::max(-1.0f, xy[2 * k]), 1.0f) + 1.0f) * scale;
        y[k] = (std::min(std::max(-1.0f, xy[2 * k + 1]), 1.0f) + 1.0f) * scale;
    }
}

void GuessAstc(const AstcGuide& guide, const AstcGroup& group, AstcGuesses& guesses) {
    const FloatTag d;
    const bool is_one = guesses.count == 1;  // stays in registers
    AstcShape shape;
    const Extent block = guide.plans->block;
    MeasureShape(group, block.width * block.height, shape);
    ClearGuesses(guesses);
    FloatVec least = AstcNumber(1e30f), best = hn::Zero(d);
    hn::Store(shape.ranges, d, guesses.range);
    const FloatVec widest =
        hn::Max(hn::Sub(shape.greatest[0], shape.least[0]), hn::Sub(shape.greatest[1], shape.least[1]));
    hn::Store(widest, d, guesses.widest);
    const auto is_narrow = hn::Le(widest, AstcNumber(kAstcNarrow));
    alignas(64) float rows[kAstcPairs * 2 * kAstcLanes];
    // Along the direction in which texels differ most, and across.
    alignas(64) float turned[2][kAstcMostPlanned * kAstcLanes];
    const std::size_t lanes = hn::Lanes(d), end = static_cast<std::size_t>(block.width * block.height) * lanes;
    for (std::size_t k = 0; k < end; k += lanes) {
        const FloatVec x = hn::Load(d, shape.v[0] + k), y = hn::Load(d, shape.v[1] + k);
        hn::Store(hn::Add(hn::Mul(x, shape.cos), hn::Mul(y, shape.sin)), d, turned[0] + k);
        hn::Store(hn::Sub(hn::Mul(y, shape.cos), hn::Mul(x, shape.sin)), d, turned[1] + k);
    }
    const FloatVec energy = hn::Add(shape.xx, shape.yy), along = hn::Sub(energy, shape.across);
    FloatVec coarse[kAstcCoarseLevels];
    if (guide.measures_coarse) MeasureCoarse(shape, turned[0], block.width * block.height, coarse);
    const float* const channels[2] = {turned[0], turned[1]};
    for (float* channel : turned) FoldTexels(block, channel);
    int width = 0;
    for (const AstcGuide::Grid& grid : guide.grids) {
        // The energies inside the space of the grid; the rest is error.
        FloatVec in[2] = {along, shape.across};
        if (grid.extent != block) {
            if (grid.extent.width != width) ProjectRows(guide, grid.extent.width, channels, 2, false, rows);
            width = grid.extent.width;
            ProjectColumns<2>(guide, grid.extent, rows, in);
        }
        const FloatVec two = hn::Max(hn::Sub(energy, hn::Add(in[0], in[1])), hn::Zero(d));
        const FloatVec one = hn::Add(hn::Max(hn::Sub(along, in[0]), hn::Zero(d)), shape.across);
        for (const AstcGuide::Choice& choice : grid.choices) {
            const FloatVec range = choice.planes == 2 ? shape.ranges : shape.line_range;
            const FloatVec ends = hn::IfThenElse(is_narrow, AstcNumber(choice.offsets), AstcNumber(choice.ends));
            FloatVec noise = hn::Mul(AstcNumber(choice.weights), range);
            if (guide.measures_coarse && choice.coarse >= 0 && choice.planes == 1)
                noise = hn::Mul(noise, coarse[choice.coarse]);
            noise = hn::Add(noise, ends);
            if (choice.levels > 0) noise = hn::Min(noise, LevelsLeave(shape, choice.levels, block));
            const FloatVec error = hn::Add(choice.planes == 2 ? two : one, noise);
            if (is_one) {
                best = hn::IfThenElse(hn::Lt(error, least), AstcNumber(static_cast<float>(choice.plan)), best);
                least = hn::Min(error, least);
            } else {
                AddGuess(error, choice.plan, hn::Zero(d), guesses);
            }
        }
    }
    if (!is_one) return;
    hn::Store(least, d, guesses.error);
    hn::Store(best, d, guesses.plan);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, astc_planes, AstcPlanes, (const float* xy, std::size_t count, float scale, float* x, float* y),
           (xy, count, scale, x, y))

TEX_KERNEL(void, guess_astc, GuessAstc, (const AstcGuide& guide, const AstcGroup& group, AstcGuesses& guesses),
           (guide, group, guesses))

}  // namespace tex::inline v1
#endif
