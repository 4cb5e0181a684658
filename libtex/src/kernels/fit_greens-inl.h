// SPDX-License-Identifier: Apache-2.0
// fit_greens-inl.h: scores greens by the thresholds between their values, without indices.
//
// With 4 values of spacing s from a on, the squared error is that of a alone, less 2 s times the sum of max(0, v - t)
// over the texels v and the three thresholds t between values. Because max(0, v - t) = max(v, t) - t, maxima and means
// of 16 bits are enough. Unlike those of Fitter, these errors are not multiplied by n^2.
//
// Compiled once for each Highway target, as part of fit.cpp.

#if defined(TEX_KERNELS_FIT_GREENS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_FIT_GREENS_INL_H
#undef TEX_KERNELS_FIT_GREENS_INL_H
#else
#define TEX_KERNELS_FIT_GREENS_INL_H
#endif

#include <hwy/highway.h>

#include "kernels/fit_group-inl.h"
#include "kernels/fit_steps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

class GreenFitter : public Fitter<Greens> {
public:
    explicit GreenFitter(const Group& group) : Fitter<Greens>(group, {}) {}

    // Takes one step from the endpoints of start() and scores the result.
    HWY_INLINE void start_and_step(float g, float j, Choice& choice) const {
        Ends ends;
        start_at(g, j, ends);
        Ends stored = ends;
        for (int p = 0; p < kParts; ++p) kind_.round(stored.low[p], stored.high[p]);
        const Moments m = moments<Precision::coarse>(sum_up<Greens, Precision::coarse>(group_, ramp_of(stored)));
        Lower lower;
        F b[kParts];
        for (int p = 0; p < kParts; ++p) {
            refine(m, p, ends);
            kind_.round(ends.low[p], ends.high[p]);
            set_lower(ends.low[p], p, lower);
            b[p] = hn::Mul(local(ends.high[p], p), constant(1.0f / 6.0f));
        }
        score_thresholds(lower, b, ends.high, choice);
    }

    // Scores all pairs of stored codes whose members are within `reach` (at most 2) of those of the choice. Not
    // inlined: unrolled, it would not fit into the instruction caches.
    HWY_NOINLINE void neighbours(int reach, Choice& choice) const {
        Lower lower[5];
        F high[5][kParts], b[5][kParts];
        for (int i = 0; i <= 2 * reach; ++i) {
            for (int p = 0; p < kParts; ++p) {
                const F moved = constant(static_cast<float>(i - reach));
                set_lower(clamped(hn::Add(choice.low[p], moved), kind_.top), p, lower[i]);
                high[i][p] = clamped(hn::Add(choice.high[p], moved), kind_.top);
                b[i][p] = hn::Mul(local(high[i][p], p), constant(1.0f / 6.0f));
            }
        }
        for (int i = 0; i <= 2 * reach; ++i) {
            for (int j = 0; j <= 2 * reach; ++j) score_thresholds(lower[i], b[j], high[j], choice);
        }
    }

private:
    // A lower endpoint: as stored; its value in sixths of local units; and the error if all texels take it, less the
    // error if all take the middle of the range.
    struct Lower {
        F stored[kParts], sixths[kParts], error[kParts];
    };
    HWY_INLINE void set_lower(F stored, int p, Lower& lower) const {
        const F value = local(stored, p);
        const F middle = hn::Sub(value, constant(32768.0f));
        const F v = hn::Sub(group_.sum[p], constant(16.0f * 32768.0f));
        lower.stored[p] = stored;
        lower.sixths[p] = hn::Mul(value, constant(1.0f / 6.0f));
        lower.error[p] = hn::Mul(middle, hn::Sub(hn::Mul(constant(16.0f), middle), hn::Add(v, v)));
    }

    // `b` is the greater endpoint in sixths of local units. If it is below the lower one, it counts as equal.
    HWY_INLINE void score_thresholds(const Lower& lower, const F (&b)[kParts], const F (&stored_b)[kParts],
                                     Choice& choice) const {
        F low[kParts], middle[kParts], high[kParts], sum[kParts], span[kParts];
        for (int p = 0; p < kParts; ++p) {
            const F a = lower.sixths[p];
            const F greater = hn::Max(a, b[p]);
            const F both = hn::Add(a, greater);
            span[p] = hn::Sub(greater, a);
            low[p] = hn::Min(hn::Add(both, hn::Mul(a, constant(4.0f))), constant(65535.0f));
            middle[p] = hn::Min(hn::Mul(both, constant(3.0f)), constant(65535.0f));
            high[p] = hn::Min(hn::Add(both, hn::Mul(greater, constant(4.0f))), constant(65535.0f));
            sum[p] = hn::Add(hn::Add(low[p], middle[p]), high[p]);
            low[p] = hn::Max(low[p], hn::Zero(Floats()));
            middle[p] = hn::Max(middle[p], hn::Zero(Floats()));
            high[p] = hn::Max(high[p], hn::Zero(Floats()));
        }
        const Parts means = sum_of(mean_greater<0, 16>(to_words(low)), mean_greater<0, 16>(to_words(middle)),
                                   mean_greater<0, 16>(to_words(high)));
        for (int p = 0; p < kParts; ++p) {
            const F gain = hn::Mul(hn::Mul(span[p], constant(16.0f * 4.0f)), hn::Sub(means.part[p], sum[p]));
            choice.offer(p, hn::Sub(lower.error[p], gain), lower.stored[p], hn::Max(lower.stored[p], stored_b[p]));
        }
    }

    // The mean of max(v, t) over the texels, rounded up four times, so that it is at most two units too large.
    template <int kFirst, int kCount>
    HWY_INLINE W mean_greater(W t) const {
        if constexpr (kCount == 1) {
            return hn::Max(group_.values[kFirst], t);
        } else {
            return hn::AverageRound(mean_greater<kFirst, kCount / 2>(t),
                                    mean_greater<kFirst + kCount / 2, kCount / 2>(t));
        }
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif
