// SPDX-License-Identifier: Apache-2.0

#include "kernels/astc_copies.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/astc_copies.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The mean square of how far values are beyond one end of an interval, if they are spread evenly over 2 `reach`, of
// which `over` is outside. `inverse` is 1 / (6 reach).
HWY_INLINE FloatVec SquareBeyond(FloatVec over, FloatVec reach, FloatVec inverse) {
    const FloatTag d;
    const FloatVec outside = hn::Max(over, hn::Zero(d));
    const FloatVec square = hn::Mul(outside, outside);
    const FloatVec some = hn::Mul(hn::Mul(square, outside), inverse);
    const FloatVec off = hn::Sub(outside, reach);
    const FloatVec all = hn::Add(hn::Mul(off, off), hn::Mul(hn::Mul(reach, reach), hn::Set(d, 1.0f / 3.0f)));
    return hn::IfThenElse(hn::Gt(off, reach), all, some);
}

HWY_INLINE FloatVec SquareOutside(FloatVec variance, FloatVec mean, FloatVec middle, FloatVec half) {
    const FloatTag d;
    const FloatVec reach = hn::Sqrt(hn::Max(hn::Mul(variance, hn::Set(d, 3.0f)), hn::Set(d, 1e-10f)));
    const FloatVec inverse = hn::Div(hn::Set(d, 1.0f / 6.0f), reach);
    const FloatVec off = hn::Sub(mean, middle), room = hn::Sub(reach, half);
    return hn::Add(SquareBeyond(hn::Add(room, off), reach, inverse), SquareBeyond(hn::Sub(room, off), reach, inverse));
}

void AstcCopyCosts(const AstcCopyTable& table, const AstcCopyTexels& block, const float* prices, float scale,
                   float literal, int count, float* wholes, float* fronts) {
    const FloatTag d;
    const FloatVec by = hn::Set(d, scale), texels = hn::Set(d, block.texels), of_literal = hn::Set(d, literal);
    const FloatVec over = hn::Set(d, 1.0f / block.texels);
    const FloatVec xx = hn::Set(d, block.xx), xy = hn::Set(d, 2.0f * block.xy), yy = hn::Set(d, block.yy);
    const FloatVec x = hn::Set(d, block.mean[0]), y = hn::Set(d, block.mean[1]);
    for (int k = 0; k < count; k += static_cast<int>(hn::Lanes(d))) {
        const FloatVec price = hn::LoadU(d, prices + k);
        FloatVec square = hn::Zero(d);
        for (int n = 0; n < kAstcCoarse; ++n) {
            const FloatVec off = hn::Sub(hn::LoadU(d, table.coarse[n] + k), hn::Set(d, block.coarse[n]));
            square = hn::Add(square, hn::Mul(off, off));
        }
        hn::StoreU(hn::Add(hn::Mul(by, hn::Sqrt(square)), price), d, wholes + k);

        const FloatVec cos = hn::LoadU(d, table.cos + k), sin = hn::LoadU(d, table.sin + k);
        const FloatVec cc = hn::Mul(cos, cos), ss = hn::Mul(sin, sin), cs = hn::Mul(hn::Mul(cos, sin), xy);
        const FloatVec along = hn::Add(hn::Add(hn::Mul(cc, xx), hn::Mul(ss, yy)), cs);
        const FloatVec across = hn::Sub(hn::Add(hn::Mul(ss, xx), hn::Mul(cc, yy)), cs);
        const FloatVec zero = hn::Zero(d);
        const FloatVec outside =
            hn::Add(SquareOutside(hn::Mul(hn::Max(along, zero), over), hn::Add(hn::Mul(cos, x), hn::Mul(sin, y)),
                                  hn::LoadU(d, table.middle[0] + k), hn::LoadU(d, table.half[0] + k)),
                    SquareOutside(hn::Mul(hn::Max(across, zero), over), hn::Sub(hn::Mul(cos, y), hn::Mul(sin, x)),
                                  hn::LoadU(d, table.middle[1] + k), hn::LoadU(d, table.half[1] + k)));
        const FloatVec error = hn::Add(hn::Mul(texels, outside), hn::LoadU(d, table.noise + k));
        const FloatVec bits = hn::Add(price, hn::Mul(of_literal, hn::LoadU(d, table.literals + k)));
        hn::StoreU(hn::Add(hn::Mul(by, hn::Sqrt(error)), bits), d, fronts + k);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, astc_copy_costs, AstcCopyCosts,
           (const AstcCopyTable& table, const AstcCopyTexels& block, const float* prices, float scale, float literal,
            int count, float* wholes, float* fronts),
           (table, block, prices, scale, literal, count, wholes, fronts))

}  // namespace tex::inline v1
#endif
