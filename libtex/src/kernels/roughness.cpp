// SPDX-License-Identifier: Apache-2.0

#include "kernels/roughness.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/roughness.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;
constexpr D kD;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(kD));

// Uses comparisons, because Min and Max treat NaN differently from target to target.
HWY_INLINE V cut(V v) {
    const V one = hn::Set(kD, 1.0f);
    const V positive = hn::IfThenElseZero(hn::Gt(v, hn::Zero(kD)), v);
    return hn::IfThenElse(hn::Lt(positive, one), positive, one);
}

void CleanRoughness(const float* roughness, int count, float* clean, float* alpha2) {
    for (int i = 0; i < count; i += kLanes) {
        const V value = cut(hn::LoadU(kD, roughness + i));
        const V alpha = hn::Mul(value, value);
        hn::StoreU(value, kD, clean + i);
        hn::StoreU(hn::Mul(alpha, alpha), kD, alpha2 + i);
    }
}

void RoughnessOfAlpha2(const float* alpha2, int count, float* roughness) {
    for (int i = 0; i < count; i += kLanes)
        hn::StoreU(hn::Sqrt(hn::Sqrt(cut(hn::LoadU(kD, alpha2 + i)))), kD, roughness + i);
}

// Quantities that follow from the averages of a texel: the length m, 1 - m^2, and alpha^2.
struct Averages {
    V m, loss, alpha2;
};

HWY_INLINE Averages load_averages(const float* x, const float* y, const float* z, const float* alpha2) {
    const V one = hn::Set(kD, 1.0f);
    const V vx = hn::LoadU(kD, x), vy = hn::LoadU(kD, y), vz = hn::LoadU(kD, z);
    const V m2 = cut(hn::Add(hn::Add(hn::Mul(vx, vx), hn::Mul(vy, vy)), hn::Mul(vz, vz)));
    const V difference = hn::Sub(one, m2);
    // Smaller differences are the rounding of floats; fourth roots would turn them into 3 codes of 255.
    const V loss = hn::IfThenElseZero(hn::Ge(difference, hn::Set(kD, 0x1p-20f)), difference);
    // The least m keeps quotients finite, and changes no result by more than that least value.
    return {hn::Max(hn::Sqrt(m2), hn::Set(kD, 0x1p-20f)), loss, cut(hn::LoadU(kD, alpha2))};
}

HWY_INLINE V toksvig(Averages of) {
    const V one = hn::Set(kD, 1.0f), two = hn::Set(kD, 2.0f);
    const V shorter = hn::Div(of.loss, hn::Add(one, of.m));  // 1 - m, without cancellation
    const V q = hn::Mul(hn::Mul(two, hn::Sub(one, of.alpha2)), shorter);
    return hn::Div(hn::Add(hn::Mul(of.m, of.alpha2), q), hn::Add(of.m, q));
}

HWY_INLINE V vmf(Averages of) {
    const V two = hn::Set(kD, 2.0f), three = hn::Set(kD, 3.0f);
    const V two_kappa = hn::Mul(hn::Mul(two, of.m), hn::Sub(three, hn::Mul(of.m, of.m)));  // times 1 - m^2
    return cut(hn::Add(of.alpha2, hn::Div(of.loss, two_kappa)));
}

void RoughnessOfAverages(RoughnessModel model, const float* x, const float* y, const float* z, const float* alpha2,
                         int count, float* roughness) {
    for (int i = 0; i < count; i += kLanes) {
        const Averages averages = load_averages(x + i, y + i, z + i, alpha2 + i);
        const V rougher = model == RoughnessModel::toksvig ? toksvig(averages) : vmf(averages);
        hn::StoreU(hn::Sqrt(hn::Sqrt(rougher)), kD, roughness + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, clean_roughness, CleanRoughness, (const float* roughness, int count, float* clean, float* alpha2),
           (roughness, count, clean, alpha2))

TEX_KERNEL(void, roughness_of_alpha2, RoughnessOfAlpha2, (const float* alpha2, int count, float* roughness),
           (alpha2, count, roughness))

TEX_KERNEL(void, roughness_of_averages, RoughnessOfAverages,
           (RoughnessModel model, const float* x, const float* y, const float* z, const float* alpha2, int count,
            float* roughness),
           (model, x, y, z, alpha2, count, roughness))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
