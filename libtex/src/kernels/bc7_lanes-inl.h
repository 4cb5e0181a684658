// SPDX-License-Identifier: Apache-2.0
// bc7_lanes-inl.h: codes and errors of BC7 blocks side by side. Include it after hwy/highway.h, once for each target.

#if defined(TEX_KERNELS_BC7_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_BC7_LANES_INL_H
#undef TEX_KERNELS_BC7_LANES_INL_H
#else
#define TEX_KERNELS_BC7_LANES_INL_H
#endif

#include <hwy/highway.h>

#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Codes are relative to the middle, at which a component is 0.
inline constexpr float kBc7Middle = 127.5f;

HWY_INLINE FloatVec Bc7Number(float value) { return hn::Set(FloatTag(), value); }

// a b + c, never fused.
HWY_INLINE FloatVec MulThenAdd(FloatVec a, FloatVec b, FloatVec c) { return hn::Add(hn::Mul(a, b), c); }

HWY_INLINE FloatVec Bc7Dot(const FloatVec a[3], const FloatVec b[3]) {
    return MulThenAdd(a[0], b[0], MulThenAdd(a[1], b[1], hn::Mul(a[2], b[2])));
}

HWY_INLINE FloatVec Bc7Clamp(FloatVec value, float top) {
    return hn::Min(hn::Max(value, hn::Zero(FloatTag())), Bc7Number(top));
}

// A stored code of so many bits as one of 8: its highest bits are repeated.
HWY_INLINE FloatVec Bc7Widen(FloatVec code, int bits) {
    if (bits == 8) return code;
    const FloatVec high = Bc7Number(static_cast<float>(1 << (8 - bits)));
    const FloatVec low = Bc7Number(1.0f / static_cast<float>(1 << (2 * bits - 8)));
    return MulThenAdd(code, high, hn::Floor(hn::Mul(code, low)));
}

HWY_INLINE float Bc7Top(int bits) { return static_cast<float>((1 << bits) - 1); }

// The stored code that is nearest to a value from 0 to 255.
HWY_INLINE FloatVec Bc7Round(FloatVec value, int bits) {
    const float top = Bc7Top(bits);
    return Bc7Clamp(hn::Floor(MulThenAdd(value, Bc7Number(top / 255.0f), Bc7Number(0.5f))), top);
}

// Only codes with this lowest bit.
HWY_INLINE FloatVec Bc7Round(FloatVec value, int bits, FloatVec lowest) {
    const FloatVec half = Bc7Number(0.5f);
    const FloatVec code = hn::Sub(hn::Mul(value, Bc7Number(Bc7Top(bits) / 255.0f)), lowest);
    const FloatVec high = Bc7Clamp(hn::Floor(MulThenAdd(code, half, half)), Bc7Top(bits - 1));
    return MulThenAdd(high, Bc7Number(2.0f), lowest);
}

// The weight of the second endpoint, of 64, for an index.
HWY_INLINE float Bc7Weight(int index, int levels) {
    return static_cast<float>((2 * 64 * index + levels - 1) / (2 * (levels - 1)));
}
HWY_INLINE FloatVec Bc7Weight(FloatVec index, int levels) {
    return hn::Floor(MulThenAdd(index, Bc7Number(64.0f / static_cast<float>(levels - 1)), Bc7Number(0.5f)));
}

// The index of the level that contains a place: levels are from k to k + 1.
HWY_INLINE FloatVec Bc7Index(FloatVec place, int levels) {
    return hn::Floor(Bc7Clamp(place, static_cast<float>(levels - 1) + 0.25f));
}

// How BC7 makes codes of what a block stores. Other formats that are fitted alike have rules of their own.
struct Bc7Rules {
    // A code at the weight w is the floor of end0 kScale + kOffset + (end1 - end0) w kStep.
    static constexpr float kScale = 1.0f, kOffset = 0.5f, kStep = 1.0f / 64.0f;
    // Whether endpoints in two planes are judged by the best pair of indices, not by the nearest scalar.
    static constexpr bool kPairs = false;

    static HWY_INLINE float Top(int bits) { return Bc7Top(bits); }
    // How far endpoints move in a round.
    static HWY_INLINE float Stride(int /*bits*/, int /*round*/) { return 1.0f; }
    static HWY_INLINE FloatVec Widen(FloatVec code, int bits) { return Bc7Widen(code, bits); }
    static HWY_INLINE FloatVec Round(FloatVec value, int bits) { return Bc7Round(value, bits); }
    static HWY_INLINE FloatVec Round(FloatVec value, int bits, FloatVec lowest) {
        return Bc7Round(value, bits, lowest);
    }
    static HWY_INLINE float Weight(int index, int levels) { return Bc7Weight(index, levels); }
    static HWY_INLINE FloatVec Weight(FloatVec index, int levels) { return Bc7Weight(index, levels); }
};

// A channel between two endpoints.
template <class Rules>
struct BlockRamp {
    FloatVec base, step;      // of values before rounding down, for a weight of 0 and each 1/64
    FloatVec start, inverse;  // of indices with 1/2 added
    int levels;

    HWY_INLINE BlockRamp(FloatVec end0, FloatVec end1, int bits, int levels_) : levels(levels_) {
        const FloatTag d;
        const FloatVec e0 = Rules::Widen(end0, bits), range = hn::Sub(Rules::Widen(end1, bits), e0);
        const FloatVec some = hn::IfThenElse(hn::Eq(range, hn::Zero(d)), Bc7Number(1e9f), range);
        base = MulThenAdd(e0, Bc7Number(Rules::kScale), Bc7Number(Rules::kOffset));
        step = hn::Mul(range, Bc7Number(Rules::kStep));
        inverse = hn::Div(Bc7Number(static_cast<float>(levels - 1)), some);
        start = MulThenAdd(hn::Sub(Bc7Number(kBc7Middle), e0), inverse, Bc7Number(0.5f));
    }

    // Rounded as decoders do.
    HWY_INLINE FloatVec value(FloatVec weight) const {
        return hn::Sub(hn::Floor(MulThenAdd(weight, step, base)), Bc7Number(kBc7Middle));
    }
    HWY_INLINE FloatVec index(FloatVec value) const { return Bc7Index(MulThenAdd(value, inverse, start), levels); }
    HWY_INLINE FloatVec nearest(FloatVec v) const { return value(Rules::Weight(index(v), levels)); }
};

// The squared sine of the angle between a vector and a unit vector, and from a right angle on, 2 minus it.
HWY_INLINE FloatVec Bc7Error(const FloatVec vector[3], const FloatVec unit[3]) {
    const FloatTag d;
    const FloatVec along = Bc7Dot(vector, unit);
    FloatVec off[3];
    for (int c = 0; c < 3; ++c) off[c] = hn::Sub(vector[c], hn::Mul(along, unit[c]));
    const FloatVec squared = hn::Div(Bc7Dot(off, off), Bc7Dot(vector, vector));
    return hn::IfThenElse(hn::Lt(along, hn::Zero(d)), hn::Sub(Bc7Number(2.0f), squared), squared);
}

HWY_INLINE FloatVec Bc7AlphaError(FloatVec code, FloatVec wanted) {
    const FloatVec off = hn::Mul(hn::Sub(code, wanted), Bc7Number(1.0f / kBc7Middle));
    return hn::Mul(off, off);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif  // once for each target
