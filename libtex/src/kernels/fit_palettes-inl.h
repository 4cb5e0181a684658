// SPDX-License-Identifier: Apache-2.0
// fit_palettes-inl.h: finds blocks whose values lie on a palette, as in blocks that were decoded before.
//
// If the least and the greatest value are the p-th and the q-th entry of a palette, they determine its endpoints. For
// each p and q, these endpoints are offered if they can be stored as codes and all values lie on the palette.
//
// Compiled once for each Highway target, as part of fit.cpp.

#if defined(TEX_KERNELS_FIT_PALETTES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_FIT_PALETTES_INL_H
#undef TEX_KERNELS_FIT_PALETTES_INL_H
#else
#define TEX_KERNELS_FIT_PALETTES_INL_H
#endif

#include <hwy/highway.h>

#include "kernels/fit_group-inl.h"
#include "kernels/fit_steps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

// Set if the first `texels` of a block lie on a grid that divides its range into kSpan spacings, within the rounding of
// values to 1/128 of a code.
template <int kSpan>
HWY_INLINE W on_grid(const Group& group, int texels) {
    const Words d;
    constexpr float kUnit = static_cast<float>(1 << kIndexBits);
    F factor[kParts], tolerance[kParts];
    for (int p = 0; p < kParts; ++p) {
        const F per_value =
            hn::Div(constant(kUnit * static_cast<float>(kSpan)), hn::Max(group.greatest[p], constant(32768.0f)));
        factor[p] = hn::Mul(per_value, constant(65536.0f));
        tolerance[p] =
            hn::Min(hn::Add(hn::Mul(hn::Mul(group.per_unit[p], constant(1.0f / kFine)), per_value), constant(2.0f)),
                    constant(0.25f * kUnit));
    }
    const W by = to_words(factor);
    const W below = to_words(tolerance);
    const W fraction = word((1 << kIndexBits) - 1);
    W most = hn::Zero(d);
    for (int k = 0; k < texels; ++k)
        most = hn::Max(most, hn::And(hn::Add(hn::MulHigh(group.values[k], by), below), fraction));
    const W limit = hn::Add(below, below);
    return hn::VecFromMask(d, hn::Eq(hn::Max(most, limit), limit));
}

// Whether any of the blocks that are set in `among` lies on a grid. Half of the texels are enough to reject most
// others.
template <int kSpan>
HWY_INLINE bool any_on_grid(const Group& group, W among) {
    const auto any = [&](int texels) {
        const Words d;
        return !hn::AllTrue(d, hn::Eq(hn::And(on_grid<kSpan>(group, texels), among), hn::Zero(d)));
    };
    return any(8) && any(16);
}

// Offers the palettes on which the values span kSpan spacings.
template <class Kind, int kSpan>
HWY_INLINE void offer_palettes(const Group& group, W among, Kind kind, Choice& choice) {
    constexpr float kMostOff = 1.0f / 16.0f;  // of endpoints, in codes; the rounding of values accounts for 1/20
    const Floats d;
    const Fitter<Kind> fitter(group, kind);
    const W on_palette = hn::And(on_grid<kSpan>(group, 16), among);
    if (hn::AllTrue(Words(), hn::Eq(on_palette, hn::Zero(Words())))) return;
    const Parts on = to_floats(on_palette);
    Ends ends = choice;
    auto none = hn::Eq(constant(0.0f), constant(0.0f));
    for (int p = 0; p < kParts; ++p) {
        F least_off = hn::IfThenElseZero(hn::Gt(on.part[p], hn::Zero(d)), constant(kMostOff));
        none = hn::And(none, hn::Eq(least_off, hn::Zero(d)));
        const F spacing = hn::Mul(group.greatest[p], constant(1.0f / static_cast<float>(kSpan)));
        for (int first = 0; first + kSpan <= Kind::kSteps; ++first) {
            const F a = hn::Mul(spacing, constant(-static_cast<float>(first)));
            const F low = fitter.code(a, p);
            const F high = fitter.code(hn::Add(a, hn::Mul(spacing, constant(static_cast<float>(Kind::kSteps)))), p);
            F stored_low = low;
            F stored_high = high;
            kind.round(stored_low, stored_high);
            const F off =
                hn::Max(hn::Abs(hn::Sub(kind.widen(stored_low), low)), hn::Abs(hn::Sub(kind.widen(stored_high), high)));
            const auto nearer = hn::Lt(off, least_off);
            least_off = hn::IfThenElse(nearer, off, least_off);
            ends.low[p] = hn::IfThenElse(nearer, stored_low, ends.low[p]);
            ends.high[p] = hn::IfThenElse(nearer, stored_high, ends.high[p]);
        }
    }
    if (!hn::AllTrue(d, none)) fitter.template score<Precision::full>(ends, nullptr, choice);
}

// Not inlined: few groups of blocks need these. Values that span one, two or three spacings also lie on the grids of
// four or six.
template <int kSpan>
HWY_NOINLINE void offer_bc4_palettes(const Group& group, W among, float top, Choice& eight, Choice& six) {
    offer_palettes<EightValues, kSpan>(group, among, {top}, eight);
    if constexpr (kSpan <= SixValues::kSteps) offer_palettes<SixValues, kSpan>(group, among, {top}, six);
}

HWY_INLINE void offer_bc4_palettes(const Group& group, W among, float top, Choice& eight, Choice& six) {
    if (any_on_grid<4>(group, among)) {
        offer_bc4_palettes<4>(group, among, top, eight, six);
        offer_bc4_palettes<2>(group, among, top, eight, six);
        offer_bc4_palettes<1>(group, among, top, eight, six);
    }
    if (any_on_grid<5>(group, among)) offer_bc4_palettes<5>(group, among, top, eight, six);
    if (any_on_grid<6>(group, among)) {
        offer_bc4_palettes<6>(group, among, top, eight, six);
        offer_bc4_palettes<3>(group, among, top, eight, six);
    }
}

HWY_INLINE void offer_green_palettes(const Group& group, W among, Choice& choice) {
    if (!any_on_grid<2>(group, among)) return;
    offer_palettes<Greens, 2>(group, among, {}, choice);
    offer_palettes<Greens, 1>(group, among, {}, choice);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif
