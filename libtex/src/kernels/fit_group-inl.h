// SPDX-License-Identifier: Apache-2.0
// fit_group-inl.h: up to 32 blocks of one channel in lanes of 16 bits: from rows of texels, and to the bytes of blocks.
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

constexpr int kLanes = 32;        // at most
constexpr float kFine = 128.0f;   // units of texels as loaded, for each code
constexpr int kHighUnit = 128;    // local units of Group::high

// Constants, and always inlined, as loops over them must be unrolled.
HWY_INLINE constexpr int lanes() { return static_cast<int>(hn::MaxLanes(Words())); }
HWY_INLINE constexpr int float_lanes() { return static_cast<int>(hn::MaxLanes(Floats())); }

HWY_INLINE F constant(float value) { return hn::Set(Floats(), value); }
HWY_INLINE W word(int value) { return hn::Set(Words(), static_cast<std::uint16_t>(value)); }

HWY_INLINE F load_words(const std::uint16_t* from) {
    const Floats d;
    const hn::Rebind<std::uint16_t, Floats> dw;
    const hn::Rebind<std::int32_t, Floats> di;
    return hn::ConvertTo(d, hn::PromoteTo(di, hn::Load(dw, from)));
}

// Stores numbers of 0 to 65535, rounded to whole ones: added to 2^23, the lowest bits of the sum hold them.
HWY_INLINE void store_words(F value, std::uint16_t* to) {
    const hn::Rebind<std::uint32_t, Floats> du;
    const hn::Rebind<std::uint16_t, Floats> dw;
    hn::Store(hn::TruncateTo(dw, hn::BitCast(du, hn::Add(value, constant(8388608.0f)))), dw, to);
}

// Blocks in lanes. Values, and endpoints called a and b, are local: units of `unit` codes from the least texel, `base` codes, on, such that the
// greatest texel lies between 32768 and 65535.
struct Group {
    HWY_ALIGN std::uint16_t values[16 * kLanes];
    HWY_ALIGN std::uint16_t high[16 * kLanes];  // values = kHighUnit high + low, high up to 512
    HWY_ALIGN std::int16_t low[16 * kLanes];    // -64 to 63; of groups made with full precision
    HWY_ALIGN float base[kLanes], unit[kLanes], per_unit[kLanes];
    HWY_ALIGN float greatest[kLanes];
    HWY_ALIGN float sum[kLanes], high_sum[kLanes];  // of values, and of kHighUnit high
};

// Texels of four rows, 16 vectors of 1/128 code, clamped to 0 to `top` codes. Transposing within 16 bytes is cheaper than across the vector:
// with B blocks in a vector of floats, lane 8 p + 4 h + m holds block (2 m + h) B + p, which suits BlockWriter.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE void load_texels(const float* const rows[4], int top, bool negate, W* v) {
    const float half = 0.5f * kFine * static_cast<float>(top);
    for (int k = 0; k < 16; ++k) {
        const float n = rows[k / 4][k % 4];
        const float value = std::max(n * (negate ? -half : half) + (8388608.0f + half), 8388608.0f) - 8388608.0f;
        v[k] = word(static_cast<int>(std::min(value, 2.0f * half)));
    }
}
#else
HWY_INLINE void load_texels(const float* const rows[4], int top, bool negate, W* v) {
    const Words d;
    const Floats df;
    const hn::Rebind<std::int32_t, Floats> di;
    const hn::Rebind<std::int16_t, Words> ds;
    const hn::Repartition<std::uint32_t, Words> d32;
    const hn::Repartition<std::uint64_t, Words> d64;
    // Added to 2^23 a number is rounded to a whole one, which the lowest bits of the sum then hold.
    constexpr float kWhole = 8388608.0f;
    const float half = 0.5f * kFine * static_cast<float>(top);
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

// Sums of coarse precision take the high parts of values for these.
enum class Precision { coarse, full };

template <Precision kPrecision>
HWY_INLINE void make_group(const W* v, Group& group) {
    const Words d;
    const Floats df;
    const hn::Rebind<std::uint32_t, Floats> du;
    W least = v[0];
    W greatest = v[0];
    for (int k = 1; k < 16; ++k) {
        least = hn::Min(least, v[k]);
        greatest = hn::Max(greatest, v[k]);
    }
    // Values are multiplied by the power of two that takes the greatest to 32768 to 65535.
    HWY_ALIGN std::uint16_t ranges[kLanes], bases[kLanes], factors[kLanes];
    hn::Store(hn::Sub(greatest, least), d, ranges);
    hn::Store(least, d, bases);
    for (int i = 0; i < lanes(); i += float_lanes()) {
        const F range = load_words(ranges + i);
        const auto exponent = hn::And(hn::BitCast(du, hn::Max(range, constant(1.0f))), hn::Set(du, 0x7F800000u));
        const F factor = hn::BitCast(df, hn::Sub(hn::Set(du, (2u * 127u + 15u) << 23), exponent));
        const F per_unit = hn::Mul(factor, constant(kFine));
        store_words(factor, factors + i);
        hn::Store(per_unit, df, group.per_unit + i);
        hn::Store(hn::Div(constant(1.0f), per_unit), df, group.unit + i);  // exact: powers of two
        hn::Store(hn::Mul(range, factor), df, group.greatest + i);
        hn::Store(hn::Mul(load_words(bases + i), constant(1.0f / kFine)), df, group.base + i);
    }
    const W factor = hn::Load(d, factors);
    W high_sum = hn::Zero(d);
    W low_sum = hn::Zero(d);
    for (int k = 0; k < 16; ++k) {
        const W value = hn::Mul(hn::Sub(v[k], least), factor);
        const W high = hn::AverageRound(hn::ShiftRight<6>(value), hn::Zero(d));
        hn::Store(value, d, group.values + k * lanes());
        hn::Store(high, d, group.high + k * lanes());
        high_sum = hn::Add(high_sum, high);
        if constexpr (kPrecision == Precision::full) {
            const W low = hn::Sub(value, hn::ShiftLeft<7>(high));
            hn::Store(hn::BitCast(hn::Rebind<std::int16_t, Words>(), low), hn::Rebind<std::int16_t, Words>(), group.low + k * lanes());
            low_sum = hn::Add(low_sum, low);
        }
    }
    HWY_ALIGN std::uint16_t high_sums[kLanes], low_sums[kLanes];
    hn::Store(high_sum, d, high_sums);
    hn::Store(hn::Add(low_sum, word(1024)), d, low_sums);
    for (int i = 0; i < lanes(); i += float_lanes()) {
        const F sum = hn::Mul(load_words(high_sums + i), constant(kHighUnit));
        hn::Store(sum, df, group.high_sum + i);
        hn::Store(hn::Add(sum, hn::Sub(load_words(low_sums + i), constant(1024.0f))), df, group.sum + i);
    }
}

// The 8 bytes of one channel's blocks, as words.
struct BlockWords {
    W w[4];
};

// Blocks of two channels, 16 bytes each, one after the other.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE void store_blocks(const BlockWords& first, const BlockWords& second, std::byte* blocks) {
    for (int k = 0; k < 4; ++k) {
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
            const auto blocks_m = m % 2 ? hn::InterleaveUpper(d64, a(m / 2), b(m / 2)) : hn::InterleaveLower(d64, a(m / 2), b(m / 2));
            hn::StoreU(hn::BitCast(d8, blocks_m), d8, to + (2 * m + h) * 2 * lanes());
        }
    };
    store(hn::InterleaveLower(d, first.w[0], first.w[1]), hn::InterleaveLower(d, first.w[2], first.w[3]),
          hn::InterleaveLower(d, second.w[0], second.w[1]), hn::InterleaveLower(d, second.w[2], second.w[3]), 0);
    store(hn::InterleaveUpper(d, first.w[0], first.w[1]), hn::InterleaveUpper(d, first.w[2], first.w[3]),
          hn::InterleaveUpper(d, second.w[0], second.w[1]), hn::InterleaveUpper(d, second.w[2], second.w[3]), 1);
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace tex
HWY_AFTER_NAMESPACE();

#endif
