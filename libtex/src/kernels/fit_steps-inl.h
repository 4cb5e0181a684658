// SPDX-License-Identifier: Apache-2.0
// fit_steps-inl.h: steps from endpoints to indices, and from indices to their error and to better endpoints.
//
// Compiled once for each Highway target, as part of fit.cpp.

#if defined(TEX_KERNELS_FIT_STEPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_FIT_STEPS_INL_H
#undef TEX_KERNELS_FIT_STEPS_INL_H
#else
#define TEX_KERNELS_FIT_STEPS_INL_H
#endif

#include <algorithm>
#include <cstring>

#include <hwy/highway.h>

#include "kernels/fit_group-inl.h"
#include "kernels/fit_kinds-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

// Sums over the indices k and the values v of the texels.
struct Sums {
    W k, kk, k_high, k_low;
};
constexpr int kLowBias = 8192;  // added to k_low, which may be negative

template <class Kind, Precision kPrecision>
HWY_INLINE Sums sum_up(const Group& group, const Ramp& ramp) {
    const Words d;
    Sums sums{hn::Zero(d), hn::Zero(d), hn::Zero(d), word(kLowBias)};
    for (int texel = 0; texel < 16; ++texel) {
        const W k = index(group.values[texel], ramp.factor, ramp.offset, word(cut(Kind::kSteps)));
        sums.k = hn::Add(sums.k, k);
        sums.kk = hn::Add(sums.kk, hn::Mul(k, k));
        sums.k_high = hn::Add(sums.k_high, hn::Mul(k, group.high[texel]));
        if constexpr (kPrecision == Precision::full) sums.k_low = hn::Add(sums.k_low, hn::Mul(k, group.low[texel]));
    }
    return sums;
}

// Intermediate endpoints, in codes, for each block.
struct Ends {
    F low[kParts], high[kParts];
};

// The best endpoints so far, as stored codes, and their error less a constant of the block, in local units, multiplied
// by the square of the number of spacings.
struct Choice : Ends {
    F error[kParts];
    Choice() {
        for (int p = 0; p < kParts; ++p) {
            low[p] = high[p] = hn::Zero(Floats());
            error[p] = constant(1e30f);
        }
    }
    HWY_INLINE void offer(int p, F offered, F offered_low, F offered_high) {
        const auto better = hn::Lt(offered, error[p]);
        error[p] = hn::IfThenElse(better, offered, error[p]);
        low[p] = hn::IfThenElse(better, offered_low, low[p]);
        high[p] = hn::IfThenElse(better, offered_high, high[p]);
    }
};

template <class Kind>
class Fitter {
public:
    Fitter(const Group& group, Kind kind) : group_(group), kind_(kind) {}

    // The plain fit: the extremes, refined twice by least squares. If all texels are whole codes, all of it is exact,
    // with halves rounded up; errors are too, up to a range of 127 codes.
    HWY_INLINE void plain(Choice& choice) const {
        const F one = constant(1.0f);
        Ends ends;
        for (int p = 0; p < kParts; ++p) {
            ends.low[p] = kind_.stored(group_.base[p], one);
            ends.high[p] = kind_.stored(code(group_.greatest[p], p), one);
        }
        for (int round = 0; round < 3; ++round) {
            for (int p = 0; p < kParts; ++p) kind_.round_stored(ends.low[p], ends.high[p]);
            const Moments m = moments<Precision::full>(sum_up<Kind, Precision::full>(group_, ramp_of(ends)));
            for (int p = 0; p < kParts; ++p) {
                choice.offer(p, error_of(m, p, local(ends.low[p], p), local(ends.high[p], p)), ends.low[p],
                             ends.high[p]);
                if (round < 2) refine_exactly(m, p, ends);
            }
        }
    }

    // Takes `steps` steps. At the first endpoints, n - j + g spacings span the range, and the lower endpoint lies g / 2
    // spacings above the least texel.
    template <Precision kPrecision>
    HWY_INLINE void start(float g, float j, int steps, Choice& choice) const {
        Ends ends;
        start_at(g, j, ends);
        for (int k = 0; k < steps; ++k) step<kPrecision>(ends, k + 1 < steps, choice);
    }

    // Rounds the endpoints, takes the nearest indices, and keeps the endpoints if they are the best so far. With
    // `refined`, it then replaces them by the endpoints that suit the indices best.
    template <Precision kPrecision>
    HWY_INLINE void step(Ends& ends, bool refined, Choice& choice) const {
        Ends stored = ends;
        for (int p = 0; p < kParts; ++p) kind_.round(stored.low[p], stored.high[p]);
        score<kPrecision>(stored, refined ? &ends : nullptr, choice);
    }

    // If a block's range is at most n codes, tries a spacing of one code, which loses nothing if all texels are whole
    // codes.
    HWY_INLINE void whole_codes(Choice& choice) const {
        const Floats d;
        Ends ends = choice;  // for the other blocks this is nothing new
        auto all_wide = hn::Eq(constant(0.0f), constant(0.0f));
        for (int p = 0; p < kParts; ++p) {
            const F range = hn::Mul(group_.greatest[p], group_.unit[p]);
            const auto wide = hn::Gt(range, constant(kSteps));
            all_wide = hn::And(all_wide, wide);
            const F low = hn::Min(hn::Floor(group_.base[p]), constant(kind_.top - kSteps));
            ends.low[p] = hn::IfThenElse(wide, ends.low[p], low);
            ends.high[p] = hn::IfThenElse(wide, ends.high[p], hn::Add(low, constant(kSteps)));
        }
        if (!hn::AllTrue(d, all_wide)) score<Precision::full>(ends, nullptr, choice);
    }

    // Scores stored endpoints. If `refined` is not null, it receives the endpoints that suit the indices best.
    template <Precision kPrecision>
    HWY_INLINE void score(const Ends& stored, Ends* refined, Choice& choice) const {
        const Sums sums = sum_up<Kind, kPrecision>(group_, ramp_of(stored));
        const Moments m = moments<kPrecision>(sums);
        for (int p = 0; p < kParts; ++p) {
            choice.offer(p, error_of(m, p, local(stored.low[p], p), local(stored.high[p], p)), stored.low[p],
                         stored.high[p]);
            if (refined != nullptr) refine(m, p, *refined);
        }
    }

    // Starts from endpoints at the extremes, moved inwards by a part of the range, and finds the endpoints that suit
    // their indices best, rounded. Returns the ramp of the indices. If `whole` is given and set (all texels are whole
    // codes) and the range is at most n codes, it starts with a spacing of one code, which loses nothing.
    HWY_INLINE Ramp solve(float part, const hn::Mask<Floats>* whole, Choice& choice) const {
        const Floats d;
        Ends ends, at;
        for (int p = 0; p < kParts; ++p) {
            const F greatest = group_.greatest[p];
            F a = hn::Mul(greatest, constant(part));
            F b = hn::Sub(greatest, a);
            if (whole != nullptr) {
                const F steps = hn::Mul(group_.per_unit[p], constant(kSteps));
                const auto narrow = hn::And(whole[p], hn::Le(greatest, steps));
                a = hn::IfThenElse(narrow, hn::Min(a, local(constant(kind_.top - kSteps), p)), a);
                b = hn::IfThenElse(narrow, hn::Add(a, steps), b);
            }
            at.low[p] = a;
            at.high[p] = b;
            ends.low[p] = code(a, p);
            ends.high[p] = code(b, p);
        }
        const Ramp ramp = make_ramp<Kind>(at.low, at.high, group_.ties);
        const Moments m = moments<Precision::coarse>(sum_up<Kind, Precision::coarse>(group_, ramp));
        F narrow[kParts];
        auto any_narrow = hn::Lt(constant(0.0f), constant(0.0f));
        for (int p = 0; p < kParts; ++p) {
            refine(m, p, ends);
            kind_.round(ends.low[p], ends.high[p]);
            choice.low[p] = ends.low[p];
            choice.high[p] = ends.high[p];
            // Relative to the range, rounding moved these endpoints far, so other values are now nearest.
            const auto is_narrow = hn::Lt(group_.greatest[p], group_.per_unit[p]);
            narrow[p] = hn::IfThenElseZero(is_narrow, constant(65535.0f));
            any_narrow = hn::Or(any_narrow, is_narrow);
        }
        if (hn::AllFalse(d, any_narrow)) return ramp;
        const Ramp rounded_ramp = ramp_of(choice);
        const auto where = hn::MaskFromVec(to_words(narrow));
        return {hn::IfThenElse(where, rounded_ramp.factor, ramp.factor),
                hn::IfThenElse(where, rounded_ramp.offset, ramp.offset)};
    }

    // The ramp of stored endpoints.
    HWY_INLINE Ramp ramp_of(const Ends& stored) const {
        F a[kParts], b[kParts];
        for (int p = 0; p < kParts; ++p) {
            a[p] = local(stored.low[p], p);
            b[p] = local(stored.high[p], p);
        }
        return make_ramp<Kind>(a, b, group_.ties);
    }

    // Converts a local value to codes, and a stored code to a local value.
    HWY_INLINE F code(F value, int p) const { return hn::Add(group_.base[p], hn::Mul(value, group_.unit[p])); }
    HWY_INLINE F local(F stored, int p) const {
        return hn::Mul(hn::Sub(kind_.widen(stored), group_.base[p]), group_.per_unit[p]);
    }

protected:
    HWY_INLINE void start_at(float g, float j, Ends& ends) const {
        for (int p = 0; p < kParts; ++p) {
            const F spacing = hn::Mul(group_.greatest[p], constant(1.0f / (kSteps - j + g)));
            const F a = hn::Mul(spacing, constant(0.5f * g));
            ends.low[p] = code(a, p);
            ends.high[p] = code(hn::Add(a, hn::Mul(spacing, constant(kSteps))), p);
        }
    }

    static constexpr float kSteps = static_cast<float>(Kind::kSteps);

    // Sums over the texels.
    struct Moments {
        Parts k, kk, kv;
        const F* v;
    };

    template <Precision kPrecision>
    HWY_INLINE Moments moments(const Sums& sums) const {
        Moments m{to_floats(sums.k), to_floats(sums.kk), to_floats(sums.k_high),
                  kPrecision == Precision::full ? group_.sum : group_.high_sum};
        for (int p = 0; p < kParts; ++p) m.kv.part[p] = hn::Mul(m.kv.part[p], constant(kHighUnit));
        if constexpr (kPrecision == Precision::full) {
            const Parts low = to_floats(sums.k_low);
            for (int p = 0; p < kParts; ++p)
                m.kv.part[p] = hn::Add(m.kv.part[p], hn::Sub(low.part[p], constant(kLowBias)));
        }
        return m;
    }

    // The moments of indices counted from n / 2 and of values counted from the middle of their range, which keeps the
    // numbers, and so their rounding, small.
    struct Centred {
        F k, kk, v, kv;
    };
    HWY_INLINE Centred centred(const Moments& m, int p) const {
        constexpr float kHalf = 0.5f * kSteps;
        const F k = hn::Sub(m.k.part[p], constant(16.0f * kHalf));
        return {
            k,
            hn::Add(hn::Sub(m.kk.part[p], hn::Mul(m.k.part[p], constant(kSteps))), constant(16.0f * kHalf * kHalf)),
            hn::Sub(m.v[p], constant(16.0f * kMiddle)),
            hn::Sub(hn::Sub(m.kv.part[p], hn::Mul(m.v[p], constant(kHalf))), hn::Mul(k, constant(kMiddle))),
        };
    }

    // n^2 times: the sum of (v - a - k spacing)^2, less that of (v - c)^2, where c is the middle of the range of
    // values.
    HWY_INLINE F error_of(const Moments& m, int p, F a, F b) const {
        const Centred c = centred(m, p);
        const F span = hn::Sub(b, a);
        const F middle = hn::Sub(hn::Mul(hn::Add(a, b), constant(0.5f)), constant(kMiddle));
        const F from_middle = hn::Mul(middle, hn::Sub(hn::Mul(constant(16.0f), middle), hn::Add(c.v, c.v)));
        const F cross = hn::Mul(hn::Sub(hn::Mul(middle, c.k), c.kv), constant(2.0f * kSteps));
        return hn::Add(hn::Mul(from_middle, constant(kSteps * kSteps)),
                       hn::Mul(span, hn::Add(hn::Mul(span, c.kk), cross)));
    }

    // Replaces endpoints by the ones that suit the indices best, by linear least squares.
    HWY_INLINE void refine(const Moments& m, int p, Ends& ends) const {
        const Floats d;
        const F k = m.k.part[p];
        const F kv = m.kv.part[p];
        const F determinant = hn::Sub(hn::Mul(constant(16.0f), m.kk.part[p]), hn::Mul(k, k));
        const F slope =
            hn::Div(hn::Sub(hn::Mul(constant(16.0f), kv), hn::Mul(k, m.v[p])), hn::Max(determinant, constant(1.0f)));
        const F start = hn::Mul(hn::Sub(m.v[p], hn::Mul(slope, k)), constant(1.0f / 16.0f));
        const F end = hn::Add(start, hn::Mul(slope, constant(kSteps)));
        const auto solvable = hn::Gt(determinant, hn::Zero(d));
        ends.low[p] = hn::IfThenElse(solvable, code(start, p), ends.low[p]);
        ends.high[p] = hn::IfThenElse(solvable, code(end, p), ends.high[p]);
    }

    // Refines with each endpoint rounded once, by its division. The endpoints are those of stored(). If all texels
    // are whole codes, numerators and denominators are exact: they are multiples of half a code, and below 2^23 of
    // them.
    HWY_INLINE void refine_exactly(const Moments& m, int p, Ends& ends) const {
        const Floats d;
        const Centred c = centred(m, p);
        const F determinant = hn::Sub(hn::Mul(constant(16.0f), c.kk), hn::Mul(c.k, c.k));
        const F slope = hn::Sub(hn::Mul(constant(16.0f), c.kv), hn::Mul(c.k, c.v));
        const F middle = hn::Sub(hn::Mul(c.v, c.kk), hn::Mul(c.k, c.kv));
        const F half = hn::Mul(slope, constant(0.5f * kSteps));
        const F base = hn::Add(group_.base[p], hn::Mul(constant(kMiddle), group_.unit[p]));
        const F whole = hn::Mul(base, determinant);
        const F low = hn::Add(whole, hn::Mul(hn::Sub(middle, half), group_.unit[p]));
        const F high = hn::Add(whole, hn::Mul(hn::Add(middle, half), group_.unit[p]));
        const auto solvable = hn::Gt(determinant, hn::Zero(d));
        const F denominator = hn::Max(determinant, constant(1.0f));
        ends.low[p] = hn::IfThenElse(solvable, kind_.stored(low, denominator), ends.low[p]);
        ends.high[p] = hn::IfThenElse(solvable, kind_.stored(high, denominator), ends.high[p]);
    }

    static constexpr float kMiddle = 32768.0f;  // of the range of local values

    const Group& group_;
    const Kind kind_;
};

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif
