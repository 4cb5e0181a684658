// SPDX-License-Identifier: Apache-2.0
// fit_exact-inl.h: the plain fit, and errors without shortcuts: what keeps `normal` from ever losing to it.
//
// Compiled once for each Highway target, as part of fit.cpp.
//
// Fits count in whole local units, which is quick, but where two endpoints are nearly equally good they may choose the worse ones, and
// a texel near the middle between two values the wrong index. Here values have 1/256 of a code, and sums are floats.

#if defined(TEX_KERNELS_FIT_EXACT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_FIT_EXACT_INL_H
#undef TEX_KERNELS_FIT_EXACT_INL_H
#else
#define TEX_KERNELS_FIT_EXACT_INL_H
#endif

#include <hwy/highway.h>

#include "kernels/fit_group-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex {
namespace HWY_NAMESPACE {

// What follows from the nearest indices k of the texels v for stored endpoints.
struct Moments {
    F error;  // the squared error in codes
    F k, kk, v, kv;
};

// One vector of floats of a group's blocks, from lane `at` on.
template <class Kind>
class Exact {
public:
    Exact(const Group& group, Kind kind, int at) : group_(group), kind_(kind), at_(at) {}

    [[nodiscard]] HWY_INLINE F value(int texel) const {
        const Floats d;
        const hn::Rebind<std::uint16_t, Floats> dw;
        const hn::Rebind<std::int32_t, Floats> di;
        const auto fine = hn::Load(dw, group_.fine + texel * lanes() + at_);
        return hn::Mul(hn::ConvertTo(d, hn::PromoteTo(di, fine)), constant(1.0f / kUnit));
    }

    // The index of the palette's value that is nearest to v, counted from the lower endpoint.
    [[nodiscard]] HWY_INLINE F index(F v, F low, F scale) const {
        const F k = hn::Floor(hn::Add(hn::Mul(hn::Sub(v, low), scale), constant(0.5f)));
        return hn::Min(hn::Max(k, hn::Zero(Floats())), constant(kSteps));
    }
    // Indices for each code above the lower endpoint.
    [[nodiscard]] HWY_INLINE F scale(F span) const {
        const Floats d;
        return hn::IfThenElseZero(hn::Gt(span, hn::Zero(d)), hn::Div(constant(kSteps), hn::Max(span, constant(1.0f))));
    }

    [[nodiscard]] Moments measure(F stored_low, F stored_high) const {
        const F low = kind_.widen(stored_low);
        const F span = hn::Sub(kind_.widen(stored_high), low);
        const F per_code = scale(span);
        const F spacing = hn::Div(span, constant(kSteps));
        const F zero = hn::Zero(Floats());
        Moments m{zero, zero, zero, zero, zero};
        for (int texel = 0; texel < 16; ++texel) {
            const F v = value(texel);
            const F k = index(v, low, per_code);
            const F off = hn::Sub(hn::Sub(v, low), hn::Mul(k, spacing));
            m.error = hn::Add(m.error, hn::Mul(off, off));
            m.k = hn::Add(m.k, k);
            m.kk = hn::Add(m.kk, hn::Mul(k, k));
            m.v = hn::Add(m.v, v);
            m.kv = hn::Add(m.kv, hn::Mul(k, v));
        }
        return m;
    }

    // The plain fit, of which the better endpoints replace low and high: the extremes of the block, then twice those that suit the indices best by
    // linear least squares.
    void improve(F& low, F& high) const {
        F least = value(0);
        F greatest = least;
        for (int texel = 1; texel < 16; ++texel) {
            least = hn::Min(least, value(texel));
            greatest = hn::Max(greatest, value(texel));
        }
        F error = measure(low, high).error;
        F a = least;
        F b = greatest;
        for (int round = 0; round < 3; ++round) {
            kind_.round(a, b);
            const Moments m = measure(a, b);
            const auto better = hn::Lt(m.error, error);
            error = hn::IfThenElse(better, m.error, error);
            low = hn::IfThenElse(better, a, low);
            high = hn::IfThenElse(better, b, high);
            // Blocks whose indices are all alike have no best endpoints: they stay.
            const F determinant = hn::Sub(hn::Mul(constant(16.0f), m.kk), hn::Mul(m.k, m.k));
            const auto solvable = hn::Gt(determinant, hn::Zero(Floats()));
            const F slope = hn::Div(hn::Sub(hn::Mul(constant(16.0f), m.kv), hn::Mul(m.k, m.v)), hn::Max(determinant, constant(1.0f)));
            const F start = hn::Mul(hn::Sub(m.v, hn::Mul(slope, m.k)), constant(1.0f / 16.0f));
            a = hn::IfThenElse(solvable, start, least);
            b = hn::IfThenElse(solvable, hn::Add(start, hn::Mul(slope, constant(kSteps))), greatest);
        }
    }

    // The indices of all texels, as words.
    void store_indices(F stored_low, F stored_high, std::uint16_t* indices) const {
        const F low = kind_.widen(stored_low);
        const F per_code = scale(hn::Sub(kind_.widen(stored_high), low));
        for (int texel = 0; texel < 16; ++texel) {
            store_words(index(value(texel), low, per_code), indices + texel * lanes() + at_);
        }
    }

private:
    static constexpr float kSteps = static_cast<float>(Kind::kSteps);

    const Group& group_;
    const Kind kind_;
    const int at_;
};

// Lets the plain fit improve the endpoints of a group, then takes the nearest indices.
template <class Kind>
void settle(Group& group, Kind kind, std::uint16_t* indices) {
    const Floats d;
    for (int i = 0; i < lanes(); i += static_cast<int>(hn::Lanes(d))) {
        const Exact<Kind> exact(group, kind, i);
        F low = hn::Load(d, group.low + i);
        F high = hn::Load(d, group.high + i);
        exact.improve(low, high);
        hn::Store(low, d, group.low + i);
        hn::Store(high, d, group.high + i);
        exact.store_indices(low, high, indices);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex
HWY_AFTER_NAMESPACE();

#endif
