// SPDX-License-Identifier: Apache-2.0

#include "kernels/bake.h"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bake.cpp"
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

HWY_INLINE V clamped(V v, V limit) { return hn::Min(hn::Max(v, hn::Neg(limit)), limit); }

// The scaled height at `in`.
HWY_INLINE V height(const float* in, V scale) {
    return clamped(hn::Mul(hn::LoadU(kD, in), scale), hn::Set(kD, kMaxHeight));
}

bool AreFinite(const float* row, int count) {
    auto bad = hn::FirstN(kD, 0);
    for (int i = 0; i < count; i += kLanes) {
        const auto inside = hn::FirstN(kD, static_cast<std::size_t>(count - i));
        bad = hn::Or(bad, hn::AndNot(hn::IsFinite(hn::LoadU(kD, row + i)), inside));
    }
    return hn::AllFalse(kD, bad);
}

void LimitHeights(const float* in, float scale, int count, float* out) {
    const V s = hn::Set(kD, scale);
    for (int i = 0; i < count; i += kLanes) hn::StoreU(height(in + i, s), kD, out + i);
}

void ContinueHeights(const float* inner, const float* edge, const float* other, bool reflected, float drift,
                     float scale, int count, float* out) {
    const V s = hn::Set(kD, scale);
    const V two = hn::Set(kD, 2.0f);
    const V periods = hn::Set(kD, drift);
    for (int i = 0; i < count; i += kLanes) {
        const V h = height(inner + i, s);
        const V e = height(edge + i, s);
        const V o = height(other + i, s);
        const V base = reflected ? hn::Sub(hn::Mul(two, e), h) : h;
        hn::StoreU(hn::Add(base, hn::Mul(periods, hn::Sub(e, o))), kD, out + i);
    }
}

// Stores normalize(-slope_x, -slope_y, 1). Because values are subtracted from zero, x and y of a flat normal are +0,
// never -0.
HWY_INLINE void store_normals(V slope_x, V slope_y, int i, NormalRow out) {
    const V zero = hn::Zero(kD);
    const V one = hn::Set(kD, 1.0f);
    const V limit = hn::Set(kD, kMaxSlope);
    const V x = hn::Sub(zero, clamped(slope_x, limit));
    const V y = hn::Sub(zero, clamped(slope_y, limit));
    const V square = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), one);
    const V scale = hn::Div(one, hn::Sqrt(square));
    hn::StoreU(hn::Mul(x, scale), kD, out.x + i);
    hn::StoreU(hn::Mul(y, scale), kD, out.y + i);
    hn::StoreU(scale, kD, out.z + i);
}

void NormalsByDifference(const float* left, const float* right, const float* down, const float* up, float scale_x,
                         float scale_y, int count, NormalRow out) {
    const V sx = hn::Set(kD, scale_x);
    const V sy = hn::Set(kD, scale_y);
    for (int i = 0; i < count; i += kLanes) {
        const V du = hn::Sub(hn::LoadU(kD, right + i), hn::LoadU(kD, left + i));
        const V dv = hn::Sub(hn::LoadU(kD, up + i), hn::LoadU(kD, down + i));
        store_normals(hn::Mul(du, sx), hn::Mul(dv, sy), i, out);
    }
}

void DeriveRow(const float* row, const float* derivative, int radius, int count, float* out) {
    for (int i = 0; i < count; i += kLanes) {
        V sum = hn::Zero(kD);
        for (int k = 1; k <= radius; ++k) {
            const V difference = hn::Sub(hn::LoadU(kD, row + i + k), hn::LoadU(kD, row + i - k));
            sum = hn::Add(sum, hn::Mul(hn::Set(kD, derivative[k - 1]), difference));
        }
        hn::StoreU(sum, kD, out + i);
    }
}

void DeriveColumn(const float* const* rows, const float* derivative, int radius, int count, float* out) {
    for (int i = 0; i < count; i += kLanes) {
        V sum = hn::Zero(kD);
        for (int k = 1; k <= radius; ++k) {
            const V difference = hn::Sub(hn::LoadU(kD, rows[radius - k] + i), hn::LoadU(kD, rows[radius + k] + i));
            sum = hn::Add(sum, hn::Mul(hn::Set(kD, derivative[k - 1]), difference));
        }
        hn::StoreU(sum, kD, out + i);
    }
}

void NormalsBySmoothing(const float* const* du, const float* dv, const float* smoothing, int radius, float scale_x,
                        float scale_y, int count, NormalRow out) {
    const V sx = hn::Set(kD, scale_x);
    const V sy = hn::Set(kD, scale_y);
    for (int i = 0; i < count; i += kLanes) {
        const V centre = hn::Set(kD, smoothing[0]);
        V slope_x = hn::Mul(centre, hn::LoadU(kD, du[radius] + i));
        V slope_y = hn::Mul(centre, hn::LoadU(kD, dv + i));
        for (int k = 1; k <= radius; ++k) {
            const V weight = hn::Set(kD, smoothing[k]);
            const V both_x = hn::Add(hn::LoadU(kD, du[radius - k] + i), hn::LoadU(kD, du[radius + k] + i));
            const V both_y = hn::Add(hn::LoadU(kD, dv + i - k), hn::LoadU(kD, dv + i + k));
            slope_x = hn::Add(slope_x, hn::Mul(weight, both_x));
            slope_y = hn::Add(slope_y, hn::Mul(weight, both_y));
        }
        store_normals(hn::Mul(slope_x, sx), hn::Mul(slope_y, sy), i, out);
    }
}

void WidenSlopeBounds(const float* x, const float* y, const float* z, int count, SlopeBounds& bounds) {
    const V least_z = hn::Set(kD, 1e-16f);
    const V zero = hn::Zero(kD);
    V min_x = hn::Set(kD, bounds.min_x), max_x = hn::Set(kD, bounds.max_x);
    V min_y = hn::Set(kD, bounds.min_y), max_y = hn::Set(kD, bounds.max_y);
    for (int i = 0; i < count; i += kLanes) {
        const V depth = hn::Max(hn::LoadU(kD, z + i), least_z);
        // 0 - x / z: a flat texel has slope +0, never -0, because the order of +0 and -0 depends on the processor.
        const V p = hn::Sub(zero, hn::Div(hn::LoadU(kD, x + i), depth));
        const V q = hn::Sub(zero, hn::Div(hn::LoadU(kD, y + i), depth));
        const auto inside = hn::FirstN(kD, static_cast<std::size_t>(count - i));
        min_x = hn::Min(min_x, hn::IfThenElse(inside, p, min_x));
        max_x = hn::Max(max_x, hn::IfThenElse(inside, p, max_x));
        min_y = hn::Min(min_y, hn::IfThenElse(inside, q, min_y));
        max_y = hn::Max(max_y, hn::IfThenElse(inside, q, max_y));
    }
    bounds = {hn::GetLane(hn::MinOfLanes(kD, min_x)), hn::GetLane(hn::MaxOfLanes(kD, max_x)),
              hn::GetLane(hn::MinOfLanes(kD, min_y)), hn::GetLane(hn::MaxOfLanes(kD, max_y))};
}

int CountBelow(const float* values, float limit, int count) {
    const V least = hn::Set(kD, limit);
    std::size_t below = 0;
    for (int i = 0; i < count; i += kLanes) {
        const auto inside = hn::FirstN(kD, static_cast<std::size_t>(count - i));
        below += hn::CountTrue(kD, hn::And(inside, hn::Lt(hn::LoadU(kD, values + i), least)));
    }
    return static_cast<int>(below);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(bool, are_finite, AreFinite, (const float* row, int count), (row, count))

TEX_KERNEL(void, limit_heights, LimitHeights, (const float* in, float scale, int count, float* out),
           (in, scale, count, out))

TEX_KERNEL(void, continue_heights, ContinueHeights,
           (const float* inner, const float* edge, const float* other, bool reflected, float drift, float scale,
            int count, float* out),
           (inner, edge, other, reflected, drift, scale, count, out))

TEX_KERNEL(void, normals_by_difference, NormalsByDifference,
           (const float* left, const float* right, const float* down, const float* up, float scale_x, float scale_y,
            int count, NormalRow out),
           (left, right, down, up, scale_x, scale_y, count, out))

TEX_KERNEL(void, derive_row, DeriveRow, (const float* row, const float* derivative, int radius, int count, float* out),
           (row, derivative, radius, count, out))

TEX_KERNEL(void, derive_column, DeriveColumn,
           (const float* const* rows, const float* derivative, int radius, int count, float* out),
           (rows, derivative, radius, count, out))

TEX_KERNEL(void, normals_by_smoothing, NormalsBySmoothing,
           (const float* const* du, const float* dv, const float* smoothing, int radius, float scale_x, float scale_y,
            int count, NormalRow out),
           (du, dv, smoothing, radius, scale_x, scale_y, count, out))

TEX_KERNEL(void, widen_slope_bounds, WidenSlopeBounds,
           (const float* x, const float* y, const float* z, int count, SlopeBounds& bounds), (x, y, z, count, bounds))

TEX_KERNEL(int, count_below, CountBelow, (const float* values, float limit, int count), (values, limit, count))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
