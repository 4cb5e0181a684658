// SPDX-License-Identifier: Apache-2.0
//
// The unit is 1/128 of a base, that is 1/16 of a code. The entries of a palette lie at the distances (2 m + 1) s on
// both sides of its centre, for the modifiers m >= 0 of the table. s is 64 times the multiplier, or 8 if that is 0.

#include "kernels/eac_fit.h"

#include <cstdint>

#include "kernels/eac_shapes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/eac_fit.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"
#include "kernels/fit_group-inl.h"

#ifndef TEX_EAC_FIT_ONCE
#define TEX_EAC_FIT_ONCE
namespace tex::inline v1 {
namespace {

// A table, and the width of its palette in units of 2 s that is matched to the range of the block.
struct Trial {
    int table;
    int width;
};
constexpr Trial kTrials[] = {{13, 5}, {9, 19},  {2, 24}, {15, 17}, {11, 19},
                             {0, 27}, {10, 19}, {4, 22}, {8, 19},  {1, 24}};

// Twice the distance of upper entry `k` of a table from the middle of its palette, for a multiplier of 1.
constexpr int odd(int table, int k) { return 2 * kEacModifiers[table][4 + k] + 1; }

}  // namespace
}  // namespace tex::inline v1
#endif

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Signed = hn::RebindToSigned<Words>;
using S = hn::Vec<Signed>;

HWY_INLINE S as_signed(W words) { return hn::BitCast(Signed(), words); }
HWY_INLINE W as_words(S values) { return hn::BitCast(Words(), values); }

struct EacChoice {
    W base, multiplier, table, scale, error;
    S centre;
};

class EacFitter {
public:
    EacFitter(const W* v, EacCodes codes) : v_(v), codes_(codes) {
        least_ = greatest_ = v[0];
        for (int k = 1; k < 16; ++k) {
            least_ = hn::Min(least_, v[k]);
            greatest_ = hn::Max(greatest_, v[k]);
        }
        best_ = {word(0), word(0), word(0), word(0), word(0xFFFF), as_signed(word(0))};
    }

    HWY_INLINE void try_table(const Trial& trial) {
        const Words d;
        const W range = hn::Sub(greatest_, least_);
        // range / (128 width), rounded.
        W multiplier = hn::MulHigh(hn::Add(range, word(64 * trial.width)), word((512 + trial.width / 2) / trial.width));
        const auto coarse = hn::Gt(range, word(3 * 128));
        multiplier = hn::Max(multiplier, hn::IfThenElseZero(coarse, word(1)));
        multiplier = hn::Min(multiplier, word(15));
        const auto eighths = hn::Eq(multiplier, hn::Zero(d));
        const W scale = hn::IfThenElse(eighths, word(8), hn::ShiftLeft<6>(multiplier));
        const W middle = hn::AverageRound(greatest_, least_);
        const W base =
            hn::ShiftRight<7>(hn::SaturatedSub(hn::Add(hn::Add(middle, scale), word(64)), word(16 * codes_.middle)));
        W odds[4];
        for (int k = 0; k < 4; ++k) odds[k] = word(odd(trial.table, k));
        offer(word(trial.table), odds, hn::Min(base, word(codes_.bases - 1)), multiplier, scale);
    }

    // Tries the bases beside the best one. Texels of 8 bits are further apart than bases, so that a palette that is not
    // in the middle of the range may fit them better.
    HWY_INLINE void try_bases() {
        W odds[4];
        best_odds(odds);
        const EacChoice best = best_;
        const W above = hn::Min(hn::Add(best.base, word(1)), word(codes_.bases - 1));
        offer(best.table, odds, above, best.multiplier, best.scale);
        offer(best.table, odds, hn::SaturatedSub(best.base, word(1)), best.multiplier, best.scale);
    }

    HWY_INLINE BlockWords encode() const {
        const Words d;
        W odds[4];
        best_odds(odds);
        // The middles between the distances of the entries from the centre.
        W middles[3];
        for (int k = 0; k < 3; ++k) middles[k] = hn::Mul(hn::ShiftRight<1>(hn::Add(odds[k], odds[k + 1])), best_.scale);
        BlockWords block;
        const W first = hn::And(hn::Sub(best_.base, word(codes_.bias)), word(0xFF));
        const W second = hn::Or(hn::ShiftLeft<4>(best_.multiplier), best_.table);
        block.w[0] = hn::Or(first, hn::ShiftLeft<8>(second));
        // 48 bits, the highest first, column by column.
        W words[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
        for (int n = 0; n < 16; ++n) {
            const S from_centre = hn::Sub(as_signed(v_[n % 4 * 4 + n / 4]), best_.centre);
            const W u = as_words(hn::Abs(from_centre));
            const auto is_below = hn::RebindMask(d, hn::Lt(from_centre, hn::Zero(Signed())));
            W selector = hn::IfThenZeroElse(is_below, word(4));
            for (int k = 0; k < 3; ++k) selector = hn::Sub(selector, hn::VecFromMask(d, hn::Gt(u, middles[k])));
            const int bit = 45 - 3 * n;  // of 48
            const int part = 2 - bit / 16;
            words[part] = hn::Or(words[part], hn::ShiftLeftSame(selector, bit % 16));
            if (bit % 16 > 13) words[part - 1] = hn::Or(words[part - 1], hn::ShiftRightSame(selector, 16 - bit % 16));
        }
        for (int k = 0; k < 3; ++k) block.w[1 + k] = hn::Or(hn::ShiftLeft<8>(words[k]), hn::ShiftRight<8>(words[k]));
        return block;
    }

private:
    // odd() of the best table of each block.
    HWY_INLINE void best_odds(W odds[4]) const {
        for (int k = 0; k < 4; ++k) {
            odds[k] = hn::Zero(Words());
            for (const Trial& trial : kTrials)
                odds[k] = hn::IfThenElse(hn::Eq(best_.table, word(trial.table)), word(odd(trial.table, k)), odds[k]);
        }
    }

    HWY_INLINE void offer(W table, const W odds[4], W base, W multiplier, W scale) {
        const S centre =
            hn::Sub(as_signed(hn::Add(hn::ShiftLeft<7>(base), word(16 * codes_.middle))), as_signed(scale));
        S distances[4];
        for (int k = 0; k < 4; ++k) distances[k] = as_signed(hn::Mul(scale, odds[k]));
        W error = hn::Zero(Words());
        for (int n = 0; n < 16; ++n) {
            const S u = hn::Abs(hn::Sub(as_signed(v_[n]), centre));
            S away = hn::Abs(hn::Sub(u, distances[0]));
            for (int k = 1; k < 4; ++k) away = hn::Min(away, hn::Abs(hn::Sub(u, distances[k])));
            error = hn::SaturatedAdd(error, as_words(away));
        }
        const auto better = hn::Lt(error, best_.error);
        best_.error = hn::Min(error, best_.error);
        best_.base = hn::IfThenElse(better, base, best_.base);
        best_.multiplier = hn::IfThenElse(better, multiplier, best_.multiplier);
        best_.scale = hn::IfThenElse(better, scale, best_.scale);
        best_.table = hn::IfThenElse(better, table, best_.table);
        best_.centre = as_signed(hn::IfThenElse(better, as_words(centre), as_words(best_.centre)));
    }

    const W* v_;
    const EacCodes codes_;
    W least_, greatest_;
    EacChoice best_;
};

HWY_INLINE BlockWords fit_channel(const float* const rows[4], bool negate, EacCodes codes) {
    W texels[16];
    load_texels(rows, static_cast<float>(codes.top) * 0.125f, negate, texels);
    EacFitter fitter(texels, codes);
    for (const Trial& trial : kTrials) fitter.try_table(trial);
    fitter.try_bases();
    return fitter.encode();
}

void FitEacBlocks(const FitRows& x, const FitRows& y, int count, EacCodes codes, std::byte* blocks) {
    for_each_group(x, y, count, blocks, [&](const float* const* xs, const float* const* ys, std::byte* to) {
        store_blocks(fit_channel(xs, x.negate, codes), fit_channel(ys, y.negate, codes), to);
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, fit_eac_blocks, FitEacBlocks,
           (const FitRows& x, const FitRows& y, int count, EacCodes codes, std::byte* blocks),
           (x, y, count, codes, blocks))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
