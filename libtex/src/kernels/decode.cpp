// SPDX-License-Identifier: Apache-2.0
//
// Blocks: a palette is a row of fractions with whole numerators and denominators, computed in one vector. If vectors
// hold eight floats, texels are looked up in it eight at a time. Otherwise the decoders of the blocks are used, which
// give the same bytes.

#include "kernels/decode.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "blocks/bc1.h"
#include "blocks/bc4.h"
#include "blocks/eac.h"
#include "blocks/extent.h"
#include "kernels/samples.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/decode.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR && HWY_MAX_BYTES >= 32

using D8 = hn::CappedTag<float, 8>;
using V8 = hn::Vec<D8>;
using U8 = hn::RebindToUnsigned<D8>;

// Entry k of a palette is (first[k] e0 + second[k] e1 + plus[k]) / over[k].
struct Fractions {
    alignas(32) float first[8];
    alignas(32) float second[8];
    alignas(32) float plus[8];
    alignas(32) float over[8];
};

// Sevenths, and fifths with the lowest and the greatest value, of codes; code `one` represents 1.
constexpr Fractions Sevenths(float one) {
    return {{1, 0, 6, 5, 4, 3, 2, 1},
            {0, 1, 1, 2, 3, 4, 5, 6},
            {},
            {one, one, 7 * one, 7 * one, 7 * one, 7 * one, 7 * one, 7 * one}};
}
constexpr Fractions Fifths(float one, float lowest) {
    return {{1, 0, 4, 3, 2, 1, 0, 0},
            {0, 1, 1, 2, 3, 4, 0, 0},
            {0, 0, 0, 0, 0, 0, lowest * one, one},
            {one, one, 5 * one, 5 * one, 5 * one, 5 * one, one, one}};
}
// Thirds, and halves with black, of 8-bit codes. All are there twice, because there are eight lanes.
constexpr Fractions kThirds = {
    {1, 0, 2, 1, 1, 0, 2, 1}, {0, 1, 1, 2, 0, 1, 1, 2}, {}, {255, 255, 765, 765, 255, 255, 765, 765}};
constexpr Fractions kHalves = {
    {1, 0, 1, 0, 1, 0, 1, 0}, {0, 1, 1, 0, 0, 1, 1, 0}, {}, {255, 255, 510, 255, 255, 255, 510, 255}};
constexpr Fractions kUnorm[2] = {Fifths(255, 0), Sevenths(255)};
constexpr Fractions kSnorm[2] = {Fifths(127, -1), Sevenths(127)};

HWY_INLINE V8 Palette(const Fractions& fractions, int e0, int e1) {
    const D8 d;
    const V8 first = hn::Mul(hn::Load(d, fractions.first), hn::Set(d, static_cast<float>(e0)));
    const V8 second = hn::Mul(hn::Load(d, fractions.second), hn::Set(d, static_cast<float>(e1)));
    const V8 sum = hn::Add(hn::Add(first, second), hn::Load(d, fractions.plus));
    return hn::Div(sum, hn::Load(d, fractions.over));
}

// Two rows of four texels. The index of texel k begins at bit shifts[k].
HWY_INLINE void LookUpTwoRows(V8 palette, std::uint32_t bits, const std::uint32_t* shifts, std::uint32_t mask,
                              float* out, std::ptrdiff_t stride) {
    const D8 d;
    const U8 du;
    const hn::CappedTag<float, 4> d4;
    const auto index = hn::And(hn::Shr(hn::Set(du, bits), hn::Load(du, shifts)), hn::Set(du, mask));
    const V8 values = hn::TableLookupLanes(palette, hn::IndicesFromVec(d, index));
    hn::StoreU(hn::LowerHalf(d4, values), d4, out);
    hn::StoreU(hn::UpperHalf(d4, values), d4, out + stride);
}

template <class T>
HWY_INLINE T Load(const std::byte* p) {
    T value;
    std::memcpy(&value, p, sizeof value);
    return value;
}

template <bool kSigned>
HWY_INLINE void DecodeBc4(const std::byte* block, float* out, std::ptrdiff_t stride) {
    alignas(32) static constexpr std::uint32_t kShifts[8] = {0, 3, 6, 9, 12, 15, 18, 21};
    const auto all = Load<std::uint64_t>(block);
    int e0 = static_cast<int>(all & 0xff);
    int e1 = static_cast<int>(all >> 8 & 0xff);
    if (kSigned) {
        e0 = static_cast<std::int8_t>(e0);
        e1 = static_cast<std::int8_t>(e1);
    }
    const Fractions& fractions = (kSigned ? kSnorm : kUnorm)[e0 > e1 ? 1 : 0];
    const V8 palette =
        kSigned ? Palette(fractions, std::max(e0, -127), std::max(e1, -127)) : Palette(fractions, e0, e1);
    LookUpTwoRows(palette, static_cast<std::uint32_t>(all >> 16 & 0xffffff), kShifts, 7, out, stride);
    LookUpTwoRows(palette, static_cast<std::uint32_t>(all >> 40), kShifts, 7, out + 2 * stride, stride);
}

// Four modifiers, then the other four. All palettes are rows of 8 floats.
struct EacTables {
    alignas(32) float rows[kEacTables][8];
};
constexpr EacTables kModifiers = [] {
    EacTables tables{};
    for (int t = 0; t < kEacTables; ++t) {
        for (int k = 0; k < 8; ++k) tables.rows[t][k] = static_cast<float>(kEacModifiers[t][k]);
    }
    return tables;
}();

template <bool kSigned>
HWY_INLINE void DecodeEac(const std::byte* block, float* out, std::ptrdiff_t stride) {
    // Columns 0 and 1 in the upper 24 bits, 2 and 3 in the lower ones; two rows in eight lanes.
    alignas(32) static constexpr std::uint32_t kShifts[8] = {21, 9, 21, 9, 18, 6, 18, 6};
    alignas(32) static constexpr std::uint32_t kUpper[8] = {~0u, ~0u, 0, 0, ~0u, ~0u, 0, 0};
    const D8 d;
    const U8 du;
    const int first = static_cast<int>(block[0]);
    const int second = static_cast<int>(block[1]);
    const int base = kSigned ? std::max<int>(static_cast<std::int8_t>(first), -127) : first;
    const int multiplier = second >> 4;
    const float scale = multiplier == 0 ? 1.0f : static_cast<float>(8 * multiplier);
    const V8 middle = hn::Set(d, static_cast<float>(8 * base + (kSigned ? 0 : 4)));
    const V8 codes = hn::Add(middle, hn::Mul(hn::Load(d, kModifiers.rows[second & 15]), hn::Set(d, scale)));
    const V8 most = hn::Set(d, kSigned ? 1023.0f : 2047.0f);
    const V8 least = hn::Set(d, kSigned ? -1023.0f : 0.0f);
    const V8 palette = hn::Div(hn::Min(hn::Max(codes, least), most), most);
    const auto byte = [&](int k) { return static_cast<std::uint32_t>(block[k]); };
    const auto upper = hn::Set(du, byte(2) << 16 | byte(3) << 8 | byte(4));
    const auto lower = hn::Set(du, byte(5) << 16 | byte(6) << 8 | byte(7));
    const auto is_upper = hn::Load(du, kUpper);
    const auto bits = hn::Or(hn::And(is_upper, upper), hn::AndNot(is_upper, lower));
    const hn::CappedTag<float, 4> d4;
    for (int pair = 0; pair < 2; ++pair) {
        const auto shifts = hn::Sub(hn::Load(du, kShifts), hn::Set(du, static_cast<std::uint32_t>(6 * pair)));
        const auto index = hn::And(hn::Shr(bits, shifts), hn::Set(du, 7u));
        const V8 values = hn::TableLookupLanes(palette, hn::IndicesFromVec(d, index));
        hn::StoreU(hn::LowerHalf(d4, values), d4, out + 2 * pair * stride);
        hn::StoreU(hn::UpperHalf(d4, values), d4, out + (2 * pair + 1) * stride);
    }
}

// The colours of a BC1 block. A null pointer marks a channel that is not needed.
HWY_INLINE void DecodeBc1(const std::byte* block, Bc1Mode mode, const ChannelRows& rows, std::ptrdiff_t at,
                          std::ptrdiff_t stride) {
    alignas(32) static constexpr std::uint32_t kShifts[8] = {0, 2, 4, 6, 8, 10, 12, 14};
    const int c0 = Load<std::uint16_t>(block);
    const int c1 = Load<std::uint16_t>(block + 2);
    const auto indices = Load<std::uint32_t>(block + 4);
    const bool four = mode == Bc1Mode::four_colors || c0 > c1;
    const Fractions& fractions = four ? kThirds : kHalves;
    const auto channel = [&](float* out, V8 palette) {
        LookUpTwoRows(palette, indices & 0xffff, kShifts, 3, out + at, stride);
        LookUpTwoRows(palette, indices >> 16, kShifts, 3, out + at + 2 * stride, stride);
    };
    const auto five = [](int code) { return code << 3 | code >> 2; };
    const auto six = [](int code) { return code << 2 | code >> 4; };
    if (rows.channel[0] != nullptr) channel(rows.channel[0], Palette(fractions, five(c0 >> 11), five(c1 >> 11)));
    if (rows.channel[1] != nullptr) channel(rows.channel[1], Palette(fractions, six(c0 >> 5 & 63), six(c1 >> 5 & 63)));
    if (rows.channel[2] != nullptr) channel(rows.channel[2], Palette(fractions, five(c0 & 31), five(c1 & 31)));
    if (rows.channel[3] != nullptr && mode == Bc1Mode::standard) {
        alignas(32) static constexpr float kOpaque[8] = {1, 1, 1, 1, 1, 1, 1, 1};
        alignas(32) static constexpr float kPunched[8] = {1, 1, 1, 0, 1, 1, 1, 0};
        channel(rows.channel[3], hn::Load(D8(), four ? kOpaque : kPunched));
    }
}

HWY_INLINE void DecodeBc2Alpha(const std::byte* block, float* out, std::ptrdiff_t stride) {
    float a[16];
    decode_bc2_alpha(block, a);
    for (int k = 0; k < 4; ++k) std::memcpy(out + k * stride, a + 4 * k, 4 * sizeof(float));
}

template <auto kDecode>
HWY_INLINE void DecodeHalves(const std::byte* blocks, std::ptrdiff_t step, std::ptrdiff_t end, float* r, float* g,
                             std::ptrdiff_t stride) {
    for (std::ptrdiff_t at = 0; at < end; at += 4, blocks += step) {
        if (r != nullptr) kDecode(blocks, r + at, stride);
        if (g != nullptr) kDecode(blocks + 8, g + at, stride);
    }
}

void DecodeBlocks(Format format, const std::byte* blocks, int count, const ChannelRows& rows, std::ptrdiff_t stride) {
    float* const r = rows.channel[0];
    float* const g = rows.channel[1];
    float* const a = rows.channel[3];
    const bool color = r != nullptr || g != nullptr || rows.channel[2] != nullptr;
    const std::ptrdiff_t end = std::ptrdiff_t{4} * count;
    const auto step = static_cast<std::ptrdiff_t>(format_info(format).block_bytes);
    switch (format) {
        case Format::bc1_unorm:
            for (std::ptrdiff_t at = 0; at < end; at += 4, blocks += 8)
                DecodeBc1(blocks, Bc1Mode::standard, rows, at, stride);
            break;
        case Format::bc2_unorm:
            for (std::ptrdiff_t at = 0; at < end; at += 4, blocks += 16) {
                if (a != nullptr) DecodeBc2Alpha(blocks, a + at, stride);
                if (color) DecodeBc1(blocks + 8, Bc1Mode::four_colors, rows, at, stride);
            }
            break;
        case Format::bc3_unorm:
            for (std::ptrdiff_t at = 0; at < end; at += 4, blocks += 16) {
                if (a != nullptr) DecodeBc4<false>(blocks, a + at, stride);
                if (color) DecodeBc1(blocks + 8, Bc1Mode::four_colors, rows, at, stride);
            }
            break;
        case Format::bc4_unorm:
        case Format::bc5_unorm: return DecodeHalves<DecodeBc4<false>>(blocks, step, end, r, g, stride);
        case Format::bc4_snorm:
        case Format::bc5_snorm: return DecodeHalves<DecodeBc4<true>>(blocks, step, end, r, g, stride);
        case Format::eac_r11_unorm:
        case Format::eac_rg11_unorm: return DecodeHalves<DecodeEac<false>>(blocks, step, end, r, g, stride);
        default: return DecodeHalves<DecodeEac<true>>(blocks, step, end, r, g, stride);
    }
}

#else  // fewer than eight lanes

void StoreBlock(const float* values, float* out, std::ptrdiff_t stride) {
    if (out == nullptr) return;
    for (std::ptrdiff_t k = 0; k < 4; ++k) std::memcpy(out + k * stride, values + 4 * k, 4 * sizeof(float));
}

void DecodeBlock(Format format, const std::byte* block, float channels[4][16]) {
    float(&r)[16] = channels[0];
    float(&g)[16] = channels[1];
    float(&b)[16] = channels[2];
    float(&a)[16] = channels[3];
    switch (format) {
        case Format::bc1_unorm: return decode_bc1(block, Bc1Mode::standard, r, g, b, a);
        case Format::bc2_unorm:
            decode_bc1(block + 8, Bc1Mode::four_colors, r, g, b, a);
            return decode_bc2_alpha(block, a);
        case Format::bc3_unorm:
            decode_bc1(block + 8, Bc1Mode::four_colors, r, g, b, a);
            return decode_bc4_unorm(block, a);
        case Format::bc4_unorm: return decode_bc4_unorm(block, r);
        case Format::bc4_snorm: return decode_bc4_snorm(block, r);
        case Format::bc5_unorm: decode_bc4_unorm(block, r); return decode_bc4_unorm(block + 8, g);
        case Format::bc5_snorm: decode_bc4_snorm(block, r); return decode_bc4_snorm(block + 8, g);
        case Format::eac_r11_unorm: return decode_eac_unorm(block, r);
        case Format::eac_r11_snorm: return decode_eac_snorm(block, r);
        case Format::eac_rg11_unorm: decode_eac_unorm(block, r); return decode_eac_unorm(block + 8, g);
        default: decode_eac_snorm(block, r); return decode_eac_snorm(block + 8, g);
    }
}

void DecodeBlocks(Format format, const std::byte* blocks, int count, const ChannelRows& rows, std::ptrdiff_t stride) {
    const FormatInfo info = format_info(format);
    for (std::ptrdiff_t at = 0; at < std::ptrdiff_t{4} * count; at += 4, blocks += info.block_bytes) {
        float channels[4][16];
        DecodeBlock(format, blocks, channels);
        for (int c = 0; c < info.channels; ++c) {
            if (rows.channel[c] != nullptr) StoreBlock(channels[c], rows.channel[c] + at, stride);
        }
    }
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

void decode_texels(Format format, const std::byte* texels, int count, const ChannelRows& rows) {
    const FormatInfo info = format_info(format);
    const std::size_t sample_bytes = static_cast<std::size_t>(info.bits) / 8;
    for (int c = 0; c < info.channels; ++c) {
        if (rows.channel[c] == nullptr) continue;
        const std::byte* first = texels + static_cast<std::size_t>(c) * sample_bytes;
        decode_samples(info.sample, info.bits, first, info.block_bytes, count, rows.channel[c]);
    }
}

TEX_KERNEL(void, decode_blocks, DecodeBlocks,
           (Format format, const std::byte* blocks, int width, const ChannelRows& rows, std::ptrdiff_t stride),
           (format, blocks, blocks_across(width), rows, stride))

}  // namespace tex::inline v1
#endif
