// SPDX-License-Identifier: Apache-2.0
// uastc_lanes-inl.h: codes of UASTC blocks side by side. Include it after hwy/highway.h, once for each target.

#if defined(TEX_KERNELS_UASTC_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_UASTC_LANES_INL_H
#undef TEX_KERNELS_UASTC_LANES_INL_H
#else
#define TEX_KERNELS_UASTC_LANES_INL_H
#endif

#include <hwy/highway.h>

#include "kernels/bc7_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Endpoints are numbers in the order of their values. The values of a range are symmetric, and those of the lower half
// are the floor of first + step k.
struct UastcRange {
    float last, first, step;
};

HWY_INLINE UastcRange UastcRangeOf(int range) {
    switch (range) {
        case 7: return {11.0f, 0.1f, 23.2f};
        case 8: return {15.0f, 0.5f, 17.0f};
        case 11: return {31.0f, 0.125f, 8.25f};
        case 12: return {39.0f, 0.25f, 6.5f};
        case 18: return {159.0f, 0.1f, 1.6f};
        case 19: return {191.0f, 0.1668f, 1.33333f};
        default: return {255.0f, 0.5f, 1.0f};
    }
}

// How UASTC makes codes: as decoders of ASTC do, with endpoints of 16 bits.
struct UastcRules {
    static constexpr float kScale = 257.0f / 256.0f, kOffset = 32.0f / 16384.0f, kStep = 257.0f / 16384.0f;
    static constexpr bool kPairs = true;

    static HWY_INLINE float Top(int range) { return UastcRangeOf(range).last; }
    // Endpoints of many values are far apart in numbers: they move by more at first.
    static HWY_INLINE float Stride(int range, int round) {
        constexpr int kFine = 18;
        const int first = range < kFine ? 1 : 2;
        return round < first ? static_cast<float>(1 << (first - round)) : 1.0f;
    }
    static HWY_INLINE FloatVec Widen(FloatVec number, int range) {
        const UastcRange r = UastcRangeOf(range);
        const FloatVec other = hn::Sub(Bc7Number(r.last), number), least = hn::Min(number, other);
        const FloatVec low = hn::Floor(MulThenAdd(least, Bc7Number(r.step), Bc7Number(r.first)));
        return hn::IfThenElse(hn::Le(number, other), low, hn::Sub(Bc7Number(255.0f), low));
    }
    static HWY_INLINE FloatVec Round(FloatVec value, int range) {
        const float top = Top(range);
        return Bc7Clamp(hn::Floor(MulThenAdd(value, Bc7Number(top / 255.0f), Bc7Number(0.5f))), top);
    }
    static HWY_INLINE FloatVec Round(FloatVec value, int range, FloatVec /*lowest*/) { return Round(value, range); }
    // 4, 8, 16 or 32 levels: the bits are repeated, and weights above 32 are one more.
    static HWY_INLINE float Weight(int index, int levels) {
        const int step = levels == 4 ? 21 : levels == 8 ? 9 : levels == 16 ? 4 : 2;
        const int more = levels == 16 ? index / 4 : levels == 32 ? index / 16 : 0;
        return static_cast<float>(step * index + more + (2 * index >= levels ? 1 : 0));
    }
    static HWY_INLINE FloatVec Weight(FloatVec index, int levels) {
        const float step = levels == 4 ? 21.0f : levels == 8 ? 9.0f : levels == 16 ? 4.0f : 2.0f;
        const FloatTag d;
        FloatVec weight = hn::Mul(index, Bc7Number(step));
        if (levels > 8)
            weight = hn::Add(weight, hn::Floor(hn::Mul(index, Bc7Number(levels == 16 ? 0.25f : 1.0f / 16.0f))));
        const FloatMask above = hn::Ge(index, Bc7Number(0.5f * static_cast<float>(levels)));
        return hn::Add(weight, hn::IfThenElse(above, Bc7Number(1.0f), hn::Zero(d)));
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif  // once for each target
