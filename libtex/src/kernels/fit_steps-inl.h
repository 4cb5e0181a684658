// SPDX-License-Identifier: Apache-2.0
// fit_steps-inl.h: from endpoints to indices, from indices to their error and to better endpoints.
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

HWY_BEFORE_NAMESPACE();
namespace tex {
namespace HWY_NAMESPACE {

HWY_INLINE F clamped(F value, float most) { return hn::Min(hn::Max(value, hn::Zero(Floats())), constant(most)); }
HWY_INLINE F rounded(F value) { return hn::Floor(hn::Add(value, constant(0.5f))); }

// BC4 with 8 values, endpoints of 8 bits that differ.
struct EightValues {
    static constexpr int kSteps = 7;
    float top;

    // Rounds endpoints in codes to what the block can hold.
    HWY_INLINE void round(F& low, F& high) const {
        const F a = clamped(rounded(low), top);
        const F b = clamped(rounded(high), top);
        // Equal ones would mean 6 values: take the codes on both sides.
        const F floor = clamped(hn::Floor(low), top - 1.0f);
        const auto apart = hn::Gt(b, a);
        low = hn::IfThenElse(apart, a, floor);
        high = hn::IfThenElse(apart, b, hn::Add(floor, constant(1.0f)));
    }
    // The codes of 8 bits that the decoder makes of them.
    HWY_INLINE F widen(F code) const { return code; }
};

// BC4 with 6 values, of which the lowest and the greatest code are not used here.
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

    HWY_INLINE void round(F& low, F& high) const {
        const F scale = constant(63.0f / 255.0f);
        const F a = clamped(rounded(hn::Mul(low, scale)), top);
        const F b = clamped(rounded(hn::Mul(high, scale)), top);
        low = hn::Min(a, b);
        high = hn::Max(a, b);
    }
    HWY_INLINE F widen(F code) const {
        return hn::Add(hn::Mul(code, constant(4.0f)), hn::Floor(hn::Mul(code, constant(1.0f / 16.0f))));
    }
};

// Turns a value into an index, counted from the lower endpoint: q = value * factor / 65536 + offset has 2^kIndexBits for each spacing, and
// the additions saturate at both ends of the palette: k = (q - cut) / 2^kIndexBits.
struct Ramp {
    HWY_ALIGN std::uint16_t factor[kLanes], offset[kLanes];
};
constexpr int kIndexBits = 11;
constexpr int cut(int steps) { return 65536 - ((steps + 1) << kIndexBits); }

HWY_INLINE W index(W value, W factor, W offset, W cut) {
    return hn::ShiftRight<kIndexBits>(hn::SaturatedSub(hn::SaturatedAdd(hn::MulHigh(value, factor), offset), cut));
}

// The ramp of local endpoints a <= b.
template <class Kind>
HWY_INLINE void store_ramp(F a, F b, int i, Ramp& ramp) {
    constexpr float kUnit = static_cast<float>(1 << kIndexBits);
    const F span = hn::Sub(b, a);
    const F exact = hn::Div(constant(65536.0f * kUnit * static_cast<float>(Kind::kSteps)), hn::Max(span, constant(1.0f)));
    const F factor = hn::IfThenElseZero(hn::Gt(span, hn::Zero(Floats())), hn::Min(exact, constant(65535.0f)));
    const F start = hn::Mul(hn::Mul(a, factor), constant(1.0f / 65536.0f));
    store_words(factor, ramp.factor + i);
    store_words(clamped(hn::Sub(constant(static_cast<float>(cut(Kind::kSteps)) + 0.5f * kUnit), start), 65535.0f), ramp.offset + i);
}

// What follows from the indices k of the texels' values v.
struct Sums {
    HWY_ALIGN std::uint16_t k[kLanes], kk[kLanes], k_high[kLanes], k_low[kLanes];
};
constexpr int kLowBias = 8192;  // of k_low, which may be negative

template <class Kind, Precision kPrecision>
HWY_INLINE void sum_up(const Group& group, const Ramp& ramp, Sums& sums) {
    const Words d;
    const hn::Rebind<std::int16_t, Words> ds;
    const W factor = hn::Load(d, ramp.factor);
    const W offset = hn::Load(d, ramp.offset);
    W sum_k = hn::Zero(d);
    W sum_kk = hn::Zero(d);
    W sum_high = hn::Zero(d);
    W sum_low = word(kLowBias);
    for (int texel = 0; texel < 16; ++texel) {
        const W k = index(hn::Load(d, group.values + texel * lanes()), factor, offset, word(cut(Kind::kSteps)));
        sum_k = hn::Add(sum_k, k);
        sum_kk = hn::Add(sum_kk, hn::Mul(k, k));
        sum_high = hn::Add(sum_high, hn::Mul(k, hn::Load(d, group.high + texel * lanes())));
        if constexpr (kPrecision == Precision::full) {
            sum_low = hn::Add(sum_low, hn::Mul(k, hn::BitCast(d, hn::Load(ds, group.low + texel * lanes()))));
        }
    }
    hn::Store(sum_k, d, sums.k);
    hn::Store(sum_kk, d, sums.kk);
    hn::Store(sum_high, d, sums.k_high);
    hn::Store(sum_low, d, sums.k_low);
}

// Endpoints in codes on their way, for each block.
struct Ends {
    HWY_ALIGN float low[kLanes], high[kLanes];
};

// The best endpoints so far, as stored codes, and their error less a constant of the block, in local units.
struct Choice : Ends {
    HWY_ALIGN float error[kLanes];
    Choice() {
        std::fill(low, low + kLanes, 0.0f);
        std::fill(high, high + kLanes, 0.0f);
        std::fill(error, error + kLanes, 1e30f);
    }
};

template <class Kind>
class Fitter {
public:
    Fitter(const Group& group, Kind kind) : group_(group), kind_(kind) {}

    // Takes `steps` steps from endpoints at which n - j + g spacings span the range, the lower one g / 2 spacings above the least texel.
    template <Precision kPrecision>
    HWY_INLINE void start(float g, float j, int steps, Choice& choice) const {
        Ends ends;
        for (int i = 0; i < lanes(); i += float_lanes()) {
            const F spacing = hn::Mul(hn::Load(Floats(), group_.greatest + i), constant(1.0f / (kSteps - j + g)));
            const F a = hn::Mul(spacing, constant(0.5f * g));
            hn::Store(code(a, i), Floats(), ends.low + i);
            hn::Store(code(hn::Add(a, hn::Mul(spacing, constant(kSteps))), i), Floats(), ends.high + i);
        }
        for (int k = 0; k < steps; ++k) step<kPrecision>(ends, k + 1 < steps, choice);
    }

    // Rounds the endpoints, takes the nearest indices, and keeps the endpoints where they are the best so far; with `refined` then replaces
    // them by those that suit the indices best.
    template <Precision kPrecision>
    HWY_INLINE void step(Ends& ends, bool refined, Choice& choice) const {
        Ramp ramp;
        Ends stored;
        for (int i = 0; i < lanes(); i += float_lanes()) {
            F low = hn::Load(Floats(), ends.low + i);
            F high = hn::Load(Floats(), ends.high + i);
            kind_.round(low, high);
            hn::Store(low, Floats(), stored.low + i);
            hn::Store(high, Floats(), stored.high + i);
            store_ramp<Kind>(local(low, i), local(high, i), i, ramp);
        }
        score<kPrecision>(stored, ramp, refined ? &ends : nullptr, choice);
    }

    // Where a block's range is at most n codes, a spacing of one code: it loses nothing where all texels are whole codes.
    HWY_INLINE void whole_codes(Choice& choice) const {
        const Floats d;
        Ends ends = choice;  // the other blocks learn nothing new
        auto all_wide = hn::Eq(constant(0.0f), constant(0.0f));
        for (int i = 0; i < lanes(); i += float_lanes()) {
            const F range = hn::Mul(hn::Load(d, group_.greatest + i), hn::Load(d, group_.unit + i));
            const auto wide = hn::Gt(range, constant(kSteps));
            all_wide = hn::And(all_wide, wide);
            const F low = hn::Min(hn::Floor(hn::Load(d, group_.base + i)), constant(kind_.top - kSteps));
            hn::Store(hn::IfThenElse(wide, hn::Load(d, ends.low + i), low), d, ends.low + i);
            hn::Store(hn::IfThenElse(wide, hn::Load(d, ends.high + i), hn::Add(low, constant(kSteps))), d, ends.high + i);
        }
        if (!hn::AllTrue(d, all_wide)) measure<Precision::full>(ends, choice);
    }

    // Scores stored endpoints.
    template <Precision kPrecision>
    HWY_INLINE void measure(const Ends& stored, Choice& choice) const {
        Ramp ramp;
        ramp_of(stored, ramp);
        score<kPrecision>(stored, ramp, nullptr, choice);
    }

    template <Precision kPrecision>
    HWY_INLINE void score(const Ends& stored, const Ramp& ramp, Ends* refined, Choice& choice) const {
        const Floats d;
        Sums sums;
        sum_up<Kind, kPrecision>(group_, ramp, sums);
        for (int i = 0; i < lanes(); i += float_lanes()) {
            const Moments m = moments<kPrecision>(sums, i);
            const F low = hn::Load(d, stored.low + i);
            const F high = hn::Load(d, stored.high + i);
            const F error = error_of(m, local(low, i), local(high, i));
            const F least = hn::Load(d, choice.error + i);
            const auto better = hn::Lt(error, least);
            hn::Store(hn::IfThenElse(better, error, least), d, choice.error + i);
            hn::Store(hn::IfThenElse(better, low, hn::Load(d, choice.low + i)), d, choice.low + i);
            hn::Store(hn::IfThenElse(better, high, hn::Load(d, choice.high + i)), d, choice.high + i);
            if (refined != nullptr) refine(m, i, *refined);
        }
    }

    // From endpoints at the extremes, moved inwards by a part of the range, to those that suit their indices best, rounded. Returns the indices' ramp.
    // Where `fractions`, if given, are 0 (all texels are whole codes) and the range is at most n codes: a spacing of one code, which loses nothing.
    HWY_INLINE void solve(float part, const std::uint16_t* fractions, Ramp& ramp, Choice& choice) const {
        const Floats d;
        Ends ends;
        for (int i = 0; i < lanes(); i += float_lanes()) {
            const F greatest = hn::Load(d, group_.greatest + i);
            F a = hn::Mul(greatest, constant(part));
            F b = hn::Sub(greatest, a);
            if (fractions != nullptr) {
                const F steps = hn::Mul(hn::Load(d, group_.per_unit + i), constant(kSteps));
                const auto whole = hn::And(hn::Eq(load_words(fractions + i), hn::Zero(d)), hn::Le(greatest, steps));
                a = hn::IfThenElse(whole, hn::Min(a, local(constant(kind_.top - kSteps), i)), a);
                b = hn::IfThenElse(whole, hn::Add(a, steps), b);
            }
            hn::Store(code(a, i), d, ends.low + i);
            hn::Store(code(b, i), d, ends.high + i);
            store_ramp<Kind>(a, b, i, ramp);
        }
        Sums sums;
        sum_up<Kind, Precision::coarse>(group_, ramp, sums);
        for (int i = 0; i < lanes(); i += float_lanes()) {
            refine(moments<Precision::coarse>(sums, i), i, ends);
            F low = hn::Load(d, ends.low + i);
            F high = hn::Load(d, ends.high + i);
            kind_.round(low, high);
            hn::Store(low, d, choice.low + i);
            hn::Store(high, d, choice.high + i);
            // Rounding took these far from where they were, in terms of the range: other values are nearest.
            const auto narrow = hn::Lt(hn::Load(d, group_.greatest + i), hn::Load(d, group_.per_unit + i));
            if (!hn::AllFalse(d, narrow)) store_ramp_where(narrow, local(low, i), local(high, i), i, ramp);
        }
    }

    // Scores all pairs of stored codes whose members are within `reach` of the choice.
    HWY_INLINE void neighbours(int reach, Choice& choice) const {
        const Floats d;
        Ends center;
        std::memcpy(center.low, choice.low, sizeof center.low);
        std::memcpy(center.high, choice.high, sizeof center.high);
        for (int p = -reach; p <= reach; ++p) {
            for (int q = -reach; q <= reach; ++q) {
                if (p == 0 && q == 0) continue;
                Ends moved;
                for (int i = 0; i < lanes(); i += float_lanes()) {
                    const F low = clamped(hn::Add(hn::Load(d, center.low + i), constant(static_cast<float>(p))), kind_.top);
                    const F high = hn::Max(clamped(hn::Add(hn::Load(d, center.high + i), constant(static_cast<float>(q))), kind_.top), low);
                    hn::Store(low, d, moved.low + i);
                    hn::Store(high, d, moved.high + i);
                }
                measure<Precision::coarse>(moved, choice);
            }
        }
    }

    // The ramp of stored endpoints.
    HWY_INLINE void ramp_of(const Ends& stored, Ramp& ramp) const {
        for (int i = 0; i < lanes(); i += float_lanes()) {
            store_ramp<Kind>(local(hn::Load(Floats(), stored.low + i), i), local(hn::Load(Floats(), stored.high + i), i), i, ramp);
        }
    }

private:
    static constexpr float kSteps = static_cast<float>(Kind::kSteps);

    static HWY_INLINE void store_ramp_where(hn::Mask<Floats> where, F a, F b, int i, Ramp& ramp) {
        const F factor = load_words(ramp.factor + i);
        const F offset = load_words(ramp.offset + i);
        store_ramp<Kind>(a, b, i, ramp);
        store_words(hn::IfThenElse(where, load_words(ramp.factor + i), factor), ramp.factor + i);
        store_words(hn::IfThenElse(where, load_words(ramp.offset + i), offset), ramp.offset + i);
    }

    // Sums over the texels.
    struct Moments {
        F k, kk, v, kv;
    };

    template <Precision kPrecision>
    HWY_INLINE Moments moments(const Sums& sums, int i) const {
        F kv = hn::Mul(load_words(sums.k_high + i), constant(kHighUnit));
        if constexpr (kPrecision == Precision::full) kv = hn::Add(kv, hn::Sub(load_words(sums.k_low + i), constant(kLowBias)));
        const F v = hn::Load(Floats(), (kPrecision == Precision::full ? group_.sum : group_.high_sum) + i);
        return {load_words(sums.k + i), load_words(sums.kk + i), v, kv};
    }

    HWY_INLINE F code(F value, int i) const {
        return hn::Add(hn::Load(Floats(), group_.base + i), hn::Mul(value, hn::Load(Floats(), group_.unit + i)));
    }
    // The stored code as a local value.
    HWY_INLINE F local(F stored, int i) const {
        return hn::Mul(hn::Sub(kind_.widen(stored), hn::Load(Floats(), group_.base + i)), hn::Load(Floats(), group_.per_unit + i));
    }

    // The sum of (v - a - k spacing)^2, less that of (v - c)^2, c being the middle of the range of values. Indices are counted from n / 2
    // and values from c: that keeps the numbers, and so their rounding, small.
    HWY_INLINE F error_of(const Moments& m, F a, F b) const {
        constexpr float kHalf = 0.5f * kSteps;
        constexpr float kMiddle = 32768.0f;
        const F spacing = hn::Mul(hn::Sub(b, a), constant(1.0f / kSteps));
        const F middle = hn::Sub(hn::Mul(hn::Add(a, b), constant(0.5f)), constant(kMiddle));
        const F k = hn::Sub(m.k, constant(16.0f * kHalf));
        const F kk = hn::Add(hn::Sub(m.kk, hn::Mul(m.k, constant(kSteps))), constant(16.0f * kHalf * kHalf));
        const F v = hn::Sub(m.v, constant(16.0f * kMiddle));
        const F kv = hn::Sub(hn::Sub(m.kv, hn::Mul(m.v, constant(kHalf))), hn::Mul(k, constant(kMiddle)));
        const F from_middle = hn::Mul(middle, hn::Sub(hn::Mul(constant(16.0f), middle), hn::Add(v, v)));
        const F cross = hn::Sub(hn::Mul(middle, k), kv);
        return hn::Add(from_middle, hn::Mul(spacing, hn::Add(hn::Mul(spacing, kk), hn::Add(cross, cross))));
    }

    // Replaces endpoints by those that suit the indices best, by linear least squares.
    HWY_INLINE void refine(const Moments& m, int i, Ends& ends) const {
        const Floats d;
        const F determinant = hn::Sub(hn::Mul(constant(16.0f), m.kk), hn::Mul(m.k, m.k));
        const F slope = hn::Div(hn::Sub(hn::Mul(constant(16.0f), m.kv), hn::Mul(m.k, m.v)), hn::Max(determinant, constant(1.0f)));
        const F start = hn::Mul(hn::Sub(m.v, hn::Mul(slope, m.k)), constant(1.0f / 16.0f));
        const F end = hn::Add(start, hn::Mul(slope, constant(kSteps)));
        const auto solvable = hn::Gt(determinant, hn::Zero(d));
        hn::Store(hn::IfThenElse(solvable, code(start, i), hn::Load(d, ends.low + i)), d, ends.low + i);
        hn::Store(hn::IfThenElse(solvable, code(end, i), hn::Load(d, ends.high + i)), d, ends.high + i);
    }

    const Group& group_;
    const Kind kind_;
};

}  // namespace HWY_NAMESPACE
}  // namespace tex
HWY_AFTER_NAMESPACE();

#endif
