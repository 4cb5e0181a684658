// SPDX-License-Identifier: Apache-2.0

#include "kernels/unpack.h"

#include <cstddef>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/unpack.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = FloatTag;
using V = FloatVec;
using M = FloatMask;

// The component n of a stored value.
V Component(D d, V value, const UnpackRule& rule) {
    if (!rule.is_unsigned) return value;
    const V n = hn::Sub(hn::Add(value, value), hn::Set(d, 1.0f));
    if (!rule.snap_flat) return n;
    // 1/255 and a little more, because 127/255 and 128/255 are rounded.
    const M flat = hn::Le(hn::Abs(n), hn::Set(d, 0.003922f));
    return hn::IfThenZeroElse(flat, n);
}

V StoredZ(D d, V value, const UnpackRule& rule) { return rule.is_z01 ? value : Component(d, value, rule); }

// False for NaN and infinity.
M IsFinite(D d, V value) { return hn::Lt(value, hn::Set(d, std::numeric_limits<float>::infinity())); }

// Whether a vector has unit length, apart from the rounding of a normalised vector's components (below 2^-21) and of
// this sum.
M IsUnit(D d, V squared_length) {
    return hn::Le(hn::Abs(hn::Sub(squared_length, hn::Set(d, 1.0f))), hn::Set(d, 0x1p-20f));
}

Vec3 Settled(D d, M finite, const UnpackRule& rule, Vec3 n) {
    if (!rule.keep_invalid) return FlatUnless(d, finite, n);
    const V nan = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
    return {hn::IfThenElse(finite, n.x, nan), hn::IfThenElse(finite, n.y, nan), hn::IfThenElse(finite, n.z, nan)};
}

Vec3 Reconstruct(D d, V x, V y, const UnpackRule& rule) {
    const V one = hn::Set(d, 1.0f);
    const V squared = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
    const V z = hn::Sqrt(hn::Sub(one, hn::Min(squared, one)));
    const M finite = IsFinite(d, squared);
    if (rule.keep_length) return Settled(d, finite, rule, {x, y, z});
    // Division by 1 does not change a short vector.
    V length = hn::Max(one, hn::Sqrt(squared));
    if (rule.keep_unit) length = hn::IfThenElse(IsUnit(d, squared), one, length);
    return Settled(d, finite, rule, {hn::Div(x, length), hn::Div(y, length), z});
}

Vec3 Finish(D d, Vec3 n, const UnpackRule& rule) {
    const V squared = SquaredLength(n);
    const M finite = IsFinite(d, squared);
    if (rule.keep_length) return Settled(d, finite, rule, n);
    Vec3 unit = Normalise(d, n);
    if (rule.keep_unit) {
        const M keep = IsUnit(d, squared);
        unit = {hn::IfThenElse(keep, n.x, unit.x), hn::IfThenElse(keep, n.y, unit.y),
                hn::IfThenElse(keep, n.z, unit.z)};
    }
    return Settled(d, finite, rule, unit);
}

void UnpackRow(const float* x, const float* y, const float* z, const UnpackRule& rule, int count, float* out_x,
               float* out_y, float* out_z) {
    const D d;
    const auto end = static_cast<std::size_t>(count);
    for (std::size_t i = 0; i < end; i += hn::Lanes(d)) {
        const V nx = Component(d, hn::LoadU(d, x + i), rule);
        V ny = Component(d, hn::LoadU(d, y + i), rule);
        if (rule.flip_y) ny = hn::Neg(ny);
        const Vec3 n = z == nullptr ? Reconstruct(d, nx, ny, rule)
                                    : Finish(d, {nx, ny, StoredZ(d, hn::LoadU(d, z + i), rule)}, rule);
        StoreVec3(d, n, out_x + i, out_y + i, out_z + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, unpack_row, UnpackRow,
           (const float* x, const float* y, const float* z, const UnpackRule& rule, int count, float* out_x,
            float* out_y, float* out_z),
           (x, y, z, rule, count, out_x, out_y, out_z))

}  // namespace tex::inline v1
#endif
