// SPDX-License-Identifier: Apache-2.0
// astc_shape-inl.h: what the guesses of ASTC measure of blocks side by side. Include it after hwy/highway.h, once for
// each target.

#if defined(TEX_KERNELS_ASTC_SHAPE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_ASTC_SHAPE_INL_H
#undef TEX_KERNELS_ASTC_SHAPE_INL_H
#else
#define TEX_KERNELS_ASTC_SHAPE_INL_H
#endif

#include <cstddef>

#include <hwy/highway.h>

#include "kernels/astc_guess.h"
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

// The direction in which texels differ most, of sums of products without the mean; and the energy across it.
struct AstcDirection {
    FloatVec cos, sin, across;
};
HWY_INLINE AstcDirection DirectionOf(FloatVec xx, FloatVec xy, FloatVec yy) {
    const FloatTag d;
    const FloatVec half = hn::Mul(hn::Sub(xx, yy), AstcNumber(0.5f));
    const FloatVec root = hn::Sqrt(hn::Add(hn::Mul(half, half), hn::Mul(xy, xy)));
    // The eigenvector of the greater eigenvalue: of two forms, that which does not vanish.
    const auto wide = hn::Ge(half, hn::Zero(d));
    const FloatVec dx = hn::IfThenElse(wide, hn::Add(root, half), xy);
    const FloatVec dy = hn::IfThenElse(wide, xy, hn::Sub(root, half));
    const FloatVec square = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
    const auto is_line = hn::Gt(square, AstcNumber(1e-12f));
    const FloatVec scale = hn::Div(AstcNumber(1.0f), hn::Sqrt(hn::IfThenElse(is_line, square, AstcNumber(1.0f))));
    return {hn::IfThenElse(is_line, hn::Mul(dx, scale), AstcNumber(1.0f)),
            hn::IfThenElseZero(is_line, hn::Mul(dy, scale)),
            hn::Max(hn::Sub(hn::Mul(hn::Add(xx, yy), AstcNumber(0.5f)), root), hn::Zero(d))};
}

// Two channels without their means, and what is known about them.
struct AstcShape {
    alignas(64) float v[2][kAstcMostPlanned * kAstcLanes];
    FloatVec xx, yy, xy;          // sums of products
    FloatVec cos, sin;            // the direction in which they differ most
    FloatVec across;              // the energy perpendicular to it
    FloatVec ranges, line_range;  // squared: of both channels together, along the direction
    FloatVec least[2], greatest[2];
    FloatVec line_middle;
};

static HWY_NOINLINE void MeasureShape(const AstcGroup& group, int texels, AstcShape& shape) {
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
    const AstcDirection line = DirectionOf(xx, xy, yy);
    shape.cos = line.cos;
    shape.sin = line.sin;
    shape.across = line.across;
    FloatVec least = AstcNumber(1e6f), greatest = AstcNumber(-1e6f);
    for (std::size_t k = 0; k < end; k += lanes) {
        const FloatVec along =
            hn::Add(hn::Mul(hn::Load(d, shape.v[0] + k), shape.cos), hn::Mul(hn::Load(d, shape.v[1] + k), shape.sin));
        least = hn::Min(least, along);
        greatest = hn::Max(greatest, along);
    }
    const FloatVec range = hn::Sub(greatest, least);
    shape.line_range = hn::Mul(range, range);
    shape.line_middle = hn::Mul(hn::Add(greatest, least), AstcNumber(0.5f));
    shape.ranges = ranges;
    shape.xx = xx;
    shape.xy = xy;
    shape.yy = yy;
}

// Replaces the texels of a channel by the sums of them and their mirror images, and those after the middle by the
// differences, along rows and columns: bases, which are the same from both ends or change their signs, need only half
// of the texels then.
static HWY_NOINLINE void FoldTexels(Extent block, float* channel) {
    const FloatTag d;
    const std::size_t lanes = hn::Lanes(d);
    const auto fold = [&](int first, int count, int step) {
        for (int i = 0; i < count / 2; ++i) {
            float* const from = channel + static_cast<std::size_t>(first + i * step) * lanes;
            float* const to = channel + static_cast<std::size_t>(first + (count - 1 - i) * step) * lanes;
            const FloatVec a = hn::Load(d, from), b = hn::Load(d, to);
            hn::Store(hn::Add(a, b), d, from);
            hn::Store(hn::Sub(a, b), d, to);
        }
    };
    for (int j = 0; j < block.height; ++j) fold(j * block.width, block.width, 1);
    for (int i = 0; i < block.width; ++i) fold(i, block.height, block.width);
}

// Projects the rows of a folded channel onto the space that so many weights span.
static HWY_NOINLINE void ProjectChannel(const AstcGuide& guide, int weights, const float* channel, float* rows) {
    const FloatTag d;
    const std::size_t lanes = hn::Lanes(d);
    const int width = guide.plans->block.width, across = (width + 1) / 2, even = (weights + 1) / 2;
    for (int j = 0; j < guide.plans->block.height; ++j, rows += 8 * lanes) {
        for (int w = 0; w < weights; ++w) {
            const float* const basis = guide.basis[0][weights][w];
            FloatVec sum = hn::Zero(d);
            for (int i = w < even ? 0 : across, end = w < even ? across : width; i < end; ++i) {
                const FloatVec v = hn::Load(d, channel + static_cast<std::size_t>(j * width + i) * lanes);
                sum = hn::Add(sum, hn::Mul(AstcNumber(basis[i]), v));
            }
            hn::Store(sum, d, rows + static_cast<std::size_t>(w) * lanes);
        }
    }
}

// Sums of products of two projected rows that are both sums or both differences, twice if the rows differ: of a channel
// with itself or, with kCross, with another one.
template <bool kCross>
HWY_NOINLINE void MultiplyRows(Extent block, int weights, const float* a, const float* b, int sums, float* gram) {
    const FloatTag d;
    const std::size_t lanes = hn::Lanes(d), end = static_cast<std::size_t>(weights) * lanes;
    const int down = (block.height + 1) / 2;
    for (int j = 0; j < block.height; ++j) {
        for (int k = j < down ? 0 : down; k <= j; ++k, gram += static_cast<std::size_t>(sums) * lanes) {
            const std::size_t first = static_cast<std::size_t>(8 * j) * lanes;
            const std::size_t second = static_cast<std::size_t>(8 * k) * lanes;
            FloatVec sum = hn::Zero(d);
            for (std::size_t w = 0; w < end; w += lanes) {
                sum = hn::Add(sum, hn::Mul(hn::Load(d, a + first + w), hn::Load(d, b + second + w)));
                if (kCross) sum = hn::Add(sum, hn::Mul(hn::Load(d, a + second + w), hn::Load(d, b + first + w)));
            }
            const float times = (kCross ? 1.0f : 2.0f) * (j == k ? 0.5f : 1.0f);
            hn::Store(hn::Mul(sum, AstcNumber(times)), d, gram);
        }
    }
}

// Projects the rows of `count` folded channels. `gram` becomes the sums of products, with `cross` of two channels xx,
// yy and xy, of three xx, yy, zz, xy, xz and yz; without, those of each channel with itself.
static HWY_NOINLINE void ProjectRows(const AstcGuide& guide, int weights, const float* const* channels, int count,
                                     bool cross, float* gram) {
    alignas(64) float rows[3][64 * kAstcLanes];
    const Extent block = guide.plans->block;
    const std::size_t lanes = hn::Lanes(FloatTag());
    const int sums = cross ? 3 * (count - 1) : count;
    for (int c = 0; c < count; ++c) {
        ProjectChannel(guide, weights, channels[c], rows[c]);
        MultiplyRows<false>(block, weights, rows[c], rows[c], sums, gram + static_cast<std::size_t>(c) * lanes);
    }
    for (int c = 1; c < count && cross; ++c) {
        for (int e = 0; e < c; ++e) {
            float* const to = gram + static_cast<std::size_t>(count + e + c - 1) * lanes;
            MultiplyRows<true>(block, weights, rows[e], rows[c], sums, to);
        }
    }
}

// The sums of products in the space of a grid, of rows that are projected.
template <int kSums>
HWY_NOINLINE void ProjectColumns(const AstcGuide& guide, Extent grid, const float* gram, FloatVec* e) {
    const FloatTag d;
    FloatVec sum[kSums];
    for (FloatVec& s : sum) s = hn::Zero(d);
    const int half = guide.plans->block.height / 2, pairs = half * (half + 1);
    for (int k = 0; k < (half + half == guide.plans->block.height ? pairs : pairs + half + 1); ++k) {
        const FloatVec share = AstcNumber(guide.pairs[grid.height][k]);
        for (FloatVec& s : sum) {
            s = hn::Add(s, hn::Mul(share, hn::Load(d, gram)));
            gram += hn::Lanes(d);
        }
    }
    for (int n = 0; n < kSums; ++n) e[n] = sum[n];
}

// Selects a texel's value inside part p, and another one elsewhere.
HWY_INLINE FloatVec AstcInside(FloatVec part, int p, FloatVec value, FloatVec other) {
    return hn::IfThenElse(hn::Eq(part, AstcNumber(static_cast<float>(p))), value, other);
}

// The sum of the squared errors if texels are rounded to evenly spaced levels, of which the outer ones are the ends of
// the range: over part p, or over all texels if `part` is null.
static HWY_NOINLINE FloatVec CoarseLeave(const float* field, FloatVec field_middle, const float* part, int p,
                                         FloatVec range, float steps, std::size_t end) {
    const FloatTag d;
    const FloatVec step = hn::Mul(hn::Max(range, AstcNumber(1e-3f)), AstcNumber(1.0f / steps));
    const FloatVec over = hn::Div(AstcNumber(1.0f), step);
    const FloatVec middle = hn::Sub(AstcNumber(0.5f * steps + 0.5f), hn::Mul(field_middle, over));
    FloatVec sum = hn::Zero(d);
    for (std::size_t k = 0; k < end; k += hn::Lanes(d)) {
        const FloatVec level = hn::Add(hn::Mul(hn::Load(d, field + k), over), middle);
        const FloatVec off = hn::Sub(hn::Sub(level, AstcNumber(0.5f)), hn::Floor(level));
        const FloatVec square = hn::Mul(off, off);
        sum = hn::Add(sum, part == nullptr ? square : AstcInside(hn::Load(d, part + k), p, square, hn::Zero(d)));
    }
    return hn::Mul(sum, hn::Mul(step, step));
}

// The squared error of coarse weights, `leave`, divided by that of texels that are spread evenly over the range; at
// most 1.
HWY_INLINE FloatVec CoarseShare(FloatVec leave, FloatVec squared_range, int coarse, int texels) {
    const auto steps = static_cast<float>(coarse + 1);
    const FloatVec even = hn::Mul(squared_range, AstcNumber(static_cast<float>(texels) / (12.0f * steps * steps)));
    return hn::Min(AstcNumber(1.0f), hn::Div(leave, hn::Max(even, AstcNumber(1e-3f))));
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif  // TEX_KERNELS_ASTC_SHAPE_INL_H
