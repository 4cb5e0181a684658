// SPDX-License-Identifier: Apache-2.0

#include "kernels/chords.h"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/chords.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using ChordFloats = hn::CappedTag<float, 16>;

// The factor for decoded x and y, whose squared length is `square`: its inverse length where that is above 1, so that
// the vector has unit length and z is 0; elsewhere 1. Few blocks have texels above 1.
hn::Vec<ChordFloats> rim_factor(hn::Vec<ChordFloats> square) {
    const ChordFloats d;
    const auto one = hn::Set(d, 1.0f);
    if (hn::AllTrue(d, hn::Le(square, one))) return one;
    return hn::Div(one, hn::Sqrt(hn::Max(one, square)));
}

void block_chords_target(const float* const normals[3], const float x[16], const float y[16], float chords[16]) {
    const ChordFloats d;
    const auto one = hn::Set(d, 1.0f);
    for (int i = 0; i < 16; i += static_cast<int>(hn::Lanes(d))) {
        const auto mx = hn::LoadU(d, x + i);
        const auto my = hn::LoadU(d, y + i);
        const auto flat = hn::Add(hn::Mul(mx, mx), hn::Mul(my, my));
        const auto factor = rim_factor(flat);
        const auto mz = hn::Sqrt(hn::Sub(one, hn::Min(one, flat)));
        const auto dx = hn::Sub(hn::LoadU(d, normals[0] + i), hn::Mul(mx, factor));
        const auto dy = hn::Sub(hn::LoadU(d, normals[1] + i), hn::Mul(my, factor));
        const auto dz = hn::Sub(hn::LoadU(d, normals[2] + i), mz);
        const auto square = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
        hn::StoreU(hn::Sqrt(square), d, chords + i);
    }
}

void chord_sums_target(const ChordTexels& texels, const float* values, int stride, int count, float* sums) {
    const ChordFloats d;
    const auto one = hn::Set(d, 1.0f);
    for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
        auto sum = hn::Zero(d);
        auto allowed = hn::Eq(one, one);
        for (int k = 0; k < 16; ++k) {
            const auto value = hn::LoadU(d, values + static_cast<std::ptrdiff_t>(k) * stride + i);
            const auto decoded = hn::Set(d, texels.decoded[k]);
            const auto flat = hn::Add(hn::Mul(value, value), hn::Mul(decoded, decoded));
            const auto factor = rim_factor(flat);
            const auto dv = hn::Sub(hn::Set(d, texels.own[k]), hn::Mul(value, factor));
            const auto dw = hn::Sub(hn::Set(d, texels.other[k]), hn::Mul(decoded, factor));
            const auto dz = hn::Sub(hn::Set(d, texels.z[k]), hn::Sqrt(hn::Sub(one, hn::Min(one, flat))));
            const auto square = hn::Add(hn::Add(hn::Mul(dv, dv), hn::Mul(dw, dw)), hn::Mul(dz, dz));
            const auto chord = hn::Sqrt(square);
            allowed = hn::And(allowed, hn::Le(chord, hn::Set(d, texels.most[k])));
            sum = hn::Add(sum, hn::Mul(chord, hn::Set(d, texels.inside[k])));
        }
        hn::StoreU(hn::IfThenElse(allowed, sum, hn::Set(d, kTooLong)), d, sums + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, block_chords, block_chords_target,
           (const float* const normals[3], const float x[16], const float y[16], float chords[16]),
           (normals, x, y, chords))

TEX_KERNEL(void, chord_sums, chord_sums_target,
           (const ChordTexels& texels, const float* values, int stride, int count, float* sums),
           (texels, values, stride, count, sums))

}  // namespace tex::inline v1
#endif
