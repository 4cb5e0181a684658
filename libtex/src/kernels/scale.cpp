// SPDX-License-Identifier: Apache-2.0

#include "kernels/scale.h"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/scale.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void ScaleRow(const VectorRow& in, float scale, ScaleMode mode, int count, const NormalRow& out) {
    const FloatTag d;
    const FloatVec s = hn::Set(d, scale);
    const FloatVec one = hn::Set(d, 1.0f);
    const auto end = static_cast<std::size_t>(count);
    for (std::size_t i = 0; i < end; i += hn::Lanes(d)) {
        Vec3 n = {hn::Mul(s, hn::LoadU(d, in.x + i)), hn::Mul(s, hn::LoadU(d, in.y + i)), hn::LoadU(d, in.z + i)};
        if (mode == ScaleMode::xy) {
            const FloatVec squared = hn::Add(hn::Mul(n.x, n.x), hn::Mul(n.y, n.y));
            n.z = hn::Sqrt(hn::Sub(one, hn::Min(squared, one)));
        }
        StoreVec3(d, NormaliseUpper(d, n), out.x + i, out.y + i, out.z + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, scale_row, ScaleRow,
           (const VectorRow& in, float scale, ScaleMode mode, int count, const NormalRow& out),
           (in, scale, mode, count, out))

}  // namespace tex::inline v1
#endif
