// SPDX-License-Identifier: Apache-2.0
// bc7_planes-inl.h: fits blocks in two planes, by the rules of BC7 or of another format. Include it after
// hwy/highway.h, once for each target.

#if defined(TEX_KERNELS_BC7_PLANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_BC7_PLANES_INL_H
#undef TEX_KERNELS_BC7_PLANES_INL_H
#else
#define TEX_KERNELS_BC7_PLANES_INL_H
#endif

#include <hwy/highway.h>

#include "kernels/bc7_fit.h"
#include "kernels/bc7_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A block in two planes: component 0 in the scalar plane; 1 and 2 in the colours.
template <class Rules>
class BlockPlanesFit {
public:
    HWY_INLINE BlockPlanesFit(const Bc7Kind& kind, Bc7Group& group) : kind_(kind), group_(group) {
        for (int k = 0; k < 16; ++k) {
            for (int c = 0; c < 3; ++c) unit_[k][c] = hn::Load(d_, group.value[k][c]);
            length_[k] = Bc7Number(kBc7Middle);
        }
        for (int c = 0; c < 3; ++c) {
            for (int e = 0; e < 2; ++e) ends_[c][e] = hn::Load(d_, group.ends[e][c]);
        }
    }

    HWY_NOINLINE void start();
    HWY_NOINLINE void improve(int rounds, bool pairs);
    HWY_NOINLINE void finish(bool indices);
    HWY_NOINLINE void refine(int rounds);

private:
    [[nodiscard]] int bits(int c) const { return c == 0 ? kind_.scalar_bits : kind_.bits; }
    [[nodiscard]] int levels(int c) const { return c == 0 ? kind_.scalar_levels : kind_.levels; }
    HWY_INLINE BlockRamp<Rules> ramp(const FloatVec ends[3][2], int c) const {
        return {ends[c][0], ends[c][1], bits(c), levels(c)};
    }
    HWY_NOINLINE FloatVec error_of(const FloatVec ends[3][2], bool measure);
    HWY_INLINE FloatVec judge(const FloatVec ends[3][2]) {
        return Rules::kPairs ? pairs_error(ends, nullptr) : error_of(ends, false);
    }
    HWY_NOINLINE FloatVec pairs_error(const FloatVec ends[3][2], FloatVec* pairs);
    HWY_NOINLINE void solve(const FloatVec pairs[16], FloatVec to[3][2]) const;
    HWY_NOINLINE void fit_alpha(const FloatVec weights[16]);

    const FloatTag d_ = {};
    const Bc7Kind& kind_;
    Bc7Group& group_;
    FloatVec unit_[16][3];
    FloatVec length_[16];  // of the decoded vectors, along the normals
    FloatVec ends_[3][2];
    FloatVec error_;
};

// Finds the endpoints of component 2. What matters is the direction alone, so its weight is small where it is near 1;
// there, a little weight draws lengths to 1.
template <class Rules>
void BlockPlanesFit<Rules>::start() {
    constexpr float kLittle = 2e-3f;
    const FloatVec zero = hn::Zero(d_), one = Bc7Number(1.0f), little = Bc7Number(kLittle);
    const BlockRamp<Rules> first = ramp(ends_, 0), second = ramp(ends_, 1);
    FloatVec aa = zero, ab = zero, bb = zero, av = zero, bv = zero;
    for (int k = 0; k < 16; ++k) {
        const FloatVec* const n = unit_[k];
        const FloatVec x = first.nearest(hn::Mul(length_[k], n[0]));
        const FloatVec weight = Rules::Weight(second.index(hn::Mul(length_[k], n[1])), second.levels);
        const FloatVec y = second.value(weight);
        const FloatVec b = hn::Mul(weight, Bc7Number(1.0f / 64.0f)), a = hn::Sub(one, b);
        const FloatVec matters = hn::Add(hn::Sub(one, hn::Mul(n[2], n[2])), little);
        const FloatVec wanted =
            hn::Mul(n[2], hn::Add(MulThenAdd(x, n[0], hn::Mul(y, n[1])), Bc7Number(kLittle * kBc7Middle)));
        aa = MulThenAdd(matters, hn::Mul(a, a), aa);
        ab = MulThenAdd(matters, hn::Mul(a, b), ab);
        bb = MulThenAdd(matters, hn::Mul(b, b), bb);
        av = MulThenAdd(a, wanted, av);
        bv = MulThenAdd(b, wanted, bv);
    }
    // Draws both endpoints together, for blocks that use one index.
    const FloatVec some = Bc7Number(1e-3f);
    aa = hn::Add(aa, some);
    bb = hn::Add(bb, some);
    ab = hn::Sub(ab, some);
    const FloatVec determinant = hn::Sub(hn::Mul(aa, bb), hn::Mul(ab, ab));
    const FloatVec inverse = hn::Div(one, hn::Max(determinant, Bc7Number(1e-12f)));
    const FloatVec e0 = hn::Mul(hn::Sub(hn::Mul(bb, av), hn::Mul(ab, bv)), inverse);
    const FloatVec e1 = hn::Mul(hn::Sub(hn::Mul(aa, bv), hn::Mul(ab, av)), inverse);
    ends_[2][0] = Rules::Round(hn::Add(e0, Bc7Number(kBc7Middle)), kind_.bits);
    ends_[2][1] = Rules::Round(hn::Add(e1, Bc7Number(kBc7Middle)), kind_.bits);
}

// The error with the nearest value of component 0 and the best colour for it. `measure`: updates length_.
template <class Rules>
FloatVec BlockPlanesFit<Rules>::error_of(const FloatVec ends[3][2], bool measure) {
    const BlockRamp<Rules> ramps[3] = {ramp(ends, 0), ramp(ends, 1), ramp(ends, 2)};
    const int levels = kind_.levels;
    FloatVec colour[8][2], squared[8];
    for (int j = 0; j < levels; ++j) {
        const FloatVec weight = Bc7Number(Rules::Weight(j, levels));
        for (int c = 0; c < 2; ++c) colour[j][c] = ramps[c + 1].value(weight);
        squared[j] = MulThenAdd(colour[j][0], colour[j][0], hn::Mul(colour[j][1], colour[j][1]));
    }
    FloatVec sum = hn::Zero(d_);
    for (int k = 0; k < 16; ++k) {
        const FloatVec* const n = unit_[k];
        const FloatVec x = ramps[0].nearest(hn::Mul(length_[k], n[0]));
        const FloatVec of_x = hn::Mul(x, n[0]), x_squared = hn::Mul(x, x);
        // The greatest cosine, as its signed square over the squared length.
        FloatVec best[3] = {x, colour[0][0], colour[0][1]};
        FloatVec above = hn::Zero(d_), below = hn::Zero(d_);
        for (int j = 0; j < levels; ++j) {
            const FloatVec along = hn::Add(of_x, MulThenAdd(colour[j][0], n[1], hn::Mul(colour[j][1], n[2])));
            const FloatVec cosine = hn::Mul(along, hn::Abs(along)), length = hn::Add(x_squared, squared[j]);
            const FloatMask better =
                hn::Gt(hn::Mul(cosine, j == 0 ? length : below), hn::Mul(j == 0 ? cosine : above, length));
            above = j == 0 ? cosine : hn::IfThenElse(better, cosine, above);
            below = j == 0 ? length : hn::IfThenElse(better, length, below);
            for (int c = 0; c < 2; ++c) best[c + 1] = hn::IfThenElse(better, colour[j][c], best[c + 1]);
        }
        if (measure) length_[k] = Bc7Dot(best, n);
        sum = hn::Add(sum, Bc7Error(best, n));
    }
    return sum;
}

// The error with the best pair of indices for each texel, and these if `pairs` is not null.
template <class Rules>
FloatVec BlockPlanesFit<Rules>::pairs_error(const FloatVec ends[3][2], FloatVec* pairs) {
    const int scalars = kind_.scalar_levels, colours = kind_.levels;
    const BlockRamp<Rules> ramps[3] = {ramp(ends, 0), ramp(ends, 1), ramp(ends, 2)};
    FloatVec scalar[8], palette[32][3];
    for (int s = 0; s < scalars; ++s) scalar[s] = ramps[0].value(Bc7Number(Rules::Weight(s, scalars)));
    for (int j = 0; j < colours; ++j) {
        FloatVec colour[2];
        for (int c = 0; c < 2; ++c) colour[c] = ramps[c + 1].value(Bc7Number(Rules::Weight(j, colours)));
        const FloatVec squared = MulThenAdd(colour[0], colour[0], hn::Mul(colour[1], colour[1]));
        for (int s = 0; s < scalars; ++s) {
            const FloatVec length = hn::Sqrt(MulThenAdd(scalar[s], scalar[s], squared));
            const FloatVec inverse = hn::Div(Bc7Number(1.0f), length);
            FloatVec* const vector = palette[scalars * j + s];
            vector[0] = hn::Mul(scalar[s], inverse);
            for (int c = 0; c < 2; ++c) vector[c + 1] = hn::Mul(colour[c], inverse);
        }
    }
    FloatVec sum = hn::Zero(d_);
    for (int k = 0; k < 16; ++k) {
        FloatVec least = Bc7Number(kBc7None), best = hn::Zero(d_);
        for (int pair = 0; pair < scalars * colours; ++pair) {
            FloatVec off[3];
            for (int c = 0; c < 3; ++c) off[c] = hn::Sub(palette[pair][c], unit_[k][c]);
            const FloatVec error = Bc7Dot(off, off);
            if (pairs != nullptr)
                best = hn::IfThenElse(hn::Lt(error, least), Bc7Number(static_cast<float>(pair)), best);
            least = hn::Min(least, error);
        }
        sum = hn::Add(sum, least);
        if (pairs != nullptr) pairs[k] = best;
    }
    return sum;
}

// The endpoints with the least error of direction for given pairs of indices: squared distances from the rays through
// the normals. A little weight of lengths keeps these as they are.
template <class Rules>
void BlockPlanesFit<Rules>::solve(const FloatVec pairs[16], FloatVec to[3][2]) const {
    constexpr float kLittle = 0.05f;
    const int scalars = kind_.scalar_levels;
    const FloatVec zero = hn::Zero(d_), one = Bc7Number(1.0f);
    FloatVec matrix[6][6], right[6];
    for (int i = 0; i < 6; ++i) {
        right[i] = zero;
        for (int j = 0; j < 6; ++j) matrix[i][j] = zero;
    }
    const BlockRamp<Rules> ramps[3] = {ramp(ends_, 0), ramp(ends_, 1), ramp(ends_, 2)};
    for (int k = 0; k < 16; ++k) {
        const FloatVec* const n = unit_[k];
        const FloatVec each = Bc7Number(1.0f / static_cast<float>(scalars));
        const FloatVec colour = hn::Floor(hn::Mul(hn::Add(pairs[k], Bc7Number(0.5f)), each));
        const FloatVec scalar = hn::Sub(pairs[k], hn::Mul(colour, Bc7Number(static_cast<float>(scalars))));
        const FloatVec weights[2] = {Rules::Weight(scalar, scalars), Rules::Weight(colour, kind_.levels)};
        FloatVec part[2][2], vector[3];
        for (int p = 0; p < 2; ++p) {
            part[p][1] = hn::Mul(weights[p], Bc7Number(1.0f / 64.0f));
            part[p][0] = hn::Sub(one, part[p][1]);
        }
        for (int c = 0; c < 3; ++c) vector[c] = ramps[c].value(weights[c == 0 ? 0 : 1]);
        const FloatVec length = hn::Max(Bc7Dot(vector, n), Bc7Number(16.0f));
        const FloatVec inverse = hn::Div(Bc7Number(kBc7Middle), length), matters = hn::Mul(inverse, inverse);
        const FloatVec wanted = hn::Mul(Bc7Number(kLittle), inverse);
        for (int c = 0; c < 3; ++c) {
            const FloatVec* const u = part[c == 0 ? 0 : 1];
            for (int i = 0; i < 2; ++i) right[2 * c + i] = MulThenAdd(hn::Mul(wanted, n[c]), u[i], right[2 * c + i]);
            for (int e = 0; e <= c; ++e) {
                const FloatVec* const v = part[e == 0 ? 0 : 1];
                FloatVec factor = hn::Mul(hn::Mul(n[c], n[e]), Bc7Number(kLittle - 1.0f));
                if (e == c) factor = hn::Add(factor, one);
                factor = hn::Mul(factor, matters);
                for (int i = 0; i < 2; ++i) {
                    const FloatVec its = hn::Mul(factor, u[i]);
                    for (int j = 0; j < 2; ++j)
                        matrix[2 * c + i][2 * e + j] = MulThenAdd(its, v[j], matrix[2 * c + i][2 * e + j]);
                }
            }
        }
    }
    // Draws both endpoints of a component together, for blocks that use one index.
    const FloatVec some = Bc7Number(1e-3f);
    for (int c = 0; c < 3; ++c) {
        for (int i = 0; i < 2; ++i) matrix[2 * c + i][2 * c + i] = hn::Add(matrix[2 * c + i][2 * c + i], some);
        matrix[2 * c + 1][2 * c] = hn::Sub(matrix[2 * c + 1][2 * c], some);
    }
    // L D L^T, of which the lower half is stored.
    FloatVec inverse[6];
    for (int j = 0; j < 6; ++j) {
        FloatVec pivot = matrix[j][j];
        for (int m = 0; m < j; ++m) pivot = hn::Sub(pivot, hn::Mul(hn::Mul(matrix[j][m], matrix[j][m]), matrix[m][m]));
        matrix[j][j] = hn::Max(pivot, Bc7Number(1e-6f));
        inverse[j] = hn::Div(one, matrix[j][j]);
        for (int i = j + 1; i < 6; ++i) {
            FloatVec entry = matrix[i][j];
            for (int m = 0; m < j; ++m)
                entry = hn::Sub(entry, hn::Mul(hn::Mul(matrix[i][m], matrix[j][m]), matrix[m][m]));
            matrix[i][j] = hn::Mul(entry, inverse[j]);
        }
    }
    for (int i = 0; i < 6; ++i) {
        for (int m = 0; m < i; ++m) right[i] = hn::Sub(right[i], hn::Mul(matrix[i][m], right[m]));
    }
    for (int i = 6; i-- > 0;) {
        right[i] = hn::Mul(right[i], inverse[i]);
        for (int m = i + 1; m < 6; ++m) right[i] = hn::Sub(right[i], hn::Mul(matrix[m][i], right[m]));
    }
    for (int c = 0; c < 3; ++c) {
        for (int e = 0; e < 2; ++e) {
            const FloatVec code = MulThenAdd(right[2 * c + e], Bc7Number(kBc7Middle), Bc7Number(kBc7Middle));
            to[c][e] = Rules::Round(code, bits(c));
        }
    }
}

// Endpoints for the present indices, and indices for these, as long as errors fall.
template <class Rules>
void BlockPlanesFit<Rules>::refine(int rounds) {
    FloatVec best[3][2], pairs[16];
    for (int k = 0; k < 6; ++k) best[k / 2][k % 2] = ends_[k / 2][k % 2];
    FloatVec least = Bc7Number(kBc7None);
    for (int r = 0; r <= rounds; ++r) {
        const FloatVec error = pairs_error(ends_, pairs);
        const FloatMask better = hn::Lt(error, least);
        least = hn::Min(error, least);
        for (int k = 0; k < 6; ++k)
            best[k / 2][k % 2] = hn::IfThenElse(better, ends_[k / 2][k % 2], best[k / 2][k % 2]);
        if (r < rounds) solve(pairs, ends_);
    }
    for (int k = 0; k < 6; ++k) ends_[k / 2][k % 2] = best[k / 2][k % 2];
}

template <class Rules>
void BlockPlanesFit<Rules>::improve(int rounds, bool pairs) {
    // A lane that has come to rest stays as it is, whatever the others do.
    FloatMask moves = hn::Ge(Bc7Number(1.0f), hn::Zero(d_));
    for (int r = 0; r < rounds; ++r) {
        if (!Rules::kPairs) error_of(ends_, true);
        error_ = judge(ends_);
        const FloatVec before = error_;
        const float stride = Rules::Stride(kind_.bits, pairs ? r : kBc7LateRound);
        for (int c = 0; c < 3; ++c) {
            for (int move = 0; move < (pairs ? kBc7Moves : 4); ++move) {
                FloatVec to[3][2];
                for (int k = 0; k < 6; ++k) to[k / 2][k % 2] = ends_[k / 2][k % 2];
                for (int e = 0; e < 2; ++e) {
                    const FloatVec by = Bc7Number(stride * kBc7MoveTable[move][e]);
                    to[c][e] = Bc7Clamp(hn::Add(to[c][e], by), Rules::Top(bits(c)));
                }
                const FloatVec error = judge(to);
                const FloatMask better = hn::And(moves, hn::Lt(error, error_));
                for (int e = 0; e < 2; ++e) ends_[c][e] = hn::IfThenElse(better, to[c][e], ends_[c][e]);
                error_ = hn::IfThenElse(better, error, error_);
            }
        }
        if (stride == 1.0f) moves = hn::And(moves, hn::Lt(error_, before));
        if (hn::AllFalse(d_, moves)) break;
    }
}

// The endpoints of alpha, which lies on the line of the colours.
template <class Rules>
void BlockPlanesFit<Rules>::fit_alpha(const FloatVec weights[16]) {
    const FloatVec zero = hn::Zero(d_), one = Bc7Number(1.0f);
    FloatVec aa = zero, ab = zero, bb = zero, av = zero, bv = zero;
    for (int k = 0; k < 16; ++k) {
        const FloatVec b = hn::Mul(weights[k], Bc7Number(1.0f / 64.0f)), a = hn::Sub(one, b);
        const FloatVec wanted = hn::Sub(hn::Load(d_, group_.value[k][3]), Bc7Number(kBc7Middle));
        aa = MulThenAdd(a, a, aa);
        ab = MulThenAdd(a, b, ab);
        bb = MulThenAdd(b, b, bb);
        av = MulThenAdd(a, wanted, av);
        bv = MulThenAdd(b, wanted, bv);
    }
    const FloatVec some = Bc7Number(1e-3f);
    aa = hn::Add(aa, some);
    bb = hn::Add(bb, some);
    ab = hn::Sub(ab, some);
    const FloatVec inverse = hn::Div(one, hn::Max(hn::Sub(hn::Mul(aa, bb), hn::Mul(ab, ab)), Bc7Number(1e-12f)));
    const FloatVec middle = Bc7Number(kBc7Middle);
    const FloatVec e0 = hn::Mul(hn::Sub(hn::Mul(bb, av), hn::Mul(ab, bv)), inverse);
    const FloatVec e1 = hn::Mul(hn::Sub(hn::Mul(aa, bv), hn::Mul(ab, av)), inverse);
    const FloatVec ends[2] = {Rules::Round(hn::Add(e0, middle), kind_.bits),
                              Rules::Round(hn::Add(e1, middle), kind_.bits)};
    const BlockRamp<Rules> ramp(ends[0], ends[1], kind_.bits, kind_.levels);
    for (int k = 0; k < 16; ++k) {
        const FloatVec wanted = hn::Sub(hn::Load(d_, group_.value[k][3]), middle);
        error_ = hn::Add(error_, Bc7AlphaError(ramp.value(weights[k]), wanted));
    }
    for (int e = 0; e < 2; ++e) hn::Store(ends[e], d_, group_.ends[e][3]);
}

// Takes the best pair of indices for each texel.
template <class Rules>
void BlockPlanesFit<Rules>::finish(bool indices) {
    const int scalars = kind_.scalar_levels, colours = kind_.levels;
    const BlockRamp<Rules> ramps[3] = {ramp(ends_, 0), ramp(ends_, 1), ramp(ends_, 2)};
    FloatVec scalar[8], colour[8][2], inverse[32], first[32];
    for (int s = 0; s < scalars; ++s) scalar[s] = ramps[0].value(Bc7Number(Rules::Weight(s, scalars)));
    for (int j = 0; j < colours; ++j) {
        for (int c = 0; c < 2; ++c) colour[j][c] = ramps[c + 1].value(Bc7Number(Rules::Weight(j, colours)));
        const FloatVec squared = MulThenAdd(colour[j][0], colour[j][0], hn::Mul(colour[j][1], colour[j][1]));
        for (int s = 0; s < scalars; ++s) {
            const FloatVec length = hn::Sqrt(MulThenAdd(scalar[s], scalar[s], squared));
            inverse[scalars * j + s] = hn::Div(Bc7Number(1.0f), length);
            first[scalars * j + s] = hn::Mul(scalar[s], inverse[scalars * j + s]);
        }
    }
    FloatVec weights[16];
    error_ = hn::Zero(d_);
    for (int k = 0; k < 16; ++k) {
        const FloatVec* const n = unit_[k];
        FloatVec best = Bc7Number(-2.0f), pair = hn::Zero(d_);
        for (int j = 0; j < colours; ++j) {
            const FloatVec along = MulThenAdd(colour[j][0], n[1], hn::Mul(colour[j][1], n[2]));
            for (int s = 0; s < scalars; ++s) {
                const int at = scalars * j + s;
                const FloatVec cosine = MulThenAdd(first[at], n[0], hn::Mul(inverse[at], along));
                const FloatMask better = hn::Gt(cosine, best);
                best = hn::Max(cosine, best);
                pair = hn::IfThenElse(better, Bc7Number(static_cast<float>(at)), pair);
            }
        }
        const FloatVec each = Bc7Number(1.0f / static_cast<float>(scalars));
        const FloatVec of_colour = hn::Floor(hn::Mul(hn::Add(pair, Bc7Number(0.5f)), each));
        const FloatVec of_scalar = hn::Sub(pair, hn::Mul(of_colour, Bc7Number(static_cast<float>(scalars))));
        weights[k] = Rules::Weight(of_colour, colours);
        const FloatVec vector[3] = {ramps[0].value(Rules::Weight(of_scalar, scalars)), ramps[1].value(weights[k]),
                                    ramps[2].value(weights[k])};
        error_ = hn::Add(error_, Bc7Error(vector, n));
        if (!indices) continue;
        hn::Store(of_colour, d_, group_.color[k]);
        hn::Store(of_scalar, d_, group_.scalar[k]);
    }
    for (int e = 0; e < 2; ++e) {
        for (int c = 0; c < 3; ++c) hn::Store(ends_[c][e], d_, group_.ends[e][c]);
        hn::Store(Bc7Number(Rules::Top(kind_.bits)), d_, group_.ends[e][3]);
    }
    if (group_.has_alpha) fit_alpha(weights);
    hn::Store(error_, d_, group_.error);
}

template <class Rules>
HWY_INLINE void FitPlanes(const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group) {
    BlockPlanesFit<Rules> fit(kind, group);
    if (steps.starts) fit.start();
    if (Rules::kPairs && steps.solves > 0) fit.refine(steps.solves);
    fit.improve(steps.rounds, steps.pairs);
    fit.finish(steps.indices);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif  // once for each target
