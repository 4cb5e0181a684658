// SPDX-License-Identifier: Apache-2.0

#include "kernels/samples.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/samples.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;

// Codes divided by the greatest code.
template <class Codes>
HWY_INLINE V Fraction(D d, Codes codes, float one) {
    return hn::Div(hn::ConvertTo(d, hn::PromoteTo(hn::RebindToSigned<D>(), codes)), hn::Set(d, one));
}

template <class Codes>
HWY_INLINE V SignedFraction(D d, Codes codes, float one) {
    return hn::Max(Fraction(d, codes, one), hn::Set(d, -1.0f));
}

// Moves exponents from half's bias to float's by adding 112. Zero and values below 2^-14 have no leading one: it is
// added, then subtracted. Infinity and NaN get float's greatest exponent. (The hardware conversion is not used because
// it makes NaN quiet, which is not done elsewhere.)
template <class Halves>
HWY_INLINE V FromHalf(D d, Halves halves) {
    const hn::RebindToUnsigned<D> du;
    const auto bits = hn::PromoteTo(du, halves);
    const auto exponent = hn::And(bits, hn::Set(du, 0x7c00u));
    const auto magnitude = hn::ShiftLeft<13>(hn::And(bits, hn::Set(du, 0x7fffu)));
    const auto normal = hn::Add(magnitude, hn::Set(du, 112u << 23));
    const auto special = hn::Or(magnitude, hn::Set(du, 0x7f800000u));
    const auto small =
        hn::Sub(hn::BitCast(d, hn::Or(magnitude, hn::Set(du, 113u << 23))), hn::BitCast(d, hn::Set(du, 113u << 23)));
    auto value = hn::IfThenElse(hn::Eq(exponent, hn::Set(du, 0x7c00u)), special, normal);
    value = hn::IfThenElse(hn::Eq(exponent, hn::Zero(du)), hn::BitCast(du, small), value);
    return hn::BitCast(d, hn::Or(value, hn::ShiftLeft<16>(hn::And(bits, hn::Set(du, 0x8000u)))));
}

// Samples are collected in a separate row, so that whole vectors may be read past the last one.
template <class T, class Convert>
void Decode(const std::byte* first, std::size_t step, int count, float* out, const Convert& convert) {
    const D d;
    const hn::Rebind<T, D> stored;
    constexpr int kChunk = 256;
    alignas(64) T picked[kChunk] = {};
    alignas(64) float values[kChunk];
    for (int i = 0; i < count; i += kChunk) {
        const auto n = static_cast<std::size_t>(std::min(kChunk, count - i));
        if (step == sizeof(T)) {
            std::memcpy(picked, first, n * sizeof(T));
        } else {
            for (std::size_t k = 0; k < n; ++k) std::memcpy(&picked[k], first + k * step, sizeof(T));
        }
        first += n * step;
        for (std::size_t k = 0; k < n; k += hn::Lanes(d))
            hn::Store(convert(d, hn::Load(stored, picked + k)), d, values + k);
        std::memcpy(out + i, values, n * sizeof(float));
    }
}

void DecodeSamples(SampleKind sample, int bits, const std::byte* first, std::size_t step, int count, float* out) {
    if (sample == SampleKind::unorm && bits == 8) {
        Decode<std::uint8_t>(first, step, count, out, [](D d, auto codes) { return Fraction(d, codes, 255.0f); });
    } else if (sample == SampleKind::unorm) {
        Decode<std::uint16_t>(first, step, count, out, [](D d, auto codes) { return Fraction(d, codes, 65535.0f); });
    } else if (sample == SampleKind::snorm && bits == 8) {
        Decode<std::int8_t>(first, step, count, out, [](D d, auto codes) { return SignedFraction(d, codes, 127.0f); });
    } else if (sample == SampleKind::snorm) {
        Decode<std::int16_t>(first, step, count, out,
                             [](D d, auto codes) { return SignedFraction(d, codes, 32767.0f); });
    } else if (bits == 16) {
        Decode<std::uint16_t>(first, step, count, out, [](D d, auto halves) { return FromHalf(d, halves); });
    } else {
        for (int i = 0; i < count; ++i, first += step) std::memcpy(out + i, first, sizeof(float));
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, decode_samples, DecodeSamples,
           (SampleKind sample, int bits, const std::byte* first, std::size_t step, int count, float* out),
           (sample, bits, first, step, count, out))

}  // namespace tex::inline v1
#endif
