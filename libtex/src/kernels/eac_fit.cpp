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

#include "kernels/fit_group-inl.h"

#ifndef TEX_EAC_FIT_ONCE
#define TEX_EAC_FIT_ONCE
namespace tex {
namespace {

// A table, and the width of its palette in units of 2 s that is matched to the range of the block.
struct Trial {
    int table;
    int width;
};
constexpr Trial kTrials[] = {{13, 5}, {9, 19}, {2, 24}, {15, 17}, {11, 19}, {0, 27}, {10, 19}, {4, 22}};

}  // namespace
}  // namespace tex
#endif

HWY_BEFORE_NAMESPACE();
namespace tex {
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
        offer(trial.table, hn::Min(base, word(codes_.bases - 1)), multiplier, scale);
    }

    HWY_INLINE BlockWords encode() const {
        const Words d;
        // The middles between the distances of the entries from the centre.
        W middles[3];
        for (int k = 0; k < 3; ++k) {
            W factor = hn::Zero(d);
            for (const Trial& trial : kTrials) {
                const int* modifiers = kEacModifiers[trial.table] + 4;
                factor = hn::IfThenElse(hn::Eq(best_.table, word(trial.table)),
                                        word(modifiers[k] + modifiers[k + 1] + 1), factor);
            }
            middles[k] = hn::Mul(factor, best_.scale);
        }
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
    HWY_INLINE void offer(int table, W base, W multiplier, W scale) {
        const S centre =
            hn::Sub(as_signed(hn::Add(hn::ShiftLeft<7>(base), word(16 * codes_.middle))), as_signed(scale));
        S distances[4];
        for (int k = 0; k < 4; ++k) distances[k] = as_signed(hn::Mul(scale, word(2 * kEacModifiers[table][4 + k] + 1)));
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
        best_.table = hn::IfThenElse(better, word(table), best_.table);
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
    return fitter.encode();
}

void FitEacBlocks(const FitRows& x, const FitRows& y, int count, EacCodes codes, std::byte* blocks) {
    for_each_group(x, y, count, blocks, [&](const float* const* xs, const float* const* ys, std::byte* to) {
        store_blocks(fit_channel(xs, x.negate, codes), fit_channel(ys, y.negate, codes), to);
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace tex
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex {

HWY_EXPORT(FitEacBlocks);

void fit_eac_blocks(const FitRows& x, const FitRows& y, int count, EacCodes codes, std::byte* blocks) {
    HWY_DYNAMIC_DISPATCH(FitEacBlocks)(x, y, count, codes, blocks);
}

}  // namespace tex
#endif  // HWY_ONCE
