// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <bit>

#include "blocks/uastc_modes.h"
#include "kernels/uastc_fit.h"
#include "kernels/uastc_kinds.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/uastc_fit_guess.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/bc7_guess-inl.h"
#include "kernels/dispatch.h"
#include "kernels/uastc_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The two components beside the greatest one, each on its own.
HWY_INLINE void GuessUastcPlanes(const Bc7Group& group, const FloatVec mean[3], int rounds, UastcGuesses& guesses) {
    const FloatTag d;
    const Bc7Kind& kind = kUastcKindTable[kUastcPlanes];
    const FloatVec ax = hn::Abs(mean[0]), ay = hn::Abs(mean[1]), az = hn::Abs(mean[2]);
    const FloatMask along_x = hn::And(hn::Gt(ax, az), hn::Ge(ax, ay));
    const FloatMask along_y = hn::AndNot(along_x, hn::Gt(ay, az));
    const FloatVec axis = hn::IfThenElse(along_y, Bc7Number(1.0f), Bc7Number(2.0f));
    hn::Store(hn::IfThenElse(along_x, hn::Zero(d), axis), d, guesses.axis);
    FloatVec error = hn::Zero(d);
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
        StartRamp(channel, least, greatest, kind.levels);
        const RampFit fit = FitRamp<UastcRules>(channel, kind.bits, kind.levels, rounds);
        error = hn::Add(error, fit.error);
        for (int e = 0; e < 2; ++e) hn::Store(fit.ends[e], d, guesses.ends[c][e]);
    }
    // The plane that the greatest component shares with another one matters little.
    for (int c = 0; c < 2; ++c) hn::Store(error, d, guesses.error[c]);
}

// What kinds of lines lose: of the squared range along a line, and to the rounding of endpoints.
struct UastcLosses {
    float along, rounding;
};
constexpr float kUastcSquaredCode = 16.0f / (kBc7Middle * kBc7Middle);
constexpr UastcLosses kUastcLosses[kUastcKinds] = {
    {},
    {1.0f / 225.0f, 0.2f * kUastcSquaredCode},
    {1.0f / 49.0f, 0.2f * kUastcSquaredCode},
    {1.0f / 900.0f, 3.0f * kUastcSquaredCode},
    {1.0f / 60.0f, 10.0f * kUastcSquaredCode},
    {1.0f / 15.0f, 2.0f * kUastcSquaredCode},
    {1.0f / 15.0f, 2.0f * kUastcSquaredCode},
    {1.0f / 15.0f, 18.0f * kUastcSquaredCode},
};

HWY_INLINE FloatVec UastcLoss(const BlockResidue& residue, const UastcLosses& losses) {
    return MulThenAdd(residue.along, Bc7Number(losses.along), hn::Add(residue.across, Bc7Number(losses.rounding)));
}

HWY_INLINE void GuessUastcParts(const BlockMoments& all, const BlockRowMoments& rows, const UastcSearch& search,
                                UastcGuesses& guesses) {
    const FloatTag d;
    for (int k = 0; k < search.parts; ++k) {
        hn::Store(Bc7Number(kBc7None), d, guesses.part_error[k]);
        hn::Store(Bc7Number(-1.0f), d, guesses.part[k]);
    }
    // Modes 2 and 4 have the same patterns.
    for (int kind = kUastcParts + 1; kind < (search.three ? +kUastcKinds : kUastcKinds - 1); ++kind) {
        const Bc7Kind& which = kUastcKindTable[kind];
        const unsigned patterns = std::min(search.most, uastc_patterns(which.mode));
        for (unsigned pattern = 0; pattern < patterns; ++pattern) {
            BlockMoments rest = all;
            BlockResidue sum = {hn::Zero(d), hn::Zero(d)};
            int left = 16;
            for (int subset = 1; subset <= which.subsets; ++subset) {
                BlockResidue residue;
                if (subset < which.subsets) {
                    const unsigned texels = uastc_texels(which.mode, pattern, subset);
                    const int count = std::popcount(texels);
                    const BlockMoments some = rows.texels(texels);
                    rest.subtract(some);
                    left -= count;
                    residue = ResidueOf(some, count);
                } else {
                    residue = ResidueOf(rest, left);
                }
                sum.across = hn::Add(sum.across, residue.across);
                sum.along = hn::Add(sum.along, residue.along);
            }
            for (int k = kind == kUastcParts + 1 ? kind - 1 : kind; k <= kind; ++k) {
                const float number = static_cast<float>(64 * k) + static_cast<float>(pattern);
                KeepPart(UastcLoss(sum, kUastcLosses[k]), Bc7Number(number), search.parts, guesses);
            }
        }
    }
}

void GuessUastc(const Bc7Group& group, const UastcSearch& search, UastcGuesses& guesses) {
    const FloatTag d;
    FloatVec sum[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (int k = 0; k < 16; ++k) {
        for (int c = 0; c < 3; ++c) sum[c] = hn::Add(sum[c], hn::Load(d, group.value[k][c]));
    }
    GuessUastcPlanes(group, sum, search.rounds, guesses);
    BlockRowMoments rows;
    FindMoments(group, sum, rows);
    const BlockMoments all = rows.texels(0xffff);
    const BlockResidue one_line = ResidueOf(all, 16);
    for (int k = kUastcOne; k < kUastcParts; ++k)
        hn::Store(UastcLoss(one_line, kUastcLosses[k]), d, guesses.line[k - kUastcOne]);
    if (search.parts > 0) GuessUastcParts(all, rows, search, guesses);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, guess_uastc, GuessUastc, (const Bc7Group& group, const UastcSearch& search, UastcGuesses& guesses),
           (group, search, guesses))

}  // namespace tex::inline v1
#endif
