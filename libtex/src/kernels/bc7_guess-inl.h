// SPDX-License-Identifier: Apache-2.0
// bc7_guess-inl.h: ramps of single channels, and what lines would leave, before blocks are fitted. Include it after
// hwy/highway.h, once for each target.

#if defined(TEX_KERNELS_BC7_GUESS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_BC7_GUESS_INL_H
#undef TEX_KERNELS_BC7_GUESS_INL_H
#else
#define TEX_KERNELS_BC7_GUESS_INL_H
#endif

#include <hwy/highway.h>

#include "kernels/bc7_fit.h"
#include "kernels/bc7_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// One channel of a block, as codes from 0 to 255 relative to the middle.
struct BlockChannel {
    FloatVec value[16];
    FloatVec ends[2];  // of a ramp, before rounding
};

// Puts the endpoints where the squared error is least for the indices that they give now.
HWY_INLINE void ImproveRamp(BlockChannel& channel, int levels) {
    const FloatTag d;
    const float last = static_cast<float>(levels - 1);
    const FloatVec range = hn::Sub(channel.ends[1], channel.ends[0]);
    const FloatVec inverse = hn::Div(Bc7Number(last), hn::Max(range, Bc7Number(1e-3f)));
    const FloatVec start = hn::Sub(Bc7Number(0.5f), hn::Mul(channel.ends[0], inverse));
    FloatVec k1 = hn::Zero(d), k2 = k1, v1 = k1, kv = k1;
    for (const FloatVec v : channel.value) {
        const FloatVec k = Bc7Index(MulThenAdd(v, inverse, start), levels);
        k1 = hn::Add(k1, k);
        k2 = MulThenAdd(k, k, k2);
        v1 = hn::Add(v1, v);
        kv = MulThenAdd(k, v, kv);
    }
    const FloatVec count = Bc7Number(16.0f);
    const FloatVec determinant = hn::Sub(hn::Mul(count, k2), hn::Mul(k1, k1));
    const FloatMask is_line = hn::Gt(determinant, Bc7Number(0.5f));
    const FloatVec spread = hn::Sub(hn::Mul(count, kv), hn::Mul(k1, v1));
    const FloatVec slope = hn::Div(spread, hn::IfThenElse(is_line, determinant, Bc7Number(1.0f)));
    const FloatVec first = hn::Mul(hn::Sub(v1, hn::Mul(slope, k1)), Bc7Number(1.0f / 16.0f));
    channel.ends[0] = hn::IfThenElse(is_line, first, channel.ends[0]);
    channel.ends[1] = hn::IfThenElse(is_line, MulThenAdd(slope, Bc7Number(last), first), channel.ends[1]);
}

template <class Rules>
HWY_INLINE FloatVec RampError(const BlockChannel& channel, FloatVec end0, FloatVec end1, int bits, int levels) {
    const BlockRamp<Rules> ramp(end0, end1, bits, levels);
    FloatVec sum = hn::Zero(FloatTag());
    for (const FloatVec v : channel.value) {
        const FloatVec off = hn::Sub(ramp.nearest(v), v);
        sum = MulThenAdd(off, off, sum);
    }
    return hn::Mul(sum, Bc7Number(1.0f / (kBc7Middle * kBc7Middle)));
}

struct RampFit {
    FloatVec ends[2];
    FloatVec error;
};

// The best stored endpoints around those of the channel.
template <class Rules>
HWY_NOINLINE RampFit FitRamp(const BlockChannel& channel, int bits, int levels, int rounds) {
    static constexpr float kMoves[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, -1}, {-1, 1}, {1, 1}, {-1, -1}};
    const FloatVec middle = Bc7Number(kBc7Middle);
    RampFit fit;
    for (int e = 0; e < 2; ++e) fit.ends[e] = Rules::Round(hn::Add(channel.ends[e], middle), bits);
    fit.error = RampError<Rules>(channel, fit.ends[0], fit.ends[1], bits, levels);
    // 0 rounds: only single moves; endpoints of 7 and 8 bits need none.
    const int moves = rounds == 0 ? 4 : 8;
    for (int r = 0; r < (bits > 6 ? rounds : rounds + 1); ++r) {
        const FloatVec from[2] = {fit.ends[0], fit.ends[1]};
        for (int m = 0; m < moves; ++m) {
            FloatVec to[2];
            for (int e = 0; e < 2; ++e) to[e] = Bc7Clamp(hn::Add(from[e], Bc7Number(kMoves[m][e])), Rules::Top(bits));
            const FloatVec error = RampError<Rules>(channel, to[0], to[1], bits, levels);
            const FloatMask better = hn::Lt(error, fit.error);
            for (int e = 0; e < 2; ++e) fit.ends[e] = hn::IfThenElse(better, to[e], fit.ends[e]);
            fit.error = hn::Min(error, fit.error);
        }
    }
    return fit;
}

// The endpoints of a channel for so many levels.
HWY_INLINE void StartRamp(BlockChannel& channel, FloatVec least, FloatVec greatest, int levels) {
    channel.ends[0] = least;
    channel.ends[1] = greatest;
    ImproveRamp(channel, levels);
    ImproveRamp(channel, levels);
}

// Sums over texels in the plane across the mean: of p, q, p p, p q, q q.
struct BlockMoments {
    FloatVec sum[5];

    HWY_INLINE void add(const BlockMoments& more) {
        for (int s = 0; s < 5; ++s) sum[s] = hn::Add(sum[s], more.sum[s]);
    }
    HWY_INLINE void subtract(const BlockMoments& less) {
        for (int s = 0; s < 5; ++s) sum[s] = hn::Sub(sum[s], less.sum[s]);
    }
};

// The sums of all sets of texels of each row: bit i of a number stands for texel i.
struct BlockRowMoments {
    BlockMoments of[4][16];

    HWY_INLINE BlockMoments texels(unsigned mask) const {
        BlockMoments sum = of[0][mask & 15];
        for (int row = 1; row < 4; ++row) sum.add(of[row][mask >> (4 * row) & 15]);
        return sum;
    }
};

// What lines leave: across them everything, along them what the steps between levels leave.
struct BlockResidue {
    FloatVec across, along;
};
HWY_INLINE BlockResidue ResidueOf(const BlockMoments& moments, int count) {
    const FloatVec part = Bc7Number(1.0f / static_cast<float>(count));
    const FloatVec* const s = moments.sum;
    const FloatVec pp = hn::Sub(s[2], hn::Mul(hn::Mul(s[0], s[0]), part));
    const FloatVec pq = hn::Sub(s[3], hn::Mul(hn::Mul(s[0], s[1]), part));
    const FloatVec qq = hn::Sub(s[4], hn::Mul(hn::Mul(s[1], s[1]), part));
    const FloatVec half = Bc7Number(0.5f);
    const FloatVec mean = hn::Mul(hn::Add(pp, qq), half), off = hn::Mul(hn::Sub(pp, qq), half);
    const FloatVec root = hn::Sqrt(MulThenAdd(off, off, hn::Mul(pq, pq)));
    return {hn::Max(hn::Sub(mean, root), hn::Zero(FloatTag())), hn::Add(mean, root)};
}

// Keeps the least errors in order.
template <class Guesses>
HWY_INLINE void KeepPart(FloatVec error, FloatVec number, int most, Guesses& guesses) {
    const FloatTag d;
    if (hn::AllFalse(d, hn::Lt(error, hn::Load(d, guesses.part_error[most - 1])))) return;
    for (int k = 0; k < most; ++k) {
        const FloatVec kept = hn::Load(d, guesses.part_error[k]), kept_number = hn::Load(d, guesses.part[k]);
        const FloatMask better = hn::Lt(error, kept);
        hn::Store(hn::IfThenElse(better, error, kept), d, guesses.part_error[k]);
        hn::Store(hn::IfThenElse(better, number, kept_number), d, guesses.part[k]);
        error = hn::IfThenElse(better, kept, error);
        number = hn::IfThenElse(better, kept_number, number);
    }
}

// The moments of a block, in the plane across its mean, whose sum is `sum`.
HWY_INLINE void FindMoments(const Bc7Group& group, const FloatVec sum[3], BlockRowMoments& rows) {
    const FloatVec zero = hn::Zero(FloatTag()), one = Bc7Number(1.0f);
    const FloatTag d;
    FloatVec mean[3];
    const FloatVec length = hn::Max(hn::Sqrt(Bc7Dot(sum, sum)), Bc7Number(1e-6f));
    for (int c = 0; c < 3; ++c) mean[c] = hn::Div(sum[c], length);
    // Two unit vectors across it (Duff et al., Building an Orthonormal Basis, Revisited).
    const FloatVec side = hn::IfThenElse(hn::Lt(mean[2], zero), Bc7Number(-1.0f), one);
    const FloatVec a = hn::Div(Bc7Number(-1.0f), hn::Add(side, mean[2])), b = hn::Mul(hn::Mul(mean[0], mean[1]), a);
    const FloatVec across_p[3] = {hn::Add(one, hn::Mul(side, hn::Mul(hn::Mul(mean[0], mean[0]), a))), hn::Mul(side, b),
                                  hn::Sub(zero, hn::Mul(side, mean[0]))};
    const FloatVec across_q[3] = {b, hn::Add(side, hn::Mul(hn::Mul(mean[1], mean[1]), a)), hn::Sub(zero, mean[1])};
    for (int k = 0; k < 16; ++k) {
        const FloatVec n[3] = {hn::Load(d, group.value[k][0]), hn::Load(d, group.value[k][1]),
                               hn::Load(d, group.value[k][2])};
        const FloatVec p = Bc7Dot(across_p, n), q = Bc7Dot(across_q, n);
        rows.of[k / 4][1 << k % 4] = {{p, q, hn::Mul(p, p), hn::Mul(p, q), hn::Mul(q, q)}};
    }
    for (auto& row : rows.of) {
        row[0] = {{zero, zero, zero, zero, zero}};
        for (unsigned set = 3; set < 16; ++set) {
            const unsigned lowest = set & (0 - set);
            if (set == lowest) continue;
            row[set] = row[set - lowest];
            row[set].add(row[lowest]);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif  // once for each target
