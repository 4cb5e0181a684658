// SPDX-License-Identifier: Apache-2.0
// fit_kinds-inl.h: the palettes that the fits know: how each rounds its endpoints, and how values become indices.
//
// Compiled once for each Highway target, as part of fit.cpp.

#if defined(TEX_KERNELS_FIT_KINDS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_FIT_KINDS_INL_H
#undef TEX_KERNELS_FIT_KINDS_INL_H
#else
#define TEX_KERNELS_FIT_KINDS_INL_H
#endif

#include <hwy/highway.h>

#include "kernels/fit_group-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

HWY_INLINE F clamped(F value, float most) { return hn::Min(hn::Max(value, hn::Zero(Floats())), constant(most)); }
HWY_INLINE F rounded(F value) { return hn::Floor(hn::Add(value, constant(0.5f))); }

// BC4 with 8 values: different endpoints of 8 bits.
struct EightValues {
    static constexpr int kSteps = 7;
    float top;

    // An endpoint of p / q codes, as the stored code that round_stored() rounds. If p and q are exact, so is the
    // rounded code, halves upwards: p / q + 1/2 is rounded once, and too far from the next whole number to reach it.
    HWY_INLINE F stored(F p, F q) const {
        return hn::Sub(hn::Div(hn::Add(p, hn::Mul(q, constant(0.5f))), q), constant(0.5f));
    }

    // Rounds endpoints, in codes, to values that the block can hold.
    HWY_INLINE void round(F& low, F& high) const { round_stored(low, high); }
    HWY_INLINE void round_stored(F& low, F& high) const {
        const F a = clamped(rounded(low), top);
        const F b = clamped(rounded(high), top);
        // Equal endpoints would mean 6 values, so take the codes on both sides.
        const F floor = clamped(hn::Floor(low), top - 1.0f);
        const auto apart = hn::Gt(b, a);
        low = hn::IfThenElse(apart, a, floor);
        high = hn::IfThenElse(apart, b, hn::Add(floor, constant(1.0f)));
    }
    // The 8-bit codes that the decoder makes from these codes.
    HWY_INLINE F widen(F code) const { return code; }
};

// BC4 with 6 values. The lowest and the greatest code are not used here.
struct SixValues {
    static constexpr int kSteps = 5;
    float top;

    HWY_INLINE void round(F& low, F& high) const {
        low = clamped(rounded(low), top);
        high = hn::Max(clamped(rounded(high), top), low);
    }
    HWY_INLINE F widen(F code) const { return code; }
};

// DXT5nm's green: 4 values, endpoints of 6 bits.
struct Greens {
    static constexpr int kSteps = 3;
    float top = 63.0f;

    HWY_INLINE F stored(F p, F q) const {
        const F numerator = hn::Add(hn::Mul(p, constant(42.0f)), hn::Mul(q, constant(85.0f)));
        return hn::Sub(hn::Div(numerator, hn::Mul(q, constant(170.0f))), constant(0.5f));
    }
    HWY_INLINE void round(F& low, F& high) const {
        const F scale = constant(63.0f / 255.0f);
        low = hn::Mul(low, scale);
        high = hn::Mul(high, scale);
        round_stored(low, high);
    }
    HWY_INLINE void round_stored(F& low, F& high) const {
        const F a = clamped(rounded(low), top);
        const F b = clamped(rounded(high), top);
        low = hn::Min(a, b);
        high = hn::Max(a, b);
    }
    HWY_INLINE F widen(F code) const {
        return hn::Add(hn::Mul(code, constant(4.0f)), hn::Floor(hn::Mul(code, constant(1.0f / 16.0f))));
    }
};

// Turns a value into an index, counted from the lower endpoint. q = value * factor / 65536 + offset has 2^kIndexBits
// for each spacing. The additions saturate at both ends of the palette: k = (q - cut) / 2^kIndexBits.
struct Ramp {
    W factor, offset;
};
constexpr int kIndexBits = 11;
constexpr int cut(int steps) { return 65536 - ((steps + 1) << kIndexBits); }

HWY_INLINE W index(W value, W factor, W offset, W cut) {
    return hn::ShiftRight<kIndexBits>(hn::SaturatedSub(hn::SaturatedAdd(hn::MulHigh(value, factor), offset), cut));
}

// The ramp of local endpoints a <= b. `ties` is added to q.
template <class Kind>
HWY_INLINE Ramp make_ramp(const F (&a)[kParts], const F (&b)[kParts], const F (&ties)[kParts]) {
    constexpr float kUnit = static_cast<float>(1 << kIndexBits);
    F factor[kParts], offset[kParts];
    for (int p = 0; p < kParts; ++p) {
        const F span = hn::Sub(b[p], a[p]);
        const F exact =
            hn::Div(constant(65536.0f * kUnit * static_cast<float>(Kind::kSteps)), hn::Max(span, constant(1.0f)));
        factor[p] = hn::IfThenElseZero(hn::Gt(span, hn::Zero(Floats())), hn::Min(exact, constant(65535.0f)));
        const F start = hn::Mul(hn::Mul(a[p], factor[p]), constant(1.0f / 65536.0f));
        const F middle = hn::Add(constant(static_cast<float>(cut(Kind::kSteps)) + 0.5f * kUnit), ties[p]);
        offset[p] = clamped(hn::Sub(middle, start), 65535.0f);
    }
    return {to_words(factor), to_words(offset)};
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif
