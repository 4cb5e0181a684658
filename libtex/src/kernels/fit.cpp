// SPDX-License-Identifier: Apache-2.0

#include "kernels/fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "kernels/single_greens.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/fit.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"
#include "kernels/fit_greens-inl.h"
#include "kernels/fit_group-inl.h"
#include "kernels/fit_palettes-inl.h"
#include "kernels/fit_steps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

// For blocks of one value (to half a code): sets the endpoints that come nearest to it.
HWY_INLINE void set_single_greens(const Group& group, Choice& choice) {
    const Floats d;
    const hn::Rebind<std::int32_t, Floats> di;
    const std::int32_t* below = single_greens_below();
    const std::int32_t* above = single_greens_above();
    for (int p = 0; p < kParts; ++p) {
        const auto single = hn::Le(hn::Mul(group.greatest[p], group.unit[p]), constant(0.5f));
        if (hn::AllFalse(d, single)) continue;
        const F mean = hn::Mul(hn::Mul(group.high_sum[p], group.unit[p]), constant(1.0f / 16.0f));
        const F thirds = hn::Mul(hn::Add(group.base[p], mean), constant(3.0f));
        const auto at = hn::ConvertTo(di, thirds);
        const auto down = hn::GatherIndex(di, below, at);
        const auto up = hn::GatherIndex(di, above, hn::Min(hn::Add(at, hn::Set(di, 1)), hn::Set(di, kMostThirds)));
        const F to_down = hn::Abs(hn::Sub(thirds, hn::ConvertTo(d, hn::ShiftRight<16>(down))));
        const F to_up = hn::Abs(hn::Sub(hn::ConvertTo(d, hn::ShiftRight<16>(up)), thirds));
        const auto green = hn::IfThenElse(hn::RebindMask(di, hn::Lt(to_down, to_up)), down, up);
        const F low = hn::ConvertTo(d, hn::And(hn::ShiftRight<8>(green), hn::Set(di, 0xFF)));
        const F high = hn::Add(low, hn::ConvertTo(d, hn::And(green, hn::Set(di, 0xFF))));
        choice.low[p] = hn::IfThenElse(single, low, choice.low[p]);
        choice.high[p] = hn::IfThenElse(single, high, choice.high[p]);
    }
}

// Indices as blocks store them, by k counted from the lower endpoint. Bit 3 of k marks blocks of 6 values.
HWY_ALIGN constexpr std::uint8_t kBc4Indices[16] = {1, 7, 6, 5, 4, 3, 2, 0, 0, 2, 3, 4, 5, 1, 1, 1};
HWY_ALIGN constexpr std::uint8_t kGreenIndices[16] = {1, 3, 2, 0};

HWY_INLINE W stored_index(W k, const std::uint8_t* table) {
#if HWY_TARGET == HWY_SCALAR
    return word(table[hn::GetLane(k) & 15]);
#else
    // The upper byte lies outside the table, which gives 0.
    const hn::Repartition<std::uint8_t, Words> d8;
    return hn::BitCast(Words(),
                       hn::TableLookupBytesOr0(hn::LoadDup128(d8, table), hn::BitCast(d8, hn::Or(k, word(0x8000)))));
#endif
}

// Packs the indices of all texels into words of 16 bits, `bits` for each index; k(texel) counts from the lower
// endpoint.
template <int kBits, class Index>
HWY_INLINE void pack_indices(const std::uint8_t* table, Index k, W* words) {
    for (int texel = 0; texel < 16; ++texel) {
        const W stored = stored_index(k(texel), table);
        const int bit = kBits * texel % 16;
        W& to = words[kBits * texel / 16];
        to = bit == 0 ? stored : hn::Or(to, hn::ShiftLeftSame(stored, bit));
        if (bit + kBits > 16) words[kBits * texel / 16 + 1] = hn::ShiftRightSame(stored, 16 - bit);
    }
}

// How the texels of a block find their indices. In blocks of 6 values, bit 3 of the index is set.
struct Indexing {
    W factor, offset, cut, mark;
};

HWY_INLINE BlockWords bc4_words(const Group& group, Bc4Codes codes, const Ends& ends, const Indexing& by) {
    BlockWords block;
    const auto texel_index = [&](int texel) {
        return hn::Or(index(group.values[texel], by.factor, by.offset, by.cut), by.mark);
    };
    pack_indices<3>(kBc4Indices, texel_index, block.w + 1);
    const W byte = word(0xFF);
    const W e0 = hn::And(hn::Sub(to_words(ends.high), word(codes.bias)), byte);
    const W e1 = hn::Sub(to_words(ends.low), word(codes.bias));
    block.w[0] = hn::Or(e0, hn::ShiftLeft<8>(e1));
    return block;
}

// Chooses the better of the endpoints for 8 and for 6 values, which are stored in the opposite order.
HWY_INLINE BlockWords choose_bc4(const Group& group, Bc4Codes codes, const Choice& eight, const Choice& six) {
    const float top = static_cast<float>(codes.top);
    const Ramp ramp = Fitter<EightValues>(group, {top}).ramp_of(eight);
    const Ramp six_ramp = Fitter<SixValues>(group, {top}).ramp_of(six);
    Ends chosen;
    F is_six[kParts];
    for (int p = 0; p < kParts; ++p) {
        const auto better =
            hn::Lt(hn::Mul(six.error[p], constant(7.0f * 7.0f)), hn::Mul(eight.error[p], constant(5.0f * 5.0f)));
        is_six[p] = hn::IfThenElseZero(better, constant(65535.0f));
        chosen.high[p] = hn::IfThenElse(better, six.low[p], eight.high[p]);
        chosen.low[p] = hn::IfThenElse(better, six.high[p], eight.low[p]);
    }
    const auto better = hn::MaskFromVec(to_words(is_six));
    return bc4_words(
        group, codes, chosen,
        {hn::IfThenElse(better, six_ramp.factor, ramp.factor), hn::IfThenElse(better, six_ramp.offset, ramp.offset),
         hn::IfThenElse(better, word(cut(5)), word(cut(7))), hn::IfThenElseZero(better, word(8))});
}

// Texels keep the indices for which the endpoints were solved.
HWY_INLINE BlockWords fast_bc4(const W* texels, Bc4Codes codes) {
    const Words d;
    Group group;
    make_group<Precision::coarse>(texels, group);
    Choice choice;
    const Ramp ramp = Fitter<EightValues>(group, {static_cast<float>(codes.top)}).solve(0.0f, group.whole, choice);
    return bc4_words(group, codes, choice, {ramp.factor, ramp.offset, word(cut(7)), hn::Zero(d)});
}

// Sets `extremes` if a block has texels of the lowest or the greatest code, and other texels too.
HWY_INLINE BlockWords normal_bc4(const W* texels, Bc4Codes codes, bool& extremes) {
    const float top = static_cast<float>(codes.top);
    Group group;
    make_group<Precision::full>(texels, group);
    const Fitter<EightValues> fitter(group, {top});
    Choice found;
    for (const auto& [g, j] : {std::pair(0.0f, 1.0f), {0.5f, 0.0f}, {0.5f, 2.0f}})
        fitter.start<Precision::coarse>(g, j, 2, found);
    Choice eight;
    fitter.score<Precision::full>(found, nullptr, eight);
    fitter.plain(eight);
    fitter.whole_codes(eight);
    const Fitter<SixValues> six_fitter(group, {top});
    Choice six;
    six_fitter.start<Precision::full>(0.0f, 1.0f, 2, six);
    // A spacing of one code has no error if all texels are whole codes.
    F open[kParts];
    for (int p = 0; p < kParts; ++p) {
        const F range = hn::Mul(group.greatest[p], group.unit[p]);
        const auto lowest = hn::Eq(group.base[p], hn::Zero(Floats()));
        const auto extreme = hn::Or(lowest, hn::Eq(hn::Add(group.base[p], range), constant(top)));
        extremes |= !hn::AllFalse(Floats(), hn::And(extreme, hn::Gt(range, hn::Zero(Floats()))));
        const F least_range = hn::IfThenElse(group.whole[p], constant(7.0f), constant(0.5f));
        open[p] = hn::IfThenElseZero(hn::Gt(range, least_range), constant(65535.0f));
    }
    offer_bc4_palettes(group, to_words(open), top, eight, six);
    return choose_bc4(group, codes, eight, six);
}

HWY_INLINE BlockWords green_words(const Group& group, const Choice& choice) {
    const Ramp ramp = Fitter<Greens>(group, {}).ramp_of(choice);
    BlockWords block;
    pack_indices<2>(
        kGreenIndices, [&](int texel) { return index(group.values[texel], ramp.factor, ramp.offset, word(cut(3))); },
        block.w + 2);
    const W red_blue = word(0xF81F);
    block.w[0] = hn::Or(hn::ShiftLeft<5>(to_words(choice.high)), red_blue);
    block.w[1] = hn::Or(hn::ShiftLeft<5>(to_words(choice.low)), red_blue);
    // If the endpoints are equal, only index 0 is used.
    const auto apart = hn::Ne(block.w[0], block.w[1]);
    block.w[2] = hn::IfThenElseZero(apart, block.w[2]);
    block.w[3] = hn::IfThenElseZero(apart, block.w[3]);
    return block;
}

HWY_INLINE BlockWords fast_green(const W* texels) {
    Group group;
    make_group<Precision::coarse>(texels, group);
    Choice choice;
    Fitter<Greens>(group, {}).solve(1.0f / 16.0f, nullptr, choice);
    set_single_greens(group, choice);
    return green_words(group, choice);
}

HWY_INLINE BlockWords normal_green(const W* texels) {
    Group group;
    make_group<Precision::full>(texels, group);
    const GreenFitter fitter(group);
    Choice found;
    for (const float g : {-0.4f, 0.4f}) {
        for (const float j : {0.0f, 1.0f, 2.0f}) fitter.start_and_step(g, j, found);
    }
    fitter.neighbours(2, found);
    fitter.neighbours(1, found);
    set_single_greens(group, found);
    Choice best;
    fitter.score<Precision::full>(found, nullptr, best);
    fitter.plain(best);
    F wide[kParts];  // two spacings are 8/3 codes or more
    for (int p = 0; p < kParts; ++p) {
        wide[p] = hn::IfThenElseZero(hn::Gt(group.greatest[p], hn::Mul(group.per_unit[p], constant(2.5f))),
                                     constant(65535.0f));
    }
    offer_green_palettes(group, to_words(wide), best);
    return green_words(group, best);
}

bool fit_dxt5nm_blocks(const FitRows& x, const FitRows& y, int count, Effort effort, std::byte* blocks) {
    bool extremes = false;
    for_each_group(x, y, count, blocks, [&](const float* const* xs, const float* const* ys, std::byte* to) {
        W texels[16];
        load_texels(xs, 255.0f, x.negate, texels);
        const BlockWords alpha =
            effort == Effort::fast ? fast_bc4(texels, kBc4Unorm) : normal_bc4(texels, kBc4Unorm, extremes);
        load_texels(ys, 255.0f, y.negate, texels);
        const BlockWords green = effort == Effort::fast ? fast_green(texels) : normal_green(texels);
        store_blocks(alpha, green, to);
    });
    return extremes;
}

bool fit_bc5_blocks(const FitRows& x, const FitRows& y, int count, Bc4Codes codes, Effort effort, std::byte* blocks) {
    bool extremes = false;
    for_each_group(x, y, count, blocks, [&](const float* const* xs, const float* const* ys, std::byte* to) {
        BlockWords words[2];
        for (int k = 0; k < 2; ++k) {
            W texels[16];
            load_texels(k == 0 ? xs : ys, static_cast<float>(codes.top), k == 0 ? x.negate : y.negate, texels);
            words[k] = effort == Effort::fast ? fast_bc4(texels, codes) : normal_bc4(texels, codes, extremes);
        }
        store_blocks(words[0], words[1], to);
    });
    return extremes;
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(bool, fit_dxt5nm_blocks, fit_dxt5nm_blocks,
           (const FitRows& x, const FitRows& y, int count, Effort effort, std::byte* blocks),
           (x, y, count, effort, blocks))

TEX_KERNEL(bool, fit_bc5_blocks, fit_bc5_blocks,
           (const FitRows& x, const FitRows& y, int count, Bc4Codes codes, Effort effort, std::byte* blocks),
           (x, y, count, codes, effort, blocks))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
