// SPDX-License-Identifier: Apache-2.0
// fit_group-inl.h: up to 32 blocks of one channel in lanes of 16 bits: loaded from rows of texels, and stored as
// blocks.
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

#include "kernels/fit.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Words = hn::CappedTag<std::uint16_t, 32>;  // one block in each lane
using Floats = hn::CappedTag<float, 16>;
using W = hn::Vec<Words>;
using F = hn::Vec<Floats>;

constexpr int kLanes = 32;       // at most
constexpr float kFine = 128.0f;  // units per code in texels as loaded
constexpr int kHighUnit = 128;   // local units per unit of Group::high

// Constant, and always inlined, because loops over these must be unrolled.
HWY_INLINE constexpr int lanes() { return static_cast<int>(hn::MaxLanes(Words())); }
HWY_INLINE constexpr int float_lanes() { return static_cast<int>(hn::MaxLanes(Floats())); }

HWY_INLINE F constant(float value) { return hn::Set(Floats(), value); }
HWY_INLINE W word(int value) { return hn::Set(Words(), static_cast<std::uint16_t>(value)); }

// A vector of words takes kParts vectors of floats: first the words of even lanes, then those of odd lanes. So no word
// changes its lane.
#if HWY_TARGET == HWY_SCALAR
constexpr int kParts = 1;
struct Parts {
    F part[kParts];
};
HWY_INLINE Parts to_floats(W words) {
    return {{hn::ConvertTo(Floats(), hn::PromoteTo(hn::Rebind<std::int32_t, Floats>(), words))}};
}
HWY_INLINE Parts sum_of(W a, W b, W c) {
    return {{hn::Add(hn::Add(to_floats(a).part[0], to_floats(b).part[0]), to_floats(c).part[0])}};
}
// Converts numbers of 0 to 65535, rounded to whole numbers: they are added to 2^23, and the lowest bits of the sum hold
// them.
HWY_INLINE W to_words(const F (&value)[kParts]) {
    return hn::TruncateTo(Words(),
                          hn::BitCast(hn::Rebind<std::uint32_t, Floats>(), hn::Add(value[0], constant(8388608.0f))));
}
#else
constexpr int kParts = 2;
struct Parts {
    F part[kParts];
};
HWY_INLINE Parts to_floats(W words) {
    const Floats d;
    const hn::Rebind<std::int32_t, Floats> di;
    const hn::Rebind<std::uint32_t, Floats> du;
    const auto pairs = hn::BitCast(du, words);
    const auto even = hn::And(pairs, hn::Set(du, 0xFFFFu));
    return {{hn::ConvertTo(d, hn::BitCast(di, even)), hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<16>(pairs)))}};
}
HWY_INLINE Parts sum_of(W a, W b, W c) {
    const Floats d;
    const hn::Rebind<std::int32_t, Floats> di;
    const hn::Rebind<std::uint32_t, Floats> du;
    const auto x = hn::BitCast(du, a);
    const auto y = hn::BitCast(du, b);
    const auto z = hn::BitCast(du, c);
    const auto low = hn::Set(du, 0xFFFFu);
    const auto even = hn::Add(hn::Add(hn::And(x, low), hn::And(y, low)), hn::And(z, low));
    const auto odd = hn::Add(hn::Add(hn::ShiftRight<16>(x), hn::ShiftRight<16>(y)), hn::ShiftRight<16>(z));
    return {{hn::ConvertTo(d, hn::BitCast(di, even)), hn::ConvertTo(d, hn::BitCast(di, odd))}};
}
// Converts numbers of 0 to 65535, rounded to whole numbers: they are added to 2^23, and the lowest bits of the sum hold
// them.
HWY_INLINE W to_words(const F (&value)[kParts]) {
    const hn::Rebind<std::uint32_t, Floats> du;
    const auto even = hn::And(hn::BitCast(du, hn::Add(value[0], constant(8388608.0f))), hn::Set(du, 0xFFFFu));
    const auto odd = hn::ShiftLeft<16>(hn::BitCast(du, hn::Add(value[1], constant(8388608.0f))));
    return hn::BitCast(Words(), hn::Or(even, odd));
}
#endif

// Blocks in lanes. Values, and endpoints called a and b, are local: they count units of `unit` codes from the least
// texel, which is at `base` codes. The unit is such that the greatest texel lies between 32768 and 65535.
struct Group {
    W values[16];
    W high[16];  // values = kHighUnit high + low, high up to 512
    W low[16];   // -64 to 63; only in groups made with full precision
    F base[kParts], unit[kParts], per_unit[kParts];
    F greatest[kParts];
    F sum[kParts], high_sum[kParts];  // sums of the values, and of kHighUnit * high
    hn::Mask<Floats> whole[kParts];   // set if all texels are whole codes
    F ties[kParts];                   // what to add before values are rounded to indices (kTiesUp)
};

// Texels of four rows: 16 vectors in units of 1/128 code, clamped to 0 to `top` codes. Transposing within 16 bytes is
// cheaper than across the vector: with B blocks in a vector of floats, lane 8 p + 4 h + m holds block (2 m + h) B + p,
// which suits BlockWriter.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE void load_texels(const float* const rows[4], float top, bool negate, W* v) {
    const float half = 0.5f * kFine * top;
    for (int k = 0; k < 16; ++k) {
        const float n = rows[k / 4][k % 4];
        const float value = std::max(n * (negate ? -half : half) + (8388608.0f + half), 8388608.0f) - 8388608.0f;
        v[k] = word(static_cast<int>(std::min(value, 2.0f * half)));
    }
}
#else
HWY_INLINE void load_texels(const float* const rows[4], float top, bool negate, W* v) {
    const Words d;
    const Floats df;
    const hn::Rebind<std::int32_t, Floats> di;
    const hn::Rebind<std::int16_t, Words> ds;
    const hn::Repartition<std::uint32_t, Words> d32;
    const hn::Repartition<std::uint64_t, Words> d64;
    // A number added to 2^23 is rounded to a whole number, which the lowest bits of the sum then hold.
    constexpr float kWhole = 8388608.0f;
    const float half = 0.5f * kFine * top;
    const F scale = constant(negate ? -half : half);
    const F middle = constant(kWhole + half);
    const auto most = hn::Set(ds, static_cast<std::int16_t>(2.0f * half));
    const auto whole = [&](const float* from) {
        const F value = hn::Max(hn::Add(hn::Mul(hn::LoadU(df, from), scale), middle), constant(kWhole));
        return hn::Sub(hn::BitCast(di, value), hn::Set(di, 0x4B000000));  // the bits of 2^23
    };
    for (int r = 0; r < 4; ++r, v += 4) {
        W row[4];  // blocks b and b + B in each 16 bytes
        for (int m = 0; m < 4; ++m) {
            const float* from = rows[r] + m * 2 * float_lanes();
            row[m] = hn::BitCast(d, hn::Min(hn::ReorderDemote2To(ds, whole(from), whole(from + float_lanes())), most));
        }
        const auto first01 = hn::BitCast(d32, hn::InterleaveLower(d, row[0], row[1]));
        const auto first23 = hn::BitCast(d32, hn::InterleaveLower(d, row[2], row[3]));
        const auto second01 = hn::BitCast(d32, hn::InterleaveUpper(d, row[0], row[1]));
        const auto second23 = hn::BitCast(d32, hn::InterleaveUpper(d, row[2], row[3]));
        const auto first_left = hn::BitCast(d64, hn::InterleaveLower(d32, first01, first23));
        const auto first_right = hn::BitCast(d64, hn::InterleaveUpper(d32, first01, first23));
        const auto second_left = hn::BitCast(d64, hn::InterleaveLower(d32, second01, second23));
        const auto second_right = hn::BitCast(d64, hn::InterleaveUpper(d32, second01, second23));
        v[0] = hn::BitCast(d, hn::InterleaveLower(d64, first_left, second_left));
        v[1] = hn::BitCast(d, hn::InterleaveUpper(d64, first_left, second_left));
        v[2] = hn::BitCast(d, hn::InterleaveLower(d64, first_right, second_right));
        v[3] = hn::BitCast(d, hn::InterleaveUpper(d64, first_right, second_right));
    }
}
#endif

// Sums of coarse precision use only the high parts of values.
enum class Precision { coarse, full };

// Added to values before they become indices, in units of the ramps (fit_kinds-inl.h): 2048 for each spacing. Rounding
// moves them by -2 to 1 units. For whole codes, 2 units are added, so that the middle between two values always goes to
// the greater one. Other whole codes are at least 4 units away from the middle, because a palette spans at most 255
// codes: their indices are exact.
constexpr float kTiesUp = 2.0f;
constexpr float kTiesEitherWay = 0.5f;

template <Precision kPrecision>
HWY_INLINE void make_group(const W* v, Group& group) {
    const Words d;
    const Floats df;
    const hn::Rebind<std::uint32_t, Floats> du;
    W least = v[0];
    W greatest = v[0];
    W bits = v[0];
    for (int k = 1; k < 16; ++k) {
        least = hn::Min(least, v[k]);
        greatest = hn::Max(greatest, v[k]);
        bits = hn::Or(bits, v[k]);
    }
    const Parts fractions = to_floats(hn::And(bits, word(static_cast<int>(kFine) - 1)));
    // Values are multiplied by the power of two that moves the greatest one into the range 32768 to 65535.
    const Parts ranges = to_floats(hn::Sub(greatest, least));
    const Parts bases = to_floats(least);
    F factors[kParts];
    for (int p = 0; p < kParts; ++p) {
        const F range = ranges.part[p];
        const auto exponent = hn::And(hn::BitCast(du, hn::Max(range, constant(1.0f))), hn::Set(du, 0x7F800000u));
        factors[p] = hn::BitCast(df, hn::Sub(hn::Set(du, (2u * 127u + 15u) << 23), exponent));
        group.per_unit[p] = hn::Mul(factors[p], constant(kFine));
        group.unit[p] = hn::Div(constant(1.0f), group.per_unit[p]);  // exact: powers of two
        group.greatest[p] = hn::Mul(range, factors[p]);
        group.base[p] = hn::Mul(bases.part[p], constant(1.0f / kFine));
        group.whole[p] = hn::Eq(fractions.part[p], hn::Zero(df));
        group.ties[p] = hn::Zero(df);
        if constexpr (kPrecision == Precision::full)
            group.ties[p] = hn::IfThenElse(group.whole[p], constant(kTiesUp), constant(kTiesEitherWay));
    }
    const W factor = to_words(factors);
    W high_sum = hn::Zero(d);
    W low_sum = word(1024);
    for (int k = 0; k < 16; ++k) {
        group.values[k] = hn::Mul(hn::Sub(v[k], least), factor);
        group.high[k] = hn::AverageRound(hn::ShiftRight<6>(group.values[k]), hn::Zero(d));
        high_sum = hn::Add(high_sum, group.high[k]);
        if constexpr (kPrecision == Precision::full) {
            group.low[k] = hn::Sub(group.values[k], hn::ShiftLeft<7>(group.high[k]));
            low_sum = hn::Add(low_sum, group.low[k]);
        }
    }
    const Parts high_sums = to_floats(high_sum);
    const Parts low_sums = to_floats(low_sum);
    for (int p = 0; p < kParts; ++p) {
        group.high_sum[p] = hn::Mul(high_sums.part[p], constant(kHighUnit));
        group.sum[p] = hn::Add(group.high_sum[p], hn::Sub(low_sums.part[p], constant(1024.0f)));
    }
}

// The 8 bytes of one channel of each block, as words.
struct BlockWords {
    W w[4];
};

// Stores blocks of two channels, 16 bytes each, one after the other.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE void store_blocks(const BlockWords& first, const BlockWords& second, std::byte* blocks) {
    for (std::ptrdiff_t k = 0; k < 4; ++k) {
        const std::uint16_t words[2] = {hn::GetLane(first.w[k]), hn::GetLane(second.w[k])};
        std::memcpy(blocks + 2 * k, words, 2);
        std::memcpy(blocks + 8 + 2 * k, words + 1, 2);
    }
}
#else
HWY_INLINE void store_blocks(const BlockWords& first, const BlockWords& second, std::byte* blocks) {
    const Words d;
    const hn::Repartition<std::uint8_t, Words> d8;
    const hn::Repartition<std::uint32_t, Words> d32;
    const hn::Repartition<std::uint64_t, Words> d64;
    auto* to = reinterpret_cast<std::uint8_t*>(blocks);
    const auto store = [&](auto a01, auto a23, auto b01, auto b23, int h) {
        const auto a = [&](bool upper) {
            return hn::BitCast(d64, upper ? hn::InterleaveUpper(d32, hn::BitCast(d32, a01), hn::BitCast(d32, a23))
                                          : hn::InterleaveLower(d32, hn::BitCast(d32, a01), hn::BitCast(d32, a23)));
        };
        const auto b = [&](bool upper) {
            return hn::BitCast(d64, upper ? hn::InterleaveUpper(d32, hn::BitCast(d32, b01), hn::BitCast(d32, b23))
                                          : hn::InterleaveLower(d32, hn::BitCast(d32, b01), hn::BitCast(d32, b23)));
        };
        for (int m = 0; m < 4; ++m) {
            const auto blocks_m =
                m % 2 ? hn::InterleaveUpper(d64, a(m / 2), b(m / 2)) : hn::InterleaveLower(d64, a(m / 2), b(m / 2));
            hn::StoreU(hn::BitCast(d8, blocks_m), d8, to + (2 * m + h) * 2 * lanes());
        }
    };
    store(hn::InterleaveLower(d, first.w[0], first.w[1]), hn::InterleaveLower(d, first.w[2], first.w[3]),
          hn::InterleaveLower(d, second.w[0], second.w[1]), hn::InterleaveLower(d, second.w[2], second.w[3]), 0);
    store(hn::InterleaveUpper(d, first.w[0], first.w[1]), hn::InterleaveUpper(d, first.w[2], first.w[3]),
          hn::InterleaveUpper(d, second.w[0], second.w[1]), hn::InterleaveUpper(d, second.w[2], second.w[3]), 1);
}
#endif

// Calls encode(rows of x, rows of y, blocks) for groups of lanes() blocks. The last blocks are copied first.
template <class Encode>
HWY_INLINE void for_each_group(const FitRows& x, const FitRows& y, int count, std::byte* blocks, Encode encode) {
    std::ptrdiff_t first = 0;
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
    const auto rest = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(count - first, 0, kLanes));
    for (int r = 0; r < 4; ++r) {
        std::memcpy(copies[0][r], x.rows[r] + 4 * first, rest * 4 * sizeof(float));
        std::memcpy(copies[1][r], y.rows[r] + 4 * first, rest * 4 * sizeof(float));
        from[0][r] = copies[0][r];
        from[1][r] = copies[1][r];
    }
    encode(from[0], from[1], last);
    std::memcpy(blocks + 16 * first, last, 16 * rest);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif
