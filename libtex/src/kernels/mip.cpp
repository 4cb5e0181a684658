// SPDX-License-Identifier: Apache-2.0

#include "kernels/mip.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/mip.cpp"
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

void FilterRows(const float* const* rows, const float* weights, int taps, int count, float* out) {
    for (int i = 0; i < count; i += kLanes) {
        V sum = hn::Mul(hn::Set(kD, weights[0]), hn::LoadU(kD, rows[0] + i));
        for (int k = 1; k < taps; ++k) {
            sum = hn::Add(sum, hn::Mul(hn::Set(kD, weights[k]), hn::LoadU(kD, rows[k] + i)));
        }
        hn::StoreU(sum, kD, out + i);
    }
}

void SplitRow(const float* row, int count, float* even, float* odd) {
    for (std::ptrdiff_t i = 0; i < count; i += kLanes) {
        V a, b;
        hn::LoadInterleaved2(kD, row + 2 * i, a, b);
        hn::StoreU(a, kD, even + i);
        hn::StoreU(b, kD, odd + i);
    }
}

void FilterColumns(const float* even, const float* odd, const float* weights, std::ptrdiff_t stride, int taps,
                   int count, float* out) {
    for (int i = 0; i < count; i += kLanes) {
        V sum = hn::Mul(hn::LoadU(kD, weights + i), hn::LoadU(kD, even + i));
        for (int k = 1; k < taps; ++k) {
            const float* half = (k & 1) != 0 ? odd : even;
            sum = hn::Add(sum, hn::Mul(hn::LoadU(kD, weights + k * stride + i), hn::LoadU(kD, half + i + k / 2)));
        }
        hn::StoreU(sum, kD, out + i);
    }
}

void FilterColumnsEvenly(const float* even, const float* odd, const float* weights, int taps, int count, float* out) {
    for (int i = 0; i < count; i += kLanes) {
        V sum = hn::Mul(hn::Set(kD, weights[0]), hn::LoadU(kD, even + i));
        for (int k = 1; k < taps; ++k) {
            const float* half = (k & 1) != 0 ? odd : even;
            sum = hn::Add(sum, hn::Mul(hn::Set(kD, weights[k]), hn::LoadU(kD, half + i + k / 2)));
        }
        hn::StoreU(sum, kD, out + i);
    }
}

void HalveRows(const float* upper, const float* lower, int count, float* out) {
    // Half the width of other kernels' vectors: two of these are 64 bytes, the padding of a row.
    using Half = hn::CappedTag<float, 8>;
    const Half d;
    const auto half = hn::Set(d, 0.5f);
    constexpr int kStep = static_cast<int>(hn::MaxLanes(Half()));
    for (std::ptrdiff_t i = 0; i < count; i += kStep) {
        hn::Vec<Half> a, b, c, e;
        hn::LoadInterleaved2(d, upper + 2 * i, a, b);
        hn::LoadInterleaved2(d, lower + 2 * i, c, e);
        const auto left = hn::Add(hn::Mul(half, a), hn::Mul(half, c));
        const auto right = hn::Add(hn::Mul(half, b), hn::Mul(half, e));
        hn::StoreU(hn::Add(hn::Mul(half, left), hn::Mul(half, right)), d, out + i);
    }
}

void SlopesOfVectors(const float* x, const float* y, const float* z, int count, float* p, float* q) {
    const V least_z = hn::Set(kD, 1.0f / 256.0f);
    for (int i = 0; i < count; i += kLanes) {
        const V depth = hn::Max(hn::LoadU(kD, z + i), least_z);
        hn::StoreU(hn::Div(hn::LoadU(kD, x + i), depth), kD, p + i);
        hn::StoreU(hn::Div(hn::LoadU(kD, y + i), depth), kD, q + i);
    }
}

struct Vectors {
    V x, y, z;
};

HWY_INLINE V length(Vectors v) {
    return hn::Sqrt(hn::Add(hn::Add(hn::Mul(v.x, v.x), hn::Mul(v.y, v.y)), hn::Mul(v.z, v.z)));
}

// Unit vectors; (0, 0, 1) for vectors shorter than 1e-6.
HWY_INLINE Vectors normalised(Vectors v) {
    const V one = hn::Set(kD, 1.0f);
    const V size = length(v);
    const auto null = hn::Lt(size, hn::Set(kD, 1e-6f));
    const V scale = hn::Div(one, hn::IfThenElse(null, one, size));
    return {hn::IfThenZeroElse(null, hn::Mul(v.x, scale)), hn::IfThenZeroElse(null, hn::Mul(v.y, scale)),
            hn::IfThenElse(null, one, hn::Mul(v.z, scale))};
}

// normalize(lerp(v, (0, 0, 1), fade)) of unit vectors with z >= 0. The interpolated vector is never null.
HWY_INLINE Vectors faded(Vectors v, V fade) {
    const V rest = hn::Sub(hn::Set(kD, 1.0f), fade);
    return normalised({hn::Mul(v.x, rest), hn::Mul(v.y, rest), hn::Add(hn::Mul(v.z, rest), fade)});
}

HWY_INLINE void store(Vectors v, float* x, float* y, float* z) {
    hn::StoreU(v.x, kD, x);
    hn::StoreU(v.y, kD, y);
    hn::StoreU(v.z, kD, z);
}

void FinishVectors(float* x, float* y, float* z, int count, float fade, float least_z) {
    const V amount = hn::Set(kD, fade);
    for (int i = 0; i < count; i += kLanes) {
        const V depth = hn::Max(hn::LoadU(kD, z + i), hn::Set(kD, least_z));
        Vectors v = normalised({hn::LoadU(kD, x + i), hn::LoadU(kD, y + i), depth});
        if (fade > 0.0f) v = faded(v, amount);
        store(v, x + i, y + i, z + i);
    }
}

void FinishSlopes(float* x, float* y, float* z, int count, float fade) {
    const V amount = hn::Set(kD, fade);
    for (int i = 0; i < count; i += kLanes) {
        Vectors v = normalised({hn::LoadU(kD, x + i), hn::LoadU(kD, y + i), hn::Set(kD, 1.0f)});
        if (fade > 0.0f) v = faded(v, amount);
        store(v, x + i, y + i, z + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, filter_rows, FilterRows,
           (const float* const* rows, const float* weights, int taps, int count, float* out),
           (rows, weights, taps, count, out))

TEX_KERNEL(void, split_row, SplitRow, (const float* row, int count, float* even, float* odd), (row, count, even, odd))

TEX_KERNEL(void, filter_columns, FilterColumns,
           (const float* even, const float* odd, const float* weights, std::ptrdiff_t stride, int taps, int count,
            float* out),
           (even, odd, weights, stride, taps, count, out))

TEX_KERNEL(void, filter_columns_evenly, FilterColumnsEvenly,
           (const float* even, const float* odd, const float* weights, int taps, int count, float* out),
           (even, odd, weights, taps, count, out))

TEX_KERNEL(void, halve_rows, HalveRows, (const float* upper, const float* lower, int count, float* out),
           (upper, lower, count, out))

TEX_KERNEL(void, slopes_of_vectors, SlopesOfVectors,
           (const float* x, const float* y, const float* z, int count, float* p, float* q), (x, y, z, count, p, q))

TEX_KERNEL(void, finish_vectors, FinishVectors, (float* x, float* y, float* z, int count, float fade, float least_z),
           (x, y, z, count, fade, least_z))

TEX_KERNEL(void, finish_slopes, FinishSlopes, (float* x, float* y, float* z, int count, float fade),
           (x, y, z, count, fade))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
