// SPDX-License-Identifier: Apache-2.0

#include "kernels/blend.h"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/blend.cpp"
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

struct Whiteout {
    static Vec3 Blend(D, Vec3 a, Vec3 b) { return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Mul(a.z, b.z)}; }
};

struct Linear {
    static Vec3 Blend(D, Vec3 a, Vec3 b) { return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)}; }
};

struct PartialDerivative {
    static Vec3 Blend(D, Vec3 a, Vec3 b) {
        return {hn::Add(hn::Mul(a.x, b.z), hn::Mul(b.x, a.z)), hn::Add(hn::Mul(a.y, b.z), hn::Mul(b.y, a.z)),
                hn::Mul(a.z, b.z)};
    }
};

struct Udn {
    static Vec3 Blend(D, Vec3 a, Vec3 b) { return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), a.z}; }
};

struct Rnm {
    static Vec3 Blend(D d, Vec3 a, Vec3 b) {
        const Vec3 t = {a.x, a.y, hn::Add(a.z, hn::Set(d, 1.0f))};
        const Vec3 u = {hn::Neg(b.x), hn::Neg(b.y), b.z};
        const V dot = hn::Add(hn::Add(hn::Mul(t.x, u.x), hn::Mul(t.y, u.y)), hn::Mul(t.z, u.z));
        const V f = hn::Div(dot, t.z);
        return {hn::Sub(hn::Mul(t.x, f), u.x), hn::Sub(hn::Mul(t.y, f), u.y), hn::Sub(dot, u.z)};
    }
};

struct Overlay {
    static V Channel(D d, V n, V m) {
        const V half = hn::Set(d, 0.5f);
        const V one = hn::Set(d, 1.0f);
        const V a = hn::Mul(hn::Add(n, one), half);
        const V b = hn::Mul(hn::Add(m, one), half);
        const V product = hn::Mul(a, b);
        const V dark = hn::Add(product, product);
        const V inverse = hn::Mul(hn::Sub(one, a), hn::Sub(one, b));
        const V bright = hn::Sub(one, hn::Add(inverse, inverse));
        const V c = hn::IfThenElse(hn::Lt(a, half), dark, bright);
        return hn::Sub(hn::Add(c, c), one);
    }
    static Vec3 Blend(D d, Vec3 a, Vec3 b) {
        return {Channel(d, a.x, b.x), Channel(d, a.y, b.y), Channel(d, a.z, b.z)};
    }
};

// Interpolates; the result is exactly a at 0 and b at 1.
HWY_INLINE V Mix(D d, V a, V b, V t) { return hn::Add(hn::Mul(a, hn::Sub(hn::Set(d, 1.0f), t)), hn::Mul(b, t)); }

template <class Mode>
void BlendWith(NormalRow base, NormalRow detail, const float* weight, int count) {
    const D d;
    const auto end = static_cast<std::size_t>(count);
    for (std::size_t i = 0; i < end; i += hn::Lanes(d)) {
        const Vec3 a = LoadVec3(d, base.x + i, base.y + i, base.z + i);
        const Vec3 b = LoadVec3(d, detail.x + i, detail.y + i, detail.z + i);
        Vec3 n = NormaliseUpper(d, Mode::Blend(d, a, b));
        if (weight != nullptr) {
            const V t = hn::LoadU(d, weight + i);
            n = Normalise(d, {Mix(d, a.x, n.x, t), Mix(d, a.y, n.y, t), Mix(d, a.z, n.z, t)});
        }
        StoreVec3(d, n, base.x + i, base.y + i, base.z + i);
    }
}

void BlendRow(BlendMode mode, NormalRow base, NormalRow detail, const float* weight, int count) {
    switch (mode) {
        case BlendMode::whiteout: return BlendWith<Whiteout>(base, detail, weight, count);
        case BlendMode::linear: return BlendWith<Linear>(base, detail, weight, count);
        case BlendMode::partial_derivative: return BlendWith<PartialDerivative>(base, detail, weight, count);
        case BlendMode::udn: return BlendWith<Udn>(base, detail, weight, count);
        case BlendMode::rnm: return BlendWith<Rnm>(base, detail, weight, count);
        case BlendMode::overlay: return BlendWith<Overlay>(base, detail, weight, count);
    }
}

void RotateRow(NormalRow row, float cosine, float sine, int count) {
    const D d;
    const V c = hn::Set(d, cosine);
    const V s = hn::Set(d, sine);
    const auto end = static_cast<std::size_t>(count);
    for (std::size_t i = 0; i < end; i += hn::Lanes(d)) {
        const V x = hn::LoadU(d, row.x + i);
        const V y = hn::LoadU(d, row.y + i);
        hn::StoreU(hn::Sub(hn::Mul(c, x), hn::Mul(s, y)), d, row.x + i);
        hn::StoreU(hn::Add(hn::Mul(s, x), hn::Mul(c, y)), d, row.y + i);
    }
}

void MixRow(float* a, const float* b, float t, int count) {
    const D d;
    const V weight = hn::Set(d, t);
    const auto end = static_cast<std::size_t>(count);
    for (std::size_t i = 0; i < end; i += hn::Lanes(d)) {
        hn::StoreU(Mix(d, hn::LoadU(d, a + i), hn::LoadU(d, b + i), weight), d, a + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, blend_row, BlendRow,
           (BlendMode mode, NormalRow base, NormalRow detail, const float* weight, int count),
           (mode, base, detail, weight, count))

TEX_KERNEL(void, rotate_row, RotateRow, (NormalRow row, float cosine, float sine, int count),
           (row, cosine, sine, count))

TEX_KERNEL(void, mix_row, MixRow, (float* a, const float* b, float t, int count), (a, b, t, count))

}  // namespace tex::inline v1
#endif
