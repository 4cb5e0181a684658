// SPDX-License-Identifier: Apache-2.0

#include "kernels/height_field.h"

#include <cstddef>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/height_field.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
constexpr D kD;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(kD));

struct Colors {
    V r, g, b;
};

HWY_INLINE Colors load(ColorRow in, int i) {
    return {hn::LoadU(kD, in.r + i), hn::LoadU(kD, in.g + i), hn::LoadU(kD, in.b + i)};
}

// The lanes of a vector at texel i that lie before `count`.
HWY_INLINE M inside(int i, int count) { return hn::FirstN(kD, static_cast<std::size_t>(count - i)); }

HWY_INLINE std::int64_t number_of(M mask) { return static_cast<std::int64_t>(hn::CountTrue(kD, mask)); }

HWY_INLINE V luma(Colors c) {
    return hn::Add(hn::Add(hn::Mul(hn::Set(kD, 0.2126f), c.r), hn::Mul(hn::Set(kD, 0.7152f), c.g)),
                   hn::Mul(hn::Set(kD, 0.0722f), c.b));
}

void LumaRow(ColorRow in, int count, float* out) {
    for (int i = 0; i < count; i += kLanes) hn::StoreU(luma(load(in, i)), kD, out + i);
}

void AverageRow(ColorRow in, int count, float* out) {
    const V three = hn::Set(kD, 3.0f);
    for (int i = 0; i < count; i += kLanes) {
        const Colors c = load(in, i);
        hn::StoreU(hn::Div(hn::Add(hn::Add(c.r, c.g), c.b), three), kD, out + i);
    }
}

void MaxRow(ColorRow in, int count, float* out) {
    const V nan = hn::NaN(kD);
    for (int i = 0; i < count; i += kLanes) {
        const Colors c = load(in, i);
        const M invalid = hn::Or(hn::Or(hn::IsNaN(c.r), hn::IsNaN(c.g)), hn::IsNaN(c.b));
        hn::StoreU(hn::IfThenElse(invalid, nan, hn::Max(hn::Max(c.r, c.g), c.b)), kD, out + i);
    }
}

std::int64_t AutomaticRow(ColorRow in, int count, float* out) {
    std::int64_t differing = 0;
    for (int i = 0; i < count; i += kLanes) {
        const Colors c = load(in, i);
        const M grey = hn::And(hn::Eq(c.r, c.g), hn::Eq(c.g, c.b));
        const V value = luma(c);
        hn::StoreU(hn::IfThenElse(grey, c.r, value), kD, out + i);
        differing += number_of(hn::And(hn::AndNot(grey, hn::IsFinite(value)), inside(i, count)));
    }
    return differing;
}

std::int64_t CleanRow(float* row, int count, float no_data, bool invert) {
    const V nan = hn::NaN(kD);
    const V one = hn::Set(kD, 1.0f);
    const V unwanted = hn::Set(kD, no_data);
    std::int64_t invalid = 0;
    for (int i = 0; i < count; i += kLanes) {
        const V h = hn::LoadU(kD, row + i);
        const M bad = hn::Or(hn::Not(hn::IsFinite(h)), hn::Eq(h, unwanted));
        hn::StoreU(hn::IfThenElse(bad, nan, invert ? hn::Sub(one, h) : h), kD, row + i);
        invalid += number_of(hn::And(bad, inside(i, count)));
    }
    return invalid;
}

void SmoothRow(const float* row, const float* smoothing, int radius, int count, float* out) {
    for (int i = 0; i < count; i += kLanes) {
        V sum = hn::Zero(kD);
        for (int k = radius; k >= 1; --k) {
            const V both = hn::Add(hn::LoadU(kD, row + i - k), hn::LoadU(kD, row + i + k));
            sum = hn::Add(sum, hn::Mul(hn::Set(kD, smoothing[k]), both));
        }
        hn::StoreU(hn::Add(sum, hn::Mul(hn::Set(kD, smoothing[0]), hn::LoadU(kD, row + i))), kD, out + i);
    }
}

void SmoothColumn(const float* const* rows, const float* smoothing, int radius, int count, float* out) {
    for (int i = 0; i < count; i += kLanes) {
        V sum = hn::Zero(kD);
        for (int k = radius; k >= 1; --k) {
            const V both = hn::Add(hn::LoadU(kD, rows[radius - k] + i), hn::LoadU(kD, rows[radius + k] + i));
            sum = hn::Add(sum, hn::Mul(hn::Set(kD, smoothing[k]), both));
        }
        hn::StoreU(hn::Add(sum, hn::Mul(hn::Set(kD, smoothing[0]), hn::LoadU(kD, rows[radius] + i))), kD, out + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, luma_row, LumaRow, (ColorRow in, int count, float* out), (in, count, out))

TEX_KERNEL(void, average_row, AverageRow, (ColorRow in, int count, float* out), (in, count, out))

TEX_KERNEL(void, max_row, MaxRow, (ColorRow in, int count, float* out), (in, count, out))

TEX_KERNEL(std::int64_t, automatic_row, AutomaticRow, (ColorRow in, int count, float* out), (in, count, out))

TEX_KERNEL(std::int64_t, clean_row, CleanRow, (float* row, int count, float no_data, bool invert),
           (row, count, no_data, invert))

TEX_KERNEL(void, smooth_row, SmoothRow, (const float* row, const float* smoothing, int radius, int count, float* out),
           (row, smoothing, radius, count, out))

TEX_KERNEL(void, smooth_column, SmoothColumn,
           (const float* const* rows, const float* smoothing, int radius, int count, float* out),
           (rows, smoothing, radius, count, out))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
