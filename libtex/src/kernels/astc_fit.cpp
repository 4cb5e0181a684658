// SPDX-License-Identifier: Apache-2.0

#include "kernels/astc_fit.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/astc_fit.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/astc_steps-inl.h"
#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

HWY_NOINLINE void PackWeights(const float* from, int weights, std::uint32_t* to) {
    const FloatTag d;
    const hn::RebindToUnsigned<FloatTag> du;
    const hn::RebindToSigned<FloatTag> di;
    for (int first = 0; first < weights; first += 4, to += hn::Lanes(d)) {
        auto four = hn::Zero(du);
        for (int w = std::min(first + 4, weights); w-- > first;) {
            const FloatVec weight = hn::Load(d, from + static_cast<std::size_t>(w) * hn::Lanes(d));
            four = hn::Or(hn::ShiftLeft<8>(four), hn::BitCast(du, hn::ConvertTo(di, weight)));
        }
        hn::Store(four, du, to);
    }
}

// Stores a line as a plane: of one channel, or of both.
template <int kChannels, int kPartitions>
HWY_INLINE void StoreLine(const AstcLine<kChannels, kPartitions>& line, int weights, int plane, AstcFits& fits) {
    const FloatTag d;
    PackWeights(line.best().weights, weights, fits.weights[plane]);
    for (int p = 0; p < line.partitions(); ++p) {
        for (int c = 0; c < kChannels; ++c) {
            for (int e = 0; e < 2; ++e) hn::Store(line.best().ends.at[p][c][e], d, fits.ends[p][plane + c][e]);
        }
    }
}

template <int kPartitions>
void FitAstcTo(const AstcPlan& plan, const AstcSteps& steps, const AstcGroup& group, AstcFits& fits) {
    const FloatTag d;
    const int weights = plan.grid->weights;
    if (plan.mode.planes == 1 && plan.channels == 2) {
        AstcLine<2, kPartitions> both(plan, steps, group, group.value[0], group.value[1]);
        both.fit();
        StoreLine(both, weights, 0, fits);
        hn::Store(both.best().error, d, fits.error);
        return;
    }
    FloatVec error = hn::Zero(d);
    for (int c = 0; c < plan.channels; ++c) {
        AstcLine<1, kPartitions> line(plan, steps, group, group.value[c], nullptr);
        line.fit();
        StoreLine(line, weights, c, fits);
        error = hn::Add(error, line.best().error);
    }
    hn::Store(error, d, fits.error);
}

void FitAstc(const AstcPlan& plan, const AstcSteps& steps, const AstcGroup& group, AstcFits& fits) {
    if (plan.partitions > 1) return FitAstcTo<3>(plan, steps, group, fits);
    FitAstcTo<1>(plan, steps, group, fits);
}

int AstcLanes() { return static_cast<int>(hn::Lanes(FloatTag())); }

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(int, astc_lanes, AstcLanes, (), ())

TEX_KERNEL(void, fit_astc, FitAstc,
           (const AstcPlan& plan, const AstcSteps& steps, const AstcGroup& group, AstcFits& fits),
           (plan, steps, group, fits))

}  // namespace tex::inline v1
#endif
