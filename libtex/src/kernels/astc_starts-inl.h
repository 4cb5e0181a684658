// SPDX-License-Identifier: Apache-2.0
// astc_starts-inl.h: where AstcLine begins. Include it after hwy/highway.h, once for each target.

#if defined(TEX_KERNELS_ASTC_STARTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_ASTC_STARTS_INL_H
#undef TEX_KERNELS_ASTC_STARTS_INL_H
#else
#define TEX_KERNELS_ASTC_STARTS_INL_H
#endif

#include "blocks/astc_ise.h"
#include "kernels/astc_line-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

// What a partition's texels are, as 0 or 1.
template <int kChannels, int kPartitions>
HWY_INLINE AstcFloat AstcLine<kChannels, kPartitions>::in_partition(int p, int k) const {
    const AstcFloat partition = hn::Load(d_, partition_ + at(k));
    return hn::IfThenElseZero(hn::Eq(partition, number(static_cast<float>(p))), number(1.0f));
}

// The ends of the texels on the line through their middle along which they differ most.
template <int kChannels, int kPartitions>
AstcEnds<kChannels, kPartitions> AstcLine<kChannels, kPartitions>::outer_ends() const {
    Ends ends;
    for (int p = 0; p < partitions(); ++p) {
        if (kChannels == 1) {
            AstcFloat least = number(1e6f), greatest = number(-1e6f);
            for (int k = 0; k < plan_.grid->texels; ++k) {
                const AstcFloat v = texel(0, k);
                least = hn::Min(least, kPartitions == 1 ? v : of_partition(p, k, v, number(1e6f)));
                greatest = hn::Max(greatest, kPartitions == 1 ? v : of_partition(p, k, v, number(-1e6f)));
            }
            ends.at[p][0][0] = least;
            ends.at[p][0][1] = greatest;
        } else {
            outer_ends_of_two(p, ends);
        }
        if (kPartitions == 1) continue;
        const auto turns = hn::Gt(hn::Load(d_, turn_ + at(p)), number(0.5f));
        for (int c = 0; c < kChannels; ++c) {
            const AstcFloat first = ends.at[p][c][0], second = ends.at[p][c][1];
            ends.at[p][c][0] = hn::IfThenElse(turns, second, first);
            ends.at[p][c][1] = hn::IfThenElse(turns, first, second);
        }
    }
    return ends;
}

template <int kChannels, int kPartitions>
void AstcLine<kChannels, kPartitions>::outer_ends_of_two(int p, Ends& ends) const {
    AstcFloat n = hn::Zero(d_), sx = n, sy = n, sxx = n, sxy = n, syy = n;
    for (int k = 0; k < plan_.grid->texels; ++k) {
        AstcFloat x = texel(0, k), y = texel(kChannels - 1, k);
        if (kPartitions > 1) {
            const AstcFloat in = in_partition(p, k);
            n = hn::Add(n, in);
            sx = hn::Add(sx, hn::Mul(in, x));
            sy = hn::Add(sy, hn::Mul(in, y));
        } else {
            sx = hn::Add(sx, x);
            sy = hn::Add(sy, y);
        }
    }
    if (kPartitions == 1) n = number(static_cast<float>(plan_.grid->texels));
    const AstcFloat over = hn::Div(number(1.0f), hn::Max(n, number(1.0f)));
    const AstcFloat mx = hn::Mul(sx, over), my = hn::Mul(sy, over);
    for (int k = 0; k < plan_.grid->texels; ++k) {
        AstcFloat x = hn::Sub(texel(0, k), mx), y = hn::Sub(texel(kChannels - 1, k), my);
        if (kPartitions > 1) {
            const AstcFloat in = in_partition(p, k);
            x = hn::Mul(x, in);
            y = hn::Mul(y, in);
        }
        sxx = hn::Add(sxx, hn::Mul(x, x));
        sxy = hn::Add(sxy, hn::Mul(x, y));
        syy = hn::Add(syy, hn::Mul(y, y));
    }
    // The eigenvector of the greater eigenvalue: of two forms, that which does not vanish.
    const AstcFloat half = hn::Mul(hn::Sub(sxx, syy), number(0.5f));
    const AstcFloat root = hn::Sqrt(hn::Add(hn::Mul(half, half), hn::Mul(sxy, sxy)));
    const auto wide = hn::Ge(half, hn::Zero(d_));
    AstcFloat dx = hn::IfThenElse(wide, hn::Add(root, half), sxy);
    AstcFloat dy = hn::IfThenElse(wide, sxy, hn::Sub(root, half));
    const AstcFloat square = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
    const auto is_line = hn::Gt(square, number(1e-12f));
    const AstcFloat scale = hn::Div(number(1.0f), hn::Sqrt(hn::IfThenElse(is_line, square, number(1.0f))));
    dx = hn::IfThenElse(is_line, hn::Mul(dx, scale), number(1.0f));
    dy = hn::IfThenElseZero(is_line, hn::Mul(dy, scale));
    AstcFloat least = number(1e6f), greatest = number(-1e6f);
    for (int k = 0; k < plan_.grid->texels; ++k) {
        const AstcFloat along =
            hn::Add(hn::Mul(hn::Sub(texel(0, k), mx), dx), hn::Mul(hn::Sub(texel(kChannels - 1, k), my), dy));
        least = hn::Min(least, kPartitions == 1 ? along : of_partition(p, k, along, number(1e6f)));
        greatest = hn::Max(greatest, kPartitions == 1 ? along : of_partition(p, k, along, number(-1e6f)));
    }
    ends.at[p][0][0] = hn::Add(mx, hn::Mul(dx, least));
    ends.at[p][0][1] = hn::Add(mx, hn::Mul(dx, greatest));
    ends.at[p][kChannels - 1][0] = hn::Add(my, hn::Mul(dy, least));
    ends.at[p][kChannels - 1][1] = hn::Add(my, hn::Mul(dy, greatest));
}

// The endpoints to begin with. Where weights have few levels, the outermost texels may be better off between two levels
// than at the last one.
template <int kChannels, int kPartitions>
void AstcLine<kChannels, kPartitions>::make_starts(Ends* starts) {
    const Ends outer = outer_ends();
    starts[0] = starts[1] = outer;
    if (steps_.insets == 0) return;
    make_ideal(outer);
    for (int p = 0; p < partitions(); ++p) {
        AstcFloat best[2][2];
        try_starts(p, best);
        for (int n = 0; n < 2; ++n) {
            for (int c = 0; c < kChannels; ++c) {
                const AstcFloat range = hn::Sub(outer.at[p][c][1], outer.at[p][c][0]);
                starts[n].at[p][c][0] = hn::Add(outer.at[p][c][0], hn::Mul(range, best[n][0]));
                starts[n].at[p][c][1] = hn::Sub(outer.at[p][c][1], hn::Mul(range, best[n][1]));
            }
        }
    }
}

// Finds two pairs of shares of the range by which endpoints stand inside, those of least error after weights, as if
// their levels were evenly spaced, and then endpoints were fitted: what is explained is the squared covariance of
// levels and values over the variance of the levels.
template <int kChannels, int kPartitions>
void AstcLine<kChannels, kPartitions>::try_starts(int p, AstcFloat best[2][2]) const {
    constexpr float kInsets[] = {0.0f, 0.3f, 0.6f, -0.3f, 0.9f};
    const float top = static_cast<float>(kAstcRangeTable[plan_.mode.range].levels - 1);
    AstcFloat most[2] = {number(-1.0f), number(-1.0f)};
    for (int s = 0; s < 2; ++s) best[s][0] = best[s][1] = hn::Zero(d_);
    AstcFloat n = hn::Zero(d_), sum = n;
    for (int k = 0; k < plan_.grid->texels; ++k) {
        const AstcFloat in = kPartitions == 1 ? number(1.0f) : in_partition(p, k);
        n = hn::Add(n, in);
        sum = hn::Add(sum, hn::Mul(in, hn::Load(d_, ideal_ + at(k))));
    }
    const AstcFloat over_n = hn::Div(number(1.0f), hn::Max(n, number(1.0f)));
    const AstcFloat mean = hn::Mul(sum, over_n);
    for (int i = 0; i < steps_.insets; ++i) {
        for (int j = 0; j < steps_.insets; ++j) {
            const float first = kInsets[i] / top, second = kInsets[j] / top;
            const AstcFloat scale = number(top / (1.0f - first - second)), from = number(first);
            AstcFloat sq = hn::Zero(d_), sqq = sq, sqv = sq;
            for (int k = 0; k < plan_.grid->texels; ++k) {
                const AstcFloat v = hn::Load(d_, ideal_ + at(k));
                const AstcFloat place = hn::Add(hn::Mul(hn::Sub(v, from), scale), number(0.5f));
                const AstcFloat level = hn::Floor(hn::Min(hn::Max(place, hn::Zero(d_)), number(top + 0.5f)));
                const AstcFloat inside = kPartitions == 1 ? level : hn::Mul(level, in_partition(p, k));
                sq = hn::Add(sq, inside);
                sqq = hn::Add(sqq, hn::Mul(inside, level));
                sqv = hn::Add(sqv, hn::Mul(inside, hn::Sub(v, mean)));
            }
            const AstcFloat variance = hn::Sub(sqq, hn::Mul(hn::Mul(sq, sq), over_n));
            const AstcFloat explained = hn::Div(hn::Mul(sqv, sqv), hn::Max(variance, number(1e-3f)));
            const auto is_first = hn::Gt(explained, most[0]);
            const auto is_second = hn::Gt(explained, most[1]);
            const AstcFloat shares[2] = {number(first), number(second)};
            for (int e = 0; e < 2; ++e) {
                const AstcFloat other = hn::IfThenElse(is_second, shares[e], best[1][e]);
                best[1][e] = hn::IfThenElse(is_first, best[0][e], other);
                best[0][e] = hn::IfThenElse(is_first, shares[e], best[0][e]);
            }
            most[1] = hn::IfThenElse(is_first, most[0], hn::IfThenElse(is_second, explained, most[1]));
            most[0] = hn::IfThenElse(is_first, explained, most[0]);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif  // TEX_KERNELS_ASTC_STARTS_INL_H
