// SPDX-License-Identifier: Apache-2.0
// fit_group-inl.h: up to 32 blocks in lanes of 16 bits: from rows of texels, and to the bytes of blocks.
//
// Compiled once for each Highway target, as part of fit.cpp.

#if defined(TEX_KERNELS_FIT_GROUP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_FIT_GROUP_INL_H
#undef TEX_KERNELS_FIT_GROUP_INL_H
#else
#define TEX_KERNELS_FIT_GROUP_INL_H
#endif

#include <algorithm>
#include <cstdint>
#include <cstring>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tex {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Words = hn::CappedTag<std::uint16_t, 32>;  // a block in each lane
using Floats = hn::CappedTag<float, 16>;
using W = hn::Vec<Words>;
using F = hn::Vec<Floats>;

constexpr int kLanes = 32;  // at most
constexpr float kUnit = 256.0f;  // of texels before they are made local, for each code

// Always inlined: loops over it must see a constant.
HWY_INLINE constexpr int lanes() { return static_cast<int>(hn::MaxLanes(Words())); }

HWY_INLINE F constant(float value) { return hn::Set(Floats(), value); }

// The sums of a step, for each block.
struct Sums {
    HWY_ALIGN std::uint16_t k[kLanes], kk[kLanes], kv[kLanes];
};

// What turns a value into an index: k = (scaled * factor / 65536 - subtract) / 128, not below 0; with the bias, endpoints may lie below
// the least texel, and still nothing is negative on the way.
constexpr std::uint16_t kBias = 512;
struct Ramp {
    HWY_ALIGN std::uint16_t factor[kLanes], subtract[kLanes];
};

// Up to 32 blocks. Values, and endpoints called a and b, are local: units of `unit` codes from `base` on.
struct Group {
    HWY_ALIGN std::uint16_t fine[16 * kLanes];  // as loaded: 1/256 code
    HWY_ALIGN std::uint16_t values[16 * kLanes];
    HWY_ALIGN std::uint16_t scaled[16 * kLanes];  // (value + kBias) * 64
    HWY_ALIGN float base[kLanes], unit[kLanes], per_unit[kLanes];
    HWY_ALIGN float least[kLanes], greatest[kLanes], sum[kLanes];
    // The best endpoints so far, as codes, and the error with them less the sum of the squared values.
    HWY_ALIGN float low[kLanes], high[kLanes], error[kLanes];
};

// Texels of four rows, as whole numbers of 1/256 code. Columns from `texels` on are 0.
HWY_INLINE void load(const float* const rows[4], int texels, int top, bool negate, std::uint16_t* words) {
    const Floats d;
    const hn::Rebind<std::uint32_t, Floats> du;
    const hn::Rebind<std::uint16_t, Floats> dw;
    const int step = static_cast<int>(hn::Lanes(d));
    const int columns = 4 * lanes();
    // Added to 2^23 a number is rounded to a whole one, which the lowest bits of the sum then hold.
    constexpr float kWhole = 8388608.0f;
    const float half = 0.5f * kUnit * static_cast<float>(top);
    const F scale = constant(negate ? -half : half);
    const F middle = constant(kWhole + half);
    const F least = constant(kWhole);
    const F most = constant(kWhole + 2.0f * half);
    for (int r = 0; r < 4; ++r) {
        for (int i = 0; i < columns; i += step) {
            auto codes = hn::Zero(dw);
            if (i < texels) {
                const F value = hn::Add(hn::Mul(hn::LoadU(d, rows[r] + i), scale), middle);
                codes = hn::TruncateTo(dw, hn::BitCast(du, hn::Min(hn::Max(value, least), most)));
            }
            hn::StoreU(codes, dw, words + r * columns + i);
        }
    }
}

// The four columns of a row of blocks. Transposing within 16 bytes is cheaper than across the vector, so that lane 8 p + l holds
// block l % 4 * lanes() / 4 + 2 p + l / 4; store_blocks() puts them in order again.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE void load_columns(const std::uint16_t* words, W* v) { hn::LoadInterleaved4(Words(), words, v[0], v[1], v[2], v[3]); }
#else
HWY_INLINE void load_columns(const std::uint16_t* words, W* v) {
    const Words d;
    const hn::Repartition<std::uint32_t, Words> d32;
    const hn::Repartition<std::uint64_t, Words> d64;
    const auto v0 = hn::Load(d, words);
    const auto v1 = hn::Load(d, words + lanes());
    const auto v2 = hn::Load(d, words + 2 * lanes());
    const auto v3 = hn::Load(d, words + 3 * lanes());
    // Two blocks of each vector lie in 16 bytes: columns of the first, then of the second.
    const auto first01 = hn::BitCast(d32, hn::InterleaveLower(d, v0, v1));
    const auto first23 = hn::BitCast(d32, hn::InterleaveLower(d, v2, v3));
    const auto second01 = hn::BitCast(d32, hn::InterleaveUpper(d, v0, v1));
    const auto second23 = hn::BitCast(d32, hn::InterleaveUpper(d, v2, v3));
    const auto first_left = hn::BitCast(d64, hn::InterleaveLower(d32, first01, first23));
    const auto first_right = hn::BitCast(d64, hn::InterleaveUpper(d32, first01, first23));
    const auto second_left = hn::BitCast(d64, hn::InterleaveLower(d32, second01, second23));
    const auto second_right = hn::BitCast(d64, hn::InterleaveUpper(d32, second01, second23));
    v[0] = hn::BitCast(d, hn::InterleaveLower(d64, first_left, second_left));
    v[1] = hn::BitCast(d, hn::InterleaveUpper(d64, first_left, second_left));
    v[2] = hn::BitCast(d, hn::InterleaveLower(d64, first_right, second_right));
    v[3] = hn::BitCast(d, hn::InterleaveUpper(d64, first_right, second_right));
}
#endif

HWY_INLINE void make_group(const std::uint16_t* words, Group& group) {
    const Words d;
    const int columns = 4 * lanes();
    W v[16];
    for (int r = 0; r < 4; ++r) load_columns(words + r * columns, v + 4 * r);
    W least = v[0];
    W greatest = v[0];
    for (int k = 1; k < 16; ++k) {
        least = hn::Min(least, v[k]);
        greatest = hn::Max(greatest, v[k]);
    }
    const W base = hn::And(least, hn::Set(d, 0xFF00));
    const W range = hn::Sub(greatest, base);
    // The finest of the units 2^s / 256, s = 4 to 7, with which the range needs at most 9 bits; values are shifted by multiplication.
    W factor = hn::Set(d, 1 << 12);
    W rounding = hn::Set(d, 1 << 3);
    for (int s = 5; s <= 7; ++s) {
        const auto wide = hn::Gt(range, hn::Set(d, static_cast<std::uint16_t>(510 << (s - 1))));
        factor = hn::IfThenElse(wide, hn::Set(d, static_cast<std::uint16_t>(1 << (16 - s))), factor);
        rounding = hn::IfThenElse(wide, hn::Set(d, static_cast<std::uint16_t>(1 << (s - 1))), rounding);
    }
    const W offset = hn::Sub(base, rounding);
    W sum = hn::Zero(d);
    for (int k = 0; k < 16; ++k) {
        const W local = hn::MulHigh(hn::Sub(v[k], offset), factor);
        sum = hn::Add(sum, local);
        hn::Store(v[k], d, group.fine + k * lanes());
        hn::Store(local, d, group.values + k * lanes());
        hn::Store(hn::ShiftLeft<6>(hn::Add(local, hn::Set(d, kBias))), d, group.scaled + k * lanes());
    }
    HWY_ALIGN std::uint16_t rows[5][kLanes];
    hn::Store(base, d, rows[0]);
    hn::Store(rounding, d, rows[1]);
    hn::Store(hn::MulHigh(hn::Sub(least, offset), factor), d, rows[2]);
    hn::Store(hn::MulHigh(hn::Sub(greatest, offset), factor), d, rows[3]);
    hn::Store(sum, d, rows[4]);
    const Floats df;
    const hn::Rebind<std::uint16_t, Floats> dw;
    const hn::Rebind<std::int32_t, Floats> di;
    for (int i = 0; i < lanes(); i += static_cast<int>(hn::Lanes(df))) {
        const auto row = [&](int k) { return hn::ConvertTo(df, hn::PromoteTo(di, hn::Load(dw, rows[k] + i))); };
        hn::Store(hn::Mul(row(0), constant(1.0f / kUnit)), df, group.base + i);
        const F unit = hn::Mul(row(1), constant(2.0f / kUnit));
        hn::Store(unit, df, group.unit + i);
        hn::Store(hn::Div(constant(1.0f), unit), df, group.per_unit + i);  // exact: powers of two
        hn::Store(row(2), df, group.least + i);
        hn::Store(row(3), df, group.greatest + i);
        hn::Store(row(4), df, group.sum + i);
        hn::Store(constant(1e30f), df, group.error + i);
        hn::Store(hn::Zero(df), df, group.low + i);
        hn::Store(hn::Zero(df), df, group.high + i);
    }
}

// Stores numbers of 0 to 65535, rounded to whole ones: added to 2^23, the lowest bits of the sum hold them.
HWY_INLINE void store_words(F value, std::uint16_t* to) {
    const hn::Rebind<std::uint32_t, Floats> du;
    const hn::Rebind<std::uint16_t, Floats> dw;
    hn::Store(hn::TruncateTo(dw, hn::BitCast(du, hn::Add(value, constant(8388608.0f)))), dw, to);
}

// From 0 for the lower endpoint to n for the greater one, to the order of the palette: n is 0, 0 is 1, n - 1 is 2 ...
template <int kSteps>
HWY_INLINE W palette_index(W k) {
    const Words d;
    const W turned = hn::And(hn::Sub(hn::Set(d, kSteps + 1), k), hn::Set(d, kSteps));
    return hn::Xor(turned, hn::And(hn::VecFromMask(d, hn::Lt(turned, hn::Set(d, 2))), hn::Set(d, 1)));
}

// Words of 16 bits that hold the indices of all texels, `bits` each; index(texel) counts from the lower endpoint.
template <int kSteps, int kBits, class Index>
HWY_INLINE void pack_indices(Index index, W* words) {
    const Words d;
    for (int k = 0; k < kBits; ++k) words[k] = hn::Zero(d);
    for (int texel = 0; texel < 16; ++texel) {
        const W k = palette_index<kSteps>(index(texel));
        const int bit = kBits * texel % 16;
        W& word = words[kBits * texel / 16];
        word = hn::Or(word, hn::ShiftLeftSame(k, bit));
        if (bit + kBits > 16) words[kBits * texel / 16 + 1] = hn::ShiftRightSame(k, 16 - bit);
    }
}

HWY_INLINE W stored_codes(const float* codes) {
    const Floats d;
    HWY_ALIGN std::uint16_t words[kLanes];
    for (int i = 0; i < lanes(); i += static_cast<int>(hn::Lanes(d))) store_words(hn::Load(d, codes + i), words + i);
    return hn::Load(Words(), words);
}

// Writes the blocks that lanes hold in four words, 16 bytes apart; those from `count` on are left out.
HWY_INLINE void store_blocks(W w0, W w1, W w2, W w3, int count, std::byte* blocks) {
    HWY_ALIGN std::uint64_t words[kLanes];
    const bool all = count >= lanes();
    const auto write = [&](int block, int from) {
        if (all || block < count) std::memcpy(blocks + 16 * block, words + from, 8);
    };
#if HWY_TARGET == HWY_SCALAR
    hn::StoreInterleaved4(w0, w1, w2, w3, Words(), reinterpret_cast<std::uint16_t*>(words));
    write(0, 0);
#else
    const Words d;
    const hn::Repartition<std::uint32_t, Words> d32;
    const hn::Repartition<std::uint64_t, Words> d64;
    // Pairs of lanes: in each 16 bytes lanes 0 and 1 come first, then 2 and 3 of all, then 4 and 5, 6 and 7.
    const auto lower01 = hn::BitCast(d32, hn::InterleaveLower(d, w0, w1));
    const auto lower23 = hn::BitCast(d32, hn::InterleaveLower(d, w2, w3));
    const auto upper01 = hn::BitCast(d32, hn::InterleaveUpper(d, w0, w1));
    const auto upper23 = hn::BitCast(d32, hn::InterleaveUpper(d, w2, w3));
    const int quarter = lanes() / 4;
    hn::Store(hn::BitCast(d64, hn::InterleaveLower(d32, lower01, lower23)), d64, words);
    hn::Store(hn::BitCast(d64, hn::InterleaveUpper(d32, lower01, lower23)), d64, words + quarter);
    hn::Store(hn::BitCast(d64, hn::InterleaveLower(d32, upper01, upper23)), d64, words + 2 * quarter);
    hn::Store(hn::BitCast(d64, hn::InterleaveUpper(d32, upper01, upper23)), d64, words + 3 * quarter);
    for (int part = 0; part < quarter; part += 2) {
        for (int lane = 0; lane < 8; ++lane) {
            write(lane % 4 * quarter + part + lane / 4, lane / 2 * quarter + part + lane % 2);
        }
    }
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace tex
HWY_AFTER_NAMESPACE();

#endif
