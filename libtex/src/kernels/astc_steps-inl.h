// SPDX-License-Identifier: Apache-2.0
// astc_steps-inl.h: the steps of AstcLine. Include it after hwy/highway.h, once for each target.

#if defined(TEX_KERNELS_ASTC_STEPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_ASTC_STEPS_INL_H
#undef TEX_KERNELS_ASTC_STEPS_INL_H
#else
#define TEX_KERNELS_ASTC_STEPS_INL_H
#endif

#include "kernels/astc_starts-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

// The least squared distance of endpoints (of 0 to 255) that counts as one.
inline constexpr float kAstcLeastSquare = 1e-4f;

// The weights that put texels nearest to themselves on the lines of their partitions.
template <int kChannels, int kPartitions>
void AstcLine<kChannels, kPartitions>::make_ideal(const Ends& ends) {
    AstcFloat step[kPartitions][kChannels], square[kPartitions];
    for (int p = 0; p == 0 || p < partitions(); ++p) {  // GCC must see that there is one
        AstcFloat sum = hn::Zero(d_);
        for (int c = 0; c < kChannels; ++c) {
            step[p][c] = hn::Sub(ends.at[p][c][1], ends.at[p][c][0]);
            sum = hn::Add(sum, hn::Mul(step[p][c], step[p][c]));
        }
        const auto is_line = hn::Gt(sum, number(kAstcLeastSquare));
        const AstcFloat over = hn::Div(number(1.0f), hn::IfThenElse(is_line, sum, number(1.0f)));
        for (int c = 0; c < kChannels; ++c) step[p][c] = hn::IfThenElseZero(is_line, hn::Mul(step[p][c], over));
        square[p] = sum;
    }
    for (int k = 0; k < plan_.grid->texels; ++k) {
        AstcFloat ideal = hn::Zero(d_);
        for (int c = 0; c < kChannels; ++c) {
            const AstcFloat from = hn::Sub(texel(c, k), of_texel(k, [&](int p) { return ends.at[p][c][0]; }));
            ideal = hn::Add(ideal, hn::Mul(from, of_texel(k, [&](int p) { return step[p][c]; })));
        }
        hn::Store(ideal, d_, ideal_ + at(k));
        if (kPartitions > 1) hn::Store(of_texel(k, [&](int p) { return square[p]; }), d_, square_ + at(k));
    }
}

template <int kChannels, int kPartitions>
void AstcLine<kChannels, kPartitions>::make_weights(const Ends& ends, const float* near) {
    make_ideal(ends);
    if (!plan_.grid->is_full) return round_grid(near);
    for (int k = 0; k < plan_.grid->texels; ++k) {
        const AstcFloat halves = hn::Mul(hn::Load(d_, ideal_ + at(k)), number(128.0f));
        const AstcFloat weight =
            look_up(plan_.weights->nearest, hn::Min(hn::Max(halves, hn::Zero(d_)), number(128.0f)));
        hn::Store(weight, d_, weight_ + at(k));
        hn::Store(weight, d_, grid_ + at(k));
    }
}

// Changes each weight of the grid to that which leaves least, given the others: first as a real number, then as one
// that can be stored. Weights that are near others begin with those and are rounded at once. `ideal_` becomes what is
// left.
template <int kChannels, int kPartitions>
void AstcLine<kChannels, kPartitions>::round_grid(const float* near) {
    for (int w = 0; w < plan_.grid->weights; ++w) {
        if (near != nullptr) {
            hn::Store(hn::Mul(hn::Load(d_, near + at(w)), number(1.0f / 64.0f)), d_, grid_ + at(w));
            continue;
        }
        AstcFloat sum = hn::Zero(d_);
        for (int s = plan_.grid->begin[w]; s < plan_.grid->begin[w + 1]; ++s) {
            sum = hn::Add(sum, hn::Mul(number(plan_.grid->shares[s].share),
                                       hn::Load(d_, ideal_ + at(plan_.grid->shares[s].texel))));
        }
        hn::Store(hn::Mul(sum, number(plan_.grid->over_sum[w])), d_, grid_ + at(w));
    }
    for (int k = 0; k < plan_.grid->texels; ++k) {
        AstcFloat left = hn::Load(d_, ideal_ + at(k));
        for (int s = 0; s < 4; ++s) {
            const AstcFloat weight = hn::Load(d_, grid_ + at(plan_.grid->around[k][s]));
            left = hn::Sub(left, hn::Mul(number(plan_.grid->infill[k][s] * (1.0f / 16.0f)), weight));
        }
        hn::Store(left, d_, ideal_ + at(k));
    }
    for (int sweep = near != nullptr ? steps_.sweeps : 0; sweep < 2 * steps_.sweeps; ++sweep) {
        const bool rounds = sweep >= steps_.sweeps;
        for (int n = 0; n < plan_.grid->weights; ++n) change_weight(plan_.grid->order[n], rounds);
    }
    for (int w = 0; w < plan_.grid->weights; ++w) {
        hn::Store(hn::Mul(hn::Load(d_, grid_ + at(w)), number(64.0f)), d_, grid_ + at(w));
    }
    for (int k = 0; k < plan_.grid->texels; ++k) {
        AstcFloat sum = number(8.0f);
        for (int s = 0; s < 4; ++s) {
            const AstcFloat weight = hn::Load(d_, grid_ + at(plan_.grid->around[k][s]));
            sum = hn::Add(sum, hn::Mul(number(plan_.grid->infill[k][s]), weight));
        }
        hn::Store(hn::Floor(hn::Mul(sum, number(1.0f / 16.0f))), d_, weight_ + at(k));
    }
}

template <int kChannels, int kPartitions>
HWY_INLINE void AstcLine<kChannels, kPartitions>::change_weight(int w, bool rounds) {
    const AstcShare* const begin = plan_.grid->shares + plan_.grid->begin[w];
    const AstcShare* const end = plan_.grid->shares + plan_.grid->begin[w + 1];
    AstcFloat sum = hn::Zero(d_), squares = hn::Zero(d_);
    for (const AstcShare* s = begin; s < end; ++s) {
        AstcFloat share = number(s->share);
        const AstcFloat left = hn::Load(d_, ideal_ + at(s->texel));
        if (kPartitions > 1) {
            const AstcFloat weighted = hn::Mul(share, hn::Load(d_, square_ + at(s->texel)));
            squares = hn::Add(squares, hn::Mul(share, weighted));
            share = weighted;
        }
        sum = hn::Add(sum, hn::Mul(share, left));
    }
    const AstcFloat old = hn::Load(d_, grid_ + at(w));
    AstcFloat best;
    if (kPartitions > 1) {
        best = hn::Add(old, hn::Div(sum, hn::Max(squares, number(kAstcLeastSquare))));
    } else {
        best = hn::Add(old, hn::Mul(sum, number(plan_.grid->over_squares[w])));
    }
    if (rounds) {
        const AstcFloat place = hn::Mul(hn::Min(hn::Max(best, hn::Zero(d_)), number(1.0f)), number(128.0f));
        best = hn::Mul(look_up(plan_.weights->nearest, place), number(1.0f / 64.0f));
    }
    hn::Store(best, d_, grid_ + at(w));
    const AstcFloat change = hn::Sub(best, old);
    for (const AstcShare* s = begin; s < end; ++s) {
        float* const left = ideal_ + at(s->texel);
        hn::Store(hn::Sub(hn::Load(d_, left), hn::Mul(number(s->share), change)), d_, left);
    }
}

// The endpoints of least squares for the weights of texels, rounded to those that can be stored.
template <int kChannels, int kPartitions>
void AstcLine<kChannels, kPartitions>::make_ends(Ends& ends) const {
    for (int p = 0; p < partitions(); ++p) {
        AstcFloat n = hn::Zero(d_), sw = n, sww = n, sv[kChannels], swv[kChannels];
        for (int c = 0; c < kChannels; ++c) sv[c] = swv[c] = n;
        for (int k = 0; k < plan_.grid->texels; ++k) {
            const AstcFloat weight = hn::Load(d_, weight_ + at(k));
            AstcFloat in = number(1.0f), inside_weight = weight;
            if (kPartitions > 1) {
                in = in_partition(p, k);
                inside_weight = hn::Mul(in, weight);
                n = hn::Add(n, in);
            }
            sw = hn::Add(sw, inside_weight);
            sww = hn::Add(sww, hn::Mul(inside_weight, weight));
            for (int c = 0; c < kChannels; ++c) {
                const AstcFloat value = texel(c, k);
                sv[c] = hn::Add(sv[c], kPartitions > 1 ? hn::Mul(in, value) : value);
                swv[c] = hn::Add(swv[c], hn::Mul(inside_weight, value));
            }
        }
        if (kPartitions == 1) n = number(static_cast<float>(plan_.grid->texels));
        sw = hn::Mul(sw, number(1.0f / 64.0f));
        sww = hn::Mul(sww, number(1.0f / 4096.0f));
        const AstcFloat det = hn::Sub(hn::Mul(n, sww), hn::Mul(sw, sw));
        const auto is_line = hn::Gt(det, number(1e-3f));
        const AstcFloat over_det = hn::Div(number(1.0f), hn::IfThenElse(is_line, det, number(1.0f)));
        const AstcFloat over_n = hn::Div(number(1.0f), hn::Max(n, number(1.0f)));
        for (int c = 0; c < kChannels; ++c) {
            swv[c] = hn::Mul(swv[c], number(1.0f / 64.0f));
            const AstcFloat slope = hn::Mul(hn::Sub(hn::Mul(n, swv[c]), hn::Mul(sw, sv[c])), over_det);
            const AstcFloat e0 = hn::Mul(hn::Sub(sv[c], hn::Mul(slope, sw)), over_n);
            const AstcFloat mean = hn::Mul(sv[c], over_n);
            const Sums sums{n, sw, sww, sv[c], swv[c]};
            AstcFloat* const end = ends.at[p][c];
            const AstcFloat up = number(kAstcRoundedDown);
            end[0] = hn::Mul(up, hn::IfThenElse(is_line, e0, mean));
            end[1] = hn::Mul(up, hn::IfThenElse(is_line, hn::Add(e0, slope), mean));
            if (steps_.near_ends) {
                nearest_pair(p, sums, end);
            } else {
                end[0] = first_end(p, end[0], 0);
                end[1] = second_end(p, end[0], end[1], 0);
            }
        }
    }
}

// The endpoint that can be stored and is nearest, or the one below it (way -1) or above it (1).
inline HWY_NOINLINE AstcFloat AstcRounding::first_end(int p, AstcFloat end, int way) const {
    const AstcFloat code = hn::Min(hn::Max(end, hn::Zero(d_)), number(255.0f));
    AstcFloat direct = code, base = code;
    if (use_[p] != kOffsets) {
        direct = look_up(plan_.colors->nearest, code);
        if (way != 0) direct = look_up(way < 0 ? plan_.colors->lower : plan_.colors->upper, direct);
    }
    if (use_[p] != kNoOffsets) {
        base = look_up(plan_.offsets->nearest, code);
        if (way != 0) base = look_up(way < 0 ? plan_.offsets->lower : plan_.offsets->upper, base);
    }
    return by_use(p, base, direct);
}

// Rounds the other endpoint. An offset depends on the base.
inline HWY_NOINLINE AstcFloat AstcRounding::second_end(int p, AstcFloat first, AstcFloat end, int way) const {
    const AstcFloat code = hn::Min(hn::Max(end, hn::Zero(d_)), number(255.0f));
    AstcFloat direct = code, sum = code;
    if (use_[p] != kOffsets) {
        direct = look_up(plan_.colors->nearest, code);
        if (way != 0) direct = look_up(way < 0 ? plan_.colors->lower : plan_.colors->upper, direct);
    }
    if (use_[p] != kNoOffsets) {
        const AstcFloat zero = hn::IfThenElse(hn::Gt(first, number(127.5f)), number(96.0f), number(32.0f));
        const AstcFloat most = hn::Min(hn::Max(hn::Sub(code, first), number(-32.0f)), number(31.0f));
        AstcFloat offset = look_up(plan_.offsets->nearest_offset, hn::Add(most, zero));
        if (way != 0) {
            const float* const next = way < 0 ? plan_.offsets->lower_offset : plan_.offsets->upper_offset;
            offset = look_up(next, hn::Add(offset, zero));
        }
        sum = hn::Min(hn::Max(hn::Add(first, offset), hn::Zero(d_)), number(255.0f));
    }
    return by_use(p, sum, direct);
}

// Takes the pair with the least squared error: the nearest one, or one of the eight around it.
inline HWY_NOINLINE void AstcRounding::nearest_pair(int p, const Sums& s, AstcFloat end[2]) const {
    // The error but for a constant: a e0^2 + 2 b e0 e1 + c e1^2 - 2 (x e0 + y e1).
    const AstcFloat b = hn::Sub(s.w, s.ww), c = s.ww;
    const AstcFloat a = hn::Sub(hn::Sub(s.n, s.w), b);
    const AstcFloat y = hn::Add(s.wv, s.wv), x = hn::Sub(hn::Add(s.v, s.v), y);
    const AstcFloat b2 = hn::Add(b, b);
    const AstcFloat asked[2] = {end[0], end[1]};
    AstcFloat least = number(1e30f);
    for (int i = -1; i <= 1; ++i) {
        const AstcFloat first = first_end(p, asked[0], i);
        const AstcFloat e0 = hn::Mul(first, number(1.0f / kAstcRoundedDown));
        for (int j = -1; j <= 1; ++j) {
            const AstcFloat second = second_end(p, first, asked[1], j);
            const AstcFloat e1 = hn::Mul(second, number(1.0f / kAstcRoundedDown));
            const AstcFloat of_first = hn::Mul(e0, hn::Sub(hn::Add(hn::Mul(a, e0), hn::Mul(b2, e1)), x));
            const AstcFloat error = hn::Add(of_first, hn::Mul(e1, hn::Sub(hn::Mul(c, e1), y)));
            const auto better = hn::Lt(error, least);
            least = hn::IfThenElse(better, error, least);
            end[0] = hn::IfThenElse(better, first, end[0]);
            end[1] = hn::IfThenElse(better, second, end[1]);
        }
    }
}

// The squared error of the texels as they are decoded.
template <int kChannels, int kPartitions>
AstcFloat AstcLine<kChannels, kPartitions>::error_of(const Ends& ends) const {
    const hn::RebindToUnsigned<FloatTag> du;
    AstcFloat sum = hn::Zero(d_);
    AstcFloat begin[kPartitions][kChannels], step[kPartitions][kChannels];
    for (int p = 0; p == 0 || p < partitions(); ++p) {
        for (int c = 0; c < kChannels; ++c) {
            begin[p][c] = hn::Add(hn::Mul(ends.at[p][c][0], number(257.0f)), number(0.5f));
            step[p][c] = hn::Mul(hn::Sub(ends.at[p][c][1], ends.at[p][c][0]), number(257.0f / 64.0f));
        }
    }
    for (int k = 0; k < plan_.grid->texels; ++k) {
        const AstcFloat weight = hn::Load(d_, weight_ + at(k));
        for (int c = 0; c < kChannels; ++c) {
            // Exact: all are multiples of 1/64 below 2^17.
            const AstcFloat sixty_fourths = hn::Add(of_texel(k, [&](int p) { return begin[p][c]; }),
                                                    hn::Mul(of_texel(k, [&](int p) { return step[p][c]; }), weight));
            const AstcFloat code = hn::Floor(sixty_fourths);
            const AstcFloat half = hn::BitCast(d_, hn::And(hn::BitCast(du, code), hn::Set(du, 0xffffe000u)));
            const AstcFloat value = hn::IfThenElse(hn::Eq(code, number(65535.0f)), number(65536.0f), half);
            const AstcFloat off = hn::Sub(hn::Mul(value, number(1.0f / 257.0f)), texel(c, k));
            sum = hn::Add(sum, hn::Mul(off, off));
        }
    }
    return sum;
}

template <int kChannels, int kPartitions>
bool AstcLine<kChannels, kPartitions>::keep(const Ends& ends) {
    const AstcFloat error = error_of(ends);
    const auto better = hn::Lt(error, best_.error);
    if (hn::AllFalse(d_, better)) return false;
    best_.error = hn::IfThenElse(better, error, best_.error);
    for (int p = 0; p < partitions(); ++p) {
        for (int c = 0; c < kChannels; ++c) {
            for (int e = 0; e < 2; ++e)
                best_.ends.at[p][c][e] = hn::IfThenElse(better, ends.at[p][c][e], best_.ends.at[p][c][e]);
        }
    }
    for (int w = 0; w < plan_.grid->weights; ++w) {
        float* const to = best_.weights + at(w);
        hn::Store(hn::IfThenElse(better, hn::Load(d_, grid_ + at(w)), hn::Load(d_, to)), d_, to);
    }
    return true;
}

// Tries the endpoints beside the best ones, with weights for them. Says whether any block is better for it.
template <int kChannels, int kPartitions>
bool AstcLine<kChannels, kPartitions>::polish() {
    bool is_better = false;
    for (int p = 0; p < partitions(); ++p) {
        for (int c = 0; c < kChannels; ++c) {
            for (int way = 0; way < 9; ++way) {
                if (way == 4) continue;
                Ends ends = best_.ends;
                AstcFloat* const end = ends.at[p][c];
                end[0] = first_end(p, end[0], way / 3 - 1);
                end[1] = second_end(p, end[0], end[1], way % 3 - 1);
                make_weights(ends, best_.weights);
                is_better = keep(ends) || is_better;
            }
        }
    }
    return is_better;
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif  // TEX_KERNELS_ASTC_STEPS_INL_H
