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

#include "kernels/fit_group-inl.h"
#include "kernels/fit_steps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex {
namespace HWY_NAMESPACE {

// Blocks of one value (to half a code): the endpoints that come nearest to it.
HWY_INLINE void set_single_greens(const Group& group, Choice& choice) {
    const Floats d;
    const hn::Rebind<std::int32_t, Floats> di;
    const std::int32_t* below = single_greens_below();
    const std::int32_t* above = single_greens_above();
    for (int i = 0; i < lanes(); i += float_lanes()) {
        const F unit = hn::Load(d, group.unit + i);
        const auto single = hn::Le(hn::Mul(hn::Load(d, group.greatest + i), unit), constant(0.5f));
        if (hn::AllFalse(d, single)) continue;
        const F mean = hn::Mul(hn::Mul(hn::Load(d, group.high_sum + i), unit), constant(1.0f / 16.0f));
        const F thirds = hn::Mul(hn::Add(hn::Load(d, group.base + i), mean), constant(3.0f));
        const auto at = hn::ConvertTo(di, thirds);
        const auto down = hn::GatherIndex(di, below, at);
        const auto up = hn::GatherIndex(di, above, hn::Min(hn::Add(at, hn::Set(di, 1)), hn::Set(di, kMostThirds)));
        const F to_down = hn::Abs(hn::Sub(thirds, hn::ConvertTo(d, hn::ShiftRight<16>(down))));
        const F to_up = hn::Abs(hn::Sub(hn::ConvertTo(d, hn::ShiftRight<16>(up)), thirds));
        const auto green = hn::IfThenElse(hn::RebindMask(di, hn::Lt(to_down, to_up)), down, up);
        const F low = hn::ConvertTo(d, hn::And(hn::ShiftRight<8>(green), hn::Set(di, 0xFF)));
        const F high = hn::Add(low, hn::ConvertTo(d, hn::And(green, hn::Set(di, 0xFF))));
        hn::Store(hn::IfThenElse(single, low, hn::Load(d, choice.low + i)), d, choice.low + i);
        hn::Store(hn::IfThenElse(single, high, hn::Load(d, choice.high + i)), d, choice.high + i);
    }
}

// Indices as blocks store them, by k from the lower endpoint; bit 3 of k tells blocks of 6 values.
HWY_ALIGN constexpr std::uint8_t kBc4Indices[16] = {1, 7, 6, 5, 4, 3, 2, 0, 0, 2, 3, 4, 5, 1, 1, 1};
HWY_ALIGN constexpr std::uint8_t kGreenIndices[16] = {1, 3, 2, 0};

HWY_INLINE W stored_index(W k, const std::uint8_t* table) {
#if HWY_TARGET == HWY_SCALAR
    return word(table[hn::GetLane(k) & 15]);
#else
    // The upper byte is out of the table, which gives 0.
    const hn::Repartition<std::uint8_t, Words> d8;
    return hn::BitCast(Words(), hn::TableLookupBytesOr0(hn::LoadDup128(d8, table), hn::BitCast(d8, hn::Or(k, word(0x8000)))));
#endif
}

// Words of 16 bits that hold the indices of all texels, `bits` each; k(texel) counts from the lower endpoint.
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

HWY_INLINE W stored_codes(const float* codes) {
    HWY_ALIGN std::uint16_t words[kLanes];
    for (int i = 0; i < lanes(); i += float_lanes()) store_words(hn::Load(Floats(), codes + i), words + i);
    return hn::Load(Words(), words);
}

// How the texels of a block find their indices: those of blocks of 6 values have bit 3 set.
struct Indexing {
    W factor, offset, cut, mark;
};

HWY_INLINE BlockWords bc4_words(const Group& group, Bc4Codes codes, const Ends& ends, const Indexing& by) {
    const Words d;
    BlockWords block;
    const auto texel_index = [&](int texel) {
        return hn::Or(index(hn::Load(d, group.values + texel * lanes()), by.factor, by.offset, by.cut), by.mark);
    };
    pack_indices<3>(kBc4Indices, texel_index, block.w + 1);
    const W byte = word(0xFF);
    const W e0 = hn::And(hn::Sub(stored_codes(ends.high), word(codes.bias)), byte);
    const W e1 = hn::Sub(stored_codes(ends.low), word(codes.bias));
    block.w[0] = hn::Or(e0, hn::ShiftLeft<8>(e1));
    return block;
}

// The better ones of endpoints for 8 and for 6 values, which are stored the other way round.
HWY_INLINE BlockWords choose_bc4(const Group& group, Bc4Codes codes, const Choice& eight, const Choice& six) {
    const Floats d;
    const float top = static_cast<float>(codes.top);
    Ramp ramp, six_ramp;
    Fitter<EightValues>(group, {top}).ramp_of(eight, ramp);
    Fitter<SixValues>(group, {top}).ramp_of(six, six_ramp);
    Ends chosen;
    HWY_ALIGN std::uint16_t is_six[kLanes];
    for (int i = 0; i < lanes(); i += float_lanes()) {
        const auto better = hn::Lt(hn::Load(d, six.error + i), hn::Load(d, eight.error + i));
        store_words(hn::IfThenElseZero(better, constant(1.0f)), is_six + i);
        hn::Store(hn::IfThenElse(better, hn::Load(d, six.low + i), hn::Load(d, eight.high + i)), d, chosen.high + i);
        hn::Store(hn::IfThenElse(better, hn::Load(d, six.high + i), hn::Load(d, eight.low + i)), d, chosen.low + i);
    }
    const Words dw;
    const auto better = hn::Ne(hn::Load(dw, is_six), hn::Zero(dw));
    const auto either = [&](const std::uint16_t* a, const std::uint16_t* b) { return hn::IfThenElse(better, hn::Load(dw, b), hn::Load(dw, a)); };
    return bc4_words(group, codes, chosen,
                     {either(ramp.factor, six_ramp.factor), either(ramp.offset, six_ramp.offset),
                      hn::IfThenElse(better, word(cut(5)), word(cut(7))), hn::IfThenElseZero(better, word(8))});
}

// Texels keep the indices for which the endpoints were solved.
HWY_INLINE BlockWords fast_bc4(const W* texels, Bc4Codes codes) {
    const Words d;
    Group group;
    make_group<Precision::coarse>(texels, group);
    HWY_ALIGN std::uint16_t fractions[kLanes];
    W any = texels[0];
    for (int k = 1; k < 16; ++k) any = hn::Or(any, texels[k]);
    hn::Store(hn::And(any, word(static_cast<int>(kFine) - 1)), d, fractions);
    Ramp ramp;
    Choice choice;
    Fitter<EightValues>(group, {static_cast<float>(codes.top)}).solve(0.0f, fractions, ramp, choice);
    return bc4_words(group, codes, choice, {hn::Load(d, ramp.factor), hn::Load(d, ramp.offset), word(cut(7)), hn::Zero(d)});
}

HWY_INLINE BlockWords normal_bc4(const W* texels, Bc4Codes codes) {
    const float top = static_cast<float>(codes.top);
    Group group;
    make_group<Precision::full>(texels, group);
    const Fitter<EightValues> fitter(group, {top});
    Choice found;
    for (const auto& [g, j] : {std::pair(0.0f, 1.0f), {0.5f, 0.0f}, {0.5f, 2.0f}}) fitter.start<Precision::coarse>(g, j, 2, found);
    Choice eight;
    fitter.measure<Precision::full>(found, eight);
    fitter.start<Precision::full>(0.0f, 0.0f, 3, eight);
    fitter.whole_codes(eight);
    const Fitter<SixValues> six_fitter(group, {top});
    Choice six;
    six_fitter.start<Precision::full>(0.0f, 1.0f, 2, six);
    return choose_bc4(group, codes, eight, six);
}

HWY_INLINE BlockWords green_words(const Group& group, const Choice& choice) {
    const Words d;
    Ramp ramp;
    Fitter<Greens>(group, {}).ramp_of(choice, ramp);
    BlockWords block;
    const W factor = hn::Load(d, ramp.factor);
    const W offset = hn::Load(d, ramp.offset);
    const W floor = word(cut(3));
    pack_indices<2>(kGreenIndices, [&](int texel) { return index(hn::Load(d, group.values + texel * lanes()), factor, offset, floor); }, block.w + 2);
    const W red_blue = word(0xF81F);
    block.w[0] = hn::Or(hn::ShiftLeft<5>(stored_codes(choice.high)), red_blue);
    block.w[1] = hn::Or(hn::ShiftLeft<5>(stored_codes(choice.low)), red_blue);
    // Equal endpoints use index 0 only.
    const auto apart = hn::Ne(block.w[0], block.w[1]);
    block.w[2] = hn::IfThenElseZero(apart, block.w[2]);
    block.w[3] = hn::IfThenElseZero(apart, block.w[3]);
    return block;
}

HWY_INLINE BlockWords fast_green(const W* texels) {
    Group group;
    make_group<Precision::coarse>(texels, group);
    Ramp ramp;
    Choice choice;
    Fitter<Greens>(group, {}).solve(1.0f / 16.0f, nullptr, ramp, choice);
    set_single_greens(group, choice);
    return green_words(group, choice);
}

HWY_INLINE BlockWords normal_green(const W* texels) {
    Group group;
    make_group<Precision::full>(texels, group);
    const Fitter<Greens> fitter(group, {});
    Choice found;
    for (const float g : {-0.4f, 0.4f}) {
        for (const float j : {0.0f, 1.0f, 2.0f}) fitter.start<Precision::coarse>(g, j, 2, found);
    }
    fitter.neighbours(2, found);
    set_single_greens(group, found);
    Choice best;
    fitter.measure<Precision::full>(found, best);
    fitter.start<Precision::full>(0.0f, 0.0f, 3, best);
    return green_words(group, best);
}

// Calls encode(rows of x, rows of y, blocks) for groups of lanes() blocks; the last ones in copies.
template <class Encode>
HWY_INLINE void for_each_group(const ChannelRows& x, const ChannelRows& y, int count, std::byte* blocks, Encode encode) {
    int first = 0;
    for (; first + lanes() <= count; first += lanes()) {
        const float* from[2][4];
        for (int r = 0; r < 4; ++r) {
            from[0][r] = x.rows[r] + 4 * first;
            from[1][r] = y.rows[r] + 4 * first;
        }
        encode(from[0], from[1], blocks + 16 * first);
    }
    if (first == count) return;
    float copies[2][4][4 * kLanes] = {};
    std::byte last[16 * kLanes];
    const float* from[2][4];
    const auto rest = static_cast<std::size_t>(std::clamp(count - first, 0, kLanes));
    for (int r = 0; r < 4; ++r) {
        std::memcpy(copies[0][r], x.rows[r] + 4 * first, rest * 4 * sizeof(float));
        std::memcpy(copies[1][r], y.rows[r] + 4 * first, rest * 4 * sizeof(float));
        from[0][r] = copies[0][r];
        from[1][r] = copies[1][r];
    }
    encode(from[0], from[1], last);
    std::memcpy(blocks + 16 * first, last, 16 * rest);
}

void fit_dxt5nm_blocks(const ChannelRows& x, const ChannelRows& y, int count, Effort effort, std::byte* blocks) {
    for_each_group(x, y, count, blocks, [&](const float* const* xs, const float* const* ys, std::byte* to) {
        W texels[16];
        load_texels(xs, 255, x.negate, texels);
        const BlockWords alpha = effort == Effort::fast ? fast_bc4(texels, kBc4Unorm) : normal_bc4(texels, kBc4Unorm);
        load_texels(ys, 255, y.negate, texels);
        const BlockWords green = effort == Effort::fast ? fast_green(texels) : normal_green(texels);
        store_blocks(alpha, green, to);
    });
}

void fit_bc5_blocks(const ChannelRows& x, const ChannelRows& y, int count, Bc4Codes codes, Effort effort, std::byte* blocks) {
    for_each_group(x, y, count, blocks, [&](const float* const* xs, const float* const* ys, std::byte* to) {
        BlockWords words[2];
        for (int k = 0; k < 2; ++k) {
            W texels[16];
            load_texels(k == 0 ? xs : ys, codes.top, k == 0 ? x.negate : y.negate, texels);
            words[k] = effort == Effort::fast ? fast_bc4(texels, codes) : normal_bc4(texels, codes);
        }
        store_blocks(words[0], words[1], to);
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace tex
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex {

HWY_EXPORT(fit_dxt5nm_blocks);
HWY_EXPORT(fit_bc5_blocks);

void fit_dxt5nm_blocks(const ChannelRows& x, const ChannelRows& y, int count, Effort effort, std::byte* blocks) {
    HWY_DYNAMIC_DISPATCH(fit_dxt5nm_blocks)(x, y, count, effort, blocks);
}

void fit_bc5_blocks(const ChannelRows& x, const ChannelRows& y, int count, Bc4Codes codes, Effort effort, std::byte* blocks) {
    HWY_DYNAMIC_DISPATCH(fit_bc5_blocks)(x, y, count, codes, effort, blocks);
}

}  // namespace tex
#endif  // HWY_ONCE
