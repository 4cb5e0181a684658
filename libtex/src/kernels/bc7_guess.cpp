// SPDX-License-Identifier: Apache-2.0

#include "kernels/bc7_guess.h"

#include <bit>

#include "blocks/bptc.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bc7_guess.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/bc7_guess-inl.h"
#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The two planes of each kind: each component on its own, in the precision of either plane.
HWY_INLINE void GuessBc7Planes(const Bc7Group& group, const FloatVec mean[3], int rounds, Bc7Guesses& guesses) {
    const FloatTag d;
    const FloatVec ax = hn::Abs(mean[0]), ay = hn::Abs(mean[1]), az = hn::Abs(mean[2]);
    const FloatMask along_x = hn::And(hn::Gt(ax, az), hn::Ge(ax, ay));
    const FloatMask along_y = hn::AndNot(along_x, hn::Gt(ay, az));
    const FloatVec axis = hn::IfThenElse(along_y, Bc7Number(1.0f), Bc7Number(2.0f));
    hn::Store(hn::IfThenElse(along_x, hn::Zero(d), axis), d, guesses.axis);
    RampFit scalar[2][3], colour[2][3];
    for (int c = 0; c < 2; ++c) {
        BlockChannel channel;
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
                if (kind.scalar_levels == levels)
                    scalar[c][k] = FitRamp<Bc7Rules>(channel, kind.scalar_bits, levels, rounds);
                if (kind.levels == levels) colour[c][k] = FitRamp<Bc7Rules>(channel, kind.bits, levels, rounds);
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
    BlockChannel channel;
    FloatVec least = Bc7Number(1e3f), greatest = Bc7Number(-1e3f);
    for (int k = 0; k < 16; ++k) {
        channel.value[k] = hn::Sub(hn::Load(d, group.value[k][3]), Bc7Number(kBc7Middle));
        least = hn::Min(least, channel.value[k]);
        greatest = hn::Max(greatest, channel.value[k]);
    }
    for (int k = 0; k < 3; ++k) {
        const Bc7Kind& kind = kBc7KindTable[kBc7Apart + k];
        StartRamp(channel, least, greatest, kind.scalar_levels);
        const RampFit fit = FitRamp<Bc7Rules>(channel, kind.scalar_bits, kind.scalar_levels, rounds);
        hn::Store(fit.error, d, guesses.alpha_error[k]);
        for (int e = 0; e < 2; ++e) hn::Store(fit.ends[e], d, guesses.alpha_ends[k][e]);
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

HWY_INLINE void GuessBc7Parts(const BlockMoments& all, const BlockRowMoments& rows, bool has_alpha,
                              const Bc7Search& search, Bc7Guesses& guesses) {
    const FloatTag d;
    for (int k = 0; k < search.parts; ++k) {
        hn::Store(Bc7Number(kBc7None), d, guesses.part_error[k]);
        hn::Store(Bc7Number(-1.0f), d, guesses.part[k]);
    }
    for (int subsets = 2; subsets <= (search.three && !has_alpha ? 3 : 2); ++subsets) {
        for (unsigned partition = 0; partition < search.partitions; ++partition) {
            BlockMoments rest = all;
            FloatVec across = hn::Zero(d), along = across;
            int left = 16;
            for (int subset = 1; subset < subsets; ++subset) {
                const unsigned texels = bptc_texels(subsets, partition, subset);
                const int count = std::popcount(texels);
                const BlockMoments some = rows.texels(texels);
                rest.subtract(some);
                left -= count;
                const BlockResidue residue = ResidueOf(some, count);
                across = hn::Add(across, residue.across);
                along = hn::Add(along, residue.along);
            }
            const BlockResidue residue = ResidueOf(rest, left);
            across = hn::Add(across, residue.across);
            along = hn::Add(along, residue.along);
            const int first = has_alpha ? kBc7PartsAlpha : kBc7Parts + 2 * (subsets - 2);
            for (int k = first; k < first + (has_alpha ? 1 : 2); ++k) {
                if (kBc7KindTable[k].mode == 0 && partition >= 16) continue;  // has fewer partitions
                const Bc7Losses& losses = kBc7PartLosses[k - kBc7Parts];
                const FloatVec error =
                    MulThenAdd(along, Bc7Number(losses.along), hn::Add(across, Bc7Number(losses.rounding)));
                KeepPart(error, Bc7Number(static_cast<float>(64 * k) + static_cast<float>(partition)), search.parts,
                         guesses);
            }
        }
    }
}

HWY_INLINE void GuessBc7Lines(const Bc7Group& group, const FloatVec sum[3], const Bc7Search& search,
                              Bc7Guesses& guesses) {
    const FloatTag d;
    BlockRowMoments rows;
    FindMoments(group, sum, rows);
    const BlockMoments all = rows.texels(0xffff);
    const BlockResidue one_line = ResidueOf(all, 16);
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
