// SPDX-License-Identifier: Apache-2.0

#include "kernels/slopes.h"

#include <cstddef>
#include <limits>

#include "kernels/bake.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/slopes.cpp"
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
constexpr D kD;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(kD));

struct Slopes {
    V p, q;
    M valid;
};

HWY_INLINE V limited(V slope) { return hn::Min(hn::Max(slope, hn::Set(kD, -kMaxSlope)), hn::Set(kD, kMaxSlope)); }

// Comparisons with NaN are false, so a texel is valid only if all of them hold.
HWY_INLINE Slopes slopes_at(const VectorRow& normals, float least_z, int i) {
    const Vec3 n = LoadVec3(kD, normals.x + i, normals.y + i, normals.z + i);
    const V infinity = hn::Set(kD, std::numeric_limits<float>::infinity());
    const M upright = hn::And(hn::Ge(n.z, hn::Set(kD, least_z)), hn::Lt(n.z, infinity));
    const M finite = hn::And(hn::Lt(hn::Abs(n.x), infinity), hn::Lt(hn::Abs(n.y), infinity));
    const M valid = hn::And(upright, finite);
    // 0 - x / z: a flat texel has slope +0.
    const V zero = hn::Zero(kD);
    const V p = limited(hn::Sub(zero, hn::Div(n.x, n.z)));
    const V q = limited(hn::Sub(zero, hn::Div(n.y, n.z)));
    return {hn::IfThenElseZero(valid, p), hn::IfThenElseZero(valid, q), valid};
}

int SlopesOfNormals(const VectorRow& normals, float least_z, int count, float* p, float* q) {
    std::size_t invalid = 0;
    for (int i = 0; i < count; i += kLanes) {
        const Slopes slopes = slopes_at(normals, least_z, i);
        const M inside = hn::FirstN(kD, static_cast<std::size_t>(count - i));
        invalid += hn::CountTrue(kD, hn::AndNot(slopes.valid, inside));
        hn::StoreU(slopes.p, kD, p + i);
        hn::StoreU(slopes.q, kD, q + i);
    }
    return static_cast<int>(invalid);
}

void ExcessSlopes(const VectorRow& normals, const VectorRow& made, float least_z, int count, float* p, float* q) {
    for (int i = 0; i < count; i += kLanes) {
        const Slopes wanted = slopes_at(normals, least_z, i);
        const Slopes is = slopes_at(made, std::numeric_limits<float>::min(), i);
        hn::StoreU(hn::IfThenElseZero(wanted.valid, hn::Sub(wanted.p, is.p)), kD, p + i);
        hn::StoreU(hn::IfThenElseZero(wanted.valid, hn::Sub(wanted.q, is.q)), kD, q + i);
    }
}

int CountWithoutSlope(const VectorRow& normals, float least_z, int count) {
    std::size_t without = 0;
    for (int i = 0; i < count; i += kLanes) {
        const M inside = hn::FirstN(kD, static_cast<std::size_t>(count - i));
        without += hn::CountTrue(kD, hn::AndNot(slopes_at(normals, least_z, i).valid, inside));
    }
    return static_cast<int>(without);
}

void ZeroWithoutNormal(const VectorRow& normals, int count, float* values) {
    const V infinity = hn::Set(kD, std::numeric_limits<float>::infinity());
    for (int i = 0; i < count; i += kLanes) {
        const Vec3 n = LoadVec3(kD, normals.x + i, normals.y + i, normals.z + i);
        const M finite = hn::And(hn::And(hn::Lt(hn::Abs(n.x), infinity), hn::Lt(hn::Abs(n.y), infinity)),
                                 hn::Lt(hn::Abs(n.z), infinity));
        hn::StoreU(hn::IfThenElseZero(finite, hn::LoadU(kD, values + i)), kD, values + i);
    }
}

void SumDifferences(const float* x_plus, const float* x_minus, float x_factor, const float* y_plus,
                    const float* y_minus, float y_factor, int count, float* out) {
    const V fx = hn::Set(kD, x_factor);
    const V fy = hn::Set(kD, y_factor);
    for (int i = 0; i < count; i += kLanes) {
        const V dx = hn::Sub(hn::LoadU(kD, x_plus + i), hn::LoadU(kD, x_minus + i));
        const V dy = hn::Sub(hn::LoadU(kD, y_plus + i), hn::LoadU(kD, y_minus + i));
        hn::StoreU(hn::Add(hn::Mul(dx, fx), hn::Mul(dy, fy)), kD, out + i);
    }
}

void WeightedSum(const float* a, float a_factor, const float* b, float b_factor, int count, float* out) {
    const V fa = hn::Set(kD, a_factor);
    const V fb = hn::Set(kD, b_factor);
    for (int i = 0; i < count; i += kLanes) {
        const V sum = hn::Add(hn::Mul(hn::LoadU(kD, a + i), fa), hn::Mul(hn::LoadU(kD, b + i), fb));
        hn::StoreU(sum, kD, out + i);
    }
}

void ShiftAndScale(float offset, float factor, int count, float* values) {
    const V shift = hn::Set(kD, offset);
    const V scale = hn::Set(kD, factor);
    for (int i = 0; i < count; i += kLanes)
        hn::StoreU(hn::Mul(hn::Sub(hn::LoadU(kD, values + i), shift), scale), kD, values + i);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(int, slopes_of_normals, SlopesOfNormals,
           (const VectorRow& normals, float least_z, int count, float* p, float* q), (normals, least_z, count, p, q))

TEX_KERNEL(void, excess_slopes, ExcessSlopes,
           (const VectorRow& normals, const VectorRow& made, float least_z, int count, float* p, float* q),
           (normals, made, least_z, count, p, q))

TEX_KERNEL(int, count_without_slope, CountWithoutSlope, (const VectorRow& normals, float least_z, int count),
           (normals, least_z, count))

TEX_KERNEL(void, zero_without_normal, ZeroWithoutNormal, (const VectorRow& normals, int count, float* values),
           (normals, count, values))

TEX_KERNEL(void, sum_differences, SumDifferences,
           (const float* x_plus, const float* x_minus, float x_factor, const float* y_plus, const float* y_minus,
            float y_factor, int count, float* out),
           (x_plus, x_minus, x_factor, y_plus, y_minus, y_factor, count, out))

TEX_KERNEL(void, weighted_sum, WeightedSum,
           (const float* a, float a_factor, const float* b, float b_factor, int count, float* out),
           (a, a_factor, b, b_factor, count, out))

TEX_KERNEL(void, shift_and_scale, ShiftAndScale, (float offset, float factor, int count, float* values),
           (offset, factor, count, values))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
