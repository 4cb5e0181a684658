// SPDX-License-Identifier: Apache-2.0
// vectors-inl.h: normals in vector registers, for kernels. Include it after hwy/highway.h, once for each target.

#if defined(TEX_KERNELS_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TEX_KERNELS_VECTORS_INL_H
#undef TEX_KERNELS_VECTORS_INL_H
#else
#define TEX_KERNELS_VECTORS_INL_H
#endif

#include <cstddef>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

using FloatTag = hwy::HWY_NAMESPACE::CappedTag<float, 16>;
using FloatVec = hwy::HWY_NAMESPACE::Vec<FloatTag>;
using FloatMask = hwy::HWY_NAMESPACE::Mask<FloatTag>;

struct Vec3 {
    FloatVec x, y, z;
};

HWY_INLINE Vec3 LoadVec3(FloatTag d, const float* x, const float* y, const float* z) {
    namespace hn = hwy::HWY_NAMESPACE;
    return {hn::LoadU(d, x), hn::LoadU(d, y), hn::LoadU(d, z)};
}

HWY_INLINE void StoreVec3(FloatTag d, Vec3 n, float* x, float* y, float* z) {
    namespace hn = hwy::HWY_NAMESPACE;
    hn::StoreU(n.x, d, x);
    hn::StoreU(n.y, d, y);
    hn::StoreU(n.z, d, z);
}

// n if `sound` is set, otherwise (0, 0, 1).
HWY_INLINE Vec3 FlatUnless(FloatTag d, FloatMask sound, Vec3 n) {
    namespace hn = hwy::HWY_NAMESPACE;
    return {hn::IfThenElseZero(sound, n.x), hn::IfThenElseZero(sound, n.y),
            hn::IfThenElse(sound, n.z, hn::Set(d, 1.0f))};
}

// |n|^2.
HWY_INLINE FloatVec SquaredLength(Vec3 n) {
    namespace hn = hwy::HWY_NAMESPACE;
    return hn::Add(hn::Add(hn::Mul(n.x, n.x), hn::Mul(n.y, n.y)), hn::Mul(n.z, n.z));
}

// n / |n|; (0, 0, 1) if n is shorter than 1e-6.
HWY_INLINE Vec3 Normalise(FloatTag d, Vec3 n) {
    namespace hn = hwy::HWY_NAMESPACE;
    const FloatVec length = hn::Sqrt(SquaredLength(n));
    const FloatMask sound = hn::Ge(length, hn::Set(d, 1e-6f));
    return FlatUnless(d, sound, {hn::Div(n.x, length), hn::Div(n.y, length), hn::Div(n.z, length)});
}

// Normalises after negative z has become 0.
HWY_INLINE Vec3 NormaliseUpper(FloatTag d, Vec3 n) {
    namespace hn = hwy::HWY_NAMESPACE;
    return Normalise(d, {n.x, n.y, hn::Max(n.z, hn::Zero(d))});
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#endif  // once for each target
