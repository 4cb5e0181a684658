// SPDX-License-Identifier: Apache-2.0

#include "kernels/angle.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/angle.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using Vector = hn::Vec<Floats>;

// asin(h), 0 <= h <= 1. Up to 1/2 by a minimax polynomial (Moshier, Cephes 2.8, asinf: relative error 2.5e-7). Above
// 1/2, asin(h) = pi/2 - 2 asin(sqrt((1 - h) / 2)).
Vector arc_sine(Vector h) {
    const Floats d;
    const auto half = hn::Set(d, 0.5f);
    const auto steep = hn::Gt(h, half);
    const auto folded = hn::Mul(half, hn::Sub(hn::Set(d, 1.0f), h));
    const auto square = hn::IfThenElse(steep, folded, hn::Mul(h, h));
    const auto root = hn::IfThenElse(steep, hn::Sqrt(folded), h);
    auto sum = hn::Set(d, 4.2163199048e-2f);
    sum = hn::Add(hn::Mul(sum, square), hn::Set(d, 2.4181311049e-2f));
    sum = hn::Add(hn::Mul(sum, square), hn::Set(d, 4.5470025998e-2f));
    sum = hn::Add(hn::Mul(sum, square), hn::Set(d, 7.4953002686e-2f));
    sum = hn::Add(hn::Mul(sum, square), hn::Set(d, 1.6666752422e-1f));
    const auto small = hn::Add(hn::Mul(hn::Mul(sum, square), root), root);
    const auto large = hn::Sub(hn::Set(d, 1.57079632679489661923f), hn::Add(small, small));
    return hn::IfThenElse(steep, large, small);
}

void angle_row_target(const VectorRow& a, const VectorRow& b, int count, float* degrees) {
    const Floats d;
    const auto half = hn::Set(d, 0.5f);
    const auto one = hn::Set(d, 1.0f);
    const auto scale = hn::Set(d, 114.591559026164641754f);  // 2 * 180 / pi
    for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
        const auto dx = hn::Sub(hn::LoadU(d, a.x + i), hn::LoadU(d, b.x + i));
        const auto dy = hn::Sub(hn::LoadU(d, a.y + i), hn::LoadU(d, b.y + i));
        const auto dz = hn::Sub(hn::LoadU(d, a.z + i), hn::LoadU(d, b.z + i));
        const auto square = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
        const auto h = hn::Min(hn::Mul(half, hn::Sqrt(square)), one);
        hn::StoreU(hn::Mul(scale, arc_sine(h)), d, degrees + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, angle_row, angle_row_target, (const VectorRow& a, const VectorRow& b, int count, float* degrees),
           (a, b, count, degrees))

}  // namespace tex::inline v1
#endif
