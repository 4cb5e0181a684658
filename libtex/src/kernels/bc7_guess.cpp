// SPDX-License-Identifier: Apache-2.0

#include "kernels/bc7_guess.h"

#include <bit>

#include "blocks/bptc.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bc7_guess.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/bc7_lanes-inl.h"
#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// One channel of a block, as codes from 0 to 255 relative to the middle.
struct Bc7Channel {
    FloatVec value[16];
    FloatVec ends[2];  // of a ramp, before rounding
};

// Puts the endpoints where the squared error is least for the indices that they give now.
HWY_INLINE void ImproveRamp(Bc7Channel& channel, int levels) {
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

HWY_INLINE FloatVec RampError(const Bc7Channel& channel, FloatVec end0, FloatVec end1, int bits, int levels) {
    const Bc7Ramp ramp(end0, end1, bits, levels);
    FloatVec sum = hn::Zero(FloatTag());
    for (const FloatVec v : channel.value) {
        const FloatVec off = hn::Sub(ramp.nearest(v), v);
        sum = MulThenAdd(off, off, sum);
    }
    return hn::Mul(sum, Bc7Number(1.0f / (kBc7Middle * kBc7Middle)));
}

struct Bc7RampFit {
    FloatVec ends[2];
    FloatVec error;
};

// The best stored endpoints around those of the channel.
HWY_NOINLINE Bc7RampFit FitRamp(const Bc7Channel& channel, int bits, int levels, int rounds) {
    static constexpr float kMoves[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, -1}, {-1, 1}, {1, 1}, {-1, -1}};
    const FloatVec middle = Bc7Number(kBc7Middle);
    Bc7RampFit fit;
    for (int e = 0; e < 2; ++e) fit.ends[e] = Bc7Round(hn::Add(channel.ends[e], middle), bits);
    fit.error = RampError(channel, fit.ends[0], fit.ends[1], bits, levels);
    // 0 rounds: only single moves; endpoints of 7 and 8 bits need none.
    const int moves = rounds == 0 ? 4 : 8;
    for (int r = 0; r < (bits > 6 ? rounds : rounds + 1); ++r) {
        const FloatVec from[2] = {fit.ends[0], fit.ends[1]};
        for (int m = 0; m < moves; ++m) {
            FloatVec to[2];
            for (int e = 0; e < 2; ++e) to[e] = Bc7Clamp(hn::Add(from[e], Bc7Number(kMoves[m][e])), Bc7Top(bits));
            const FloatVec error = RampError(channel, to[0], to[1], bits, levels);
            const FloatMask better = hn::Lt(error, fit.error);
            for (int e = 0; e < 2; ++e) fit.ends[e] = hn::IfThenElse(better, to[e], fit.ends[e]);
            fit.error = hn::Min(error, fit.error);
        }
    }
    return fit;
}

// The endpoints of a channel for so many levels.
HWY_INLINE void StartRamp(Bc7Channel& channel, FloatVec least, FloatVec greatest, int levels) {
    channel.ends[0] = least;
    channel.ends[1] = greatest;
    ImproveRamp(channel, levels);
    ImproveRamp(channel, levels);
}

// The two planes of each kind: each component on its own, in the precision of either plane.
HWY_INLINE void GuessBc7Planes(const Bc7Group& group, const FloatVec mean[3], int rounds, Bc7Guesses& guesses) {
    const FloatTag d;
    const FloatVec ax = hn::Abs(mean[0]), ay = hn::Abs(mean[1]), az = hn::Abs(mean[2]);
    const FloatMask along_x = hn::And(hn::Gt(ax, az), hn::Ge(ax, ay));
    const FloatMask along_y = hn::AndNot(along_x, hn::Gt(ay, az));
    const FloatVec axis = hn::IfThenElse(along_y, Bc7Number(1.0f), Bc7Number(2.0f));
    hn::Store(hn::IfThenElse(along_x, hn::Zero(d), axis), d, guesses.axis);
    Bc7RampFit scalar[2][3], colour[2][3];
    for (int c = 0; c < 2; ++c) {
        Bc7Channel channel;
        FloatVec least = Bc7Number(1e3f), greatest = Bc7Number(-1e3f);
        for (int k = 0; k < 16; ++k) {
            const FloatMask next = c == 0 ? along_x : hn::Or(along_x, along_y);
            const FloatVec v = hn::IfThenElse(next, hn::Load(d, group.value[k][c + 1]), hn::Load(d, group.value[k][c]));
            channel.value[k] = hn::Mul(v, Bc7Number(kBc7Middle));
            least = hn::Min(least, channel.value[k]);
            greatest = hn::Max(greatest, channel.value[k]);
        }
        for (const int levels : {8, 4}) {
            StartRamp(channel, least, greatest, levels);
            for (int k = 0; k < 3; ++k) {
                const Bc7Kind& kind = kBc7KindTable[kBc7Planes + k];
                if (kind.scalar_levels == levels) scalar[c][k] = FitRamp(channel, kind.scalar_bits, levels, rounds);
                if (kind.levels == levels) colour[c][k] = FitRamp(channel, kind.bits, levels, rounds);
            }
        }
    }
    for (int k = 0; k < 3; ++k) {
        for (int c = 0; c < 2; ++c) {
            hn::Store(hn::Add(scalar[c][k].error, colour[1 - c][k].error), d, guesses.error[k][c]);
            for (int e = 0; e < 2; ++e) {
                hn::Store(scalar[c][k].ends[e], d, guesses.ends[k][c][0][e]);
                hn::Store(colour[1 - c][k].ends[e], d, guesses.ends[k][c][1][e]);
            }
        }
    }
}

HWY_INLINE void GuessBc7Alpha(const Bc7Group& group, int rounds, Bc7Guesses& guesses) {
    const FloatTag d;
    Bc7Channel channel;
    FloatVec least = Bc7Number(1e3f), greatest = Bc7Number(-1e3f);
    for (int k = 0; k < 16; ++k) {
        channel.value[k] = hn::Sub(hn::Load(d, group.value[k][3]), Bc7Number(kBc7Middle));
        least = hn::Min(least, channel.value[k]);
        greatest = hn::Max(greatest, channel.value[k]);
    }
    for (int k = 0; k < 3; ++k) {
        const Bc7Kind& kind = kBc7KindTable[kBc7Apart + k];
        StartRamp(channel, least, greatest, kind.scalar_levels);
        const Bc7RampFit fit = FitRamp(channel, kind.scalar_bits, kind.scalar_levels, rounds);
        hn::Store(fit.error, d, guesses.alpha_error[k]);
        for (int e = 0; e < 2; ++e) hn::Store(fit.ends[e], d, guesses.alpha_ends[k][e]);
    }
}

// Sums over texels in the plane across the mean: of p, q, p p, p q, q q.
struct Bc7Moments {
    FloatVec sum[5];

    HWY_INLINE void add(const Bc7Moments& more) {
        for (int s = 0; s < 5; ++s) sum[s] = hn::Add(sum[s], more.sum[s]);
    }
    HWY_INLINE void subtract(const Bc7Moments& less) {
        for (int s = 0; s < 5; ++s) sum[s] = hn::Sub(sum[s], less.sum[s]);
    }
};

// The sums of all sets of texels of each row: bit i of a number stands for texel i.
struct Bc7RowMoments {
    Bc7Moments of[4][16];

    HWY_INLINE Bc7Moments texels(unsigned mask) const {
        Bc7Moments sum = of[0][mask & 15];
        for (int row = 1; row < 4; ++row) sum.add(of[row][mask >> (4 * row) & 15]);
        return sum;
    }
};

// What lines leave: across them everything, along them what the steps between levels leave.
struct Bc7Residue {
    FloatVec across, along;
};
HWY_INLINE Bc7Residue ResidueOf(const Bc7Moments& moments, int count) {
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
HWY_INLINE void KeepBc7Part(FloatVec error, FloatVec number, int most, Bc7Guesses& guesses) {
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

// What kinds of several subsets lose: of the squared range along a line, and to the rounding of endpoints.
struct Bc7Losses {
    float along, rounding;
};
constexpr float kBc7SquaredCode = 16.0f / (kBc7Middle * kBc7Middle);
constexpr Bc7Losses kBc7PartLosses[5] = {
    {1.0f / 60.0f, 1.0f * kBc7SquaredCode}, {1.0f / 60.0f, 0.1f * kBc7SquaredCode},
    {1.0f / 60.0f, 3.0f * kBc7SquaredCode}, {1.0f / 60.0f, 3.0f * kBc7SquaredCode},
    {1.0f / 60.0f, 1.5f * kBc7SquaredCode},
};

HWY_INLINE void GuessBc7Parts(const Bc7Moments& all, const Bc7RowMoments& rows, bool has_alpha, const Bc7Search& search,
                              Bc7Guesses& guesses) {
    const FloatTag d;
    for (int k = 0; k < search.parts; ++k) {
        hn::Store(Bc7Number(kBc7None), d, guesses.part_error[k]);
        hn::Store(Bc7Number(-1.0f), d, guesses.part[k]);
    }
    for (int subsets = 2; subsets <= (search.three && !has_alpha ? 3 : 2); ++subsets) {
        for (unsigned partition = 0; partition < search.partitions; ++partition) {
            Bc7Moments rest = all;
            FloatVec across = hn::Zero(d), along = across;
            int left = 16;
            for (int subset = 1; subset < subsets; ++subset) {
                const unsigned texels = bptc_texels(subsets, partition, subset);
                const int count = std::popcount(texels);
                const Bc7Moments some = rows.texels(texels);
                rest.subtract(some);
                left -= count;
                const Bc7Residue residue = ResidueOf(some, count);
                across = hn::Add(across, residue.across);
                along = hn::Add(along, residue.along);
            }
            const Bc7Residue residue = ResidueOf(rest, left);
            across = hn::Add(across, residue.across);
            along = hn::Add(along, residue.along);
            const int first = has_alpha ? kBc7PartsAlpha : kBc7Parts + 2 * (subsets - 2);
            for (int k = first; k < first + (has_alpha ? 1 : 2); ++k) {
                if (kBc7KindTable[k].mode == 0 && partition >= 16) continue;  // has fewer partitions
                const Bc7Losses& losses = kBc7PartLosses[k - kBc7Parts];
                const FloatVec error =
                    MulThenAdd(along, Bc7Number(losses.along), hn::Add(across, Bc7Number(losses.rounding)));
                KeepBc7Part(error, Bc7Number(static_cast<float>(64 * k) + static_cast<float>(partition)), search.parts,
                            guesses);
            }
        }
    }
}

HWY_INLINE void GuessBc7Lines(const Bc7Group& group, const FloatVec sum[3], const Bc7Search& search,
                              Bc7Guesses& guesses) {
    const FloatTag d;
    const FloatVec zero = hn::Zero(d), one = Bc7Number(1.0f);
    FloatVec mean[3];
    const FloatVec length = hn::Max(hn::Sqrt(Bc7Dot(sum, sum)), Bc7Number(1e-6f));
    for (int c = 0; c < 3; ++c) mean[c] = hn::Div(sum[c], length);
    // Two unit vectors across it (Duff et al., Building an Orthonormal Basis, Revisited).
    const FloatVec side = hn::IfThenElse(hn::Lt(mean[2], zero), Bc7Number(-1.0f), one);
    const FloatVec a = hn::Div(Bc7Number(-1.0f), hn::Add(side, mean[2])), b = hn::Mul(hn::Mul(mean[0], mean[1]), a);
    const FloatVec across_p[3] = {hn::Add(one, hn::Mul(side, hn::Mul(hn::Mul(mean[0], mean[0]), a))), hn::Mul(side, b),
                                  hn::Sub(zero, hn::Mul(side, mean[0]))};
    const FloatVec across_q[3] = {b, hn::Add(side, hn::Mul(hn::Mul(mean[1], mean[1]), a)), hn::Sub(zero, mean[1])};
    Bc7RowMoments rows;
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
    const Bc7Moments all = rows.texels(0xffff);
    const Bc7Residue one_line = ResidueOf(all, 16);
    hn::Store(MulThenAdd(one_line.along, Bc7Number(1.0f / 225.0f), one_line.across), d, guesses.line);
    if (search.parts > 0) GuessBc7Parts(all, rows, group.has_alpha, search, guesses);
}

void GuessBc7(const Bc7Group& group, const Bc7Search& search, Bc7Guesses& guesses) {
    const FloatTag d;
    FloatVec sum[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (int k = 0; k < 16; ++k) {
        for (int c = 0; c < 3; ++c) sum[c] = hn::Add(sum[c], hn::Load(d, group.value[k][c]));
    }
    GuessBc7Planes(group, sum, search.rounds, guesses);
    if (group.has_alpha) GuessBc7Alpha(group, search.rounds, guesses);
    GuessBc7Lines(group, sum, search, guesses);
}

int Bc7LanesOf() { return static_cast<int>(hn::Lanes(FloatTag())); }

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(int, bc7_lanes, Bc7LanesOf, (), ())

TEX_KERNEL(void, guess_bc7, GuessBc7, (const Bc7Group& group, const Bc7Search& search, Bc7Guesses& guesses),
           (group, search, guesses))

}  // namespace tex::inline v1
#endif
