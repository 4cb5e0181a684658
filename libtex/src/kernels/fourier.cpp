// SPDX-License-Identifier: Apache-2.0

#include "kernels/fourier.h"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/fourier.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
// Half a group; wider vectors would need other data in their upper halves.
using D = hn::CappedTag<float, kGroup / 2>;
using V = hn::Vec<D>;
constexpr D kD;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(kD));
constexpr int kHalf = kGroup / 2;

struct Complex {
    V re, im;
};

HWY_INLINE Complex load(const float* group) { return {hn::LoadU(kD, group), hn::LoadU(kD, group + kHalf)}; }
HWY_INLINE void store(Complex c, float* group) {
    hn::StoreU(c.re, kD, group);
    hn::StoreU(c.im, kD, group + kHalf);
}
HWY_INLINE Complex add(Complex a, Complex b) { return {hn::Add(a.re, b.re), hn::Add(a.im, b.im)}; }
HWY_INLINE Complex sub(Complex a, Complex b) { return {hn::Sub(a.re, b.re), hn::Sub(a.im, b.im)}; }
HWY_INLINE Complex scaled(Complex a, float factor) {
    const V f = hn::Set(kD, factor);
    return {hn::Mul(a.re, f), hn::Mul(a.im, f)};
}
// a / i
HWY_INLINE Complex over_i(Complex a) { return {a.im, hn::Neg(a.re)}; }
HWY_INLINE Complex mul(Complex a, const float* factor) {
    const V c = hn::Set(kD, factor[0]);
    const V s = hn::Set(kD, factor[1]);
    return {hn::Sub(hn::Mul(a.re, c), hn::Mul(a.im, s)), hn::Add(hn::Mul(a.re, s), hn::Mul(a.im, c))};
}

// The butterflies: `in` points to the first of `radix` groups that lie `step` floats apart, and so does `out`.
struct Radix2 {
    static constexpr int kRadix = 2;
    static HWY_INLINE void run(const float* in, std::ptrdiff_t step, const float* w, float* out, std::ptrdiff_t next) {
        const Complex a = load(in), b = load(in + step);
        store(add(a, b), out);
        store(mul(sub(a, b), w), out + next);
    }
};

struct Radix3 {
    static constexpr int kRadix = 3;
    static HWY_INLINE void run(const float* in, std::ptrdiff_t step, const float* w, float* out, std::ptrdiff_t next) {
        constexpr float kSin60 = 0.866025403784438647f;
        const Complex a = load(in), b = load(in + step), c = load(in + 2 * step);
        const Complex both = add(b, c);
        const Complex middle = sub(a, scaled(both, 0.5f));
        const Complex turned = scaled(over_i(sub(b, c)), kSin60);
        store(add(a, both), out);
        store(mul(add(middle, turned), w), out + next);
        store(mul(sub(middle, turned), w + 2), out + 2 * next);
    }
};

struct Radix4 {
    static constexpr int kRadix = 4;
    static HWY_INLINE void run(const float* in, std::ptrdiff_t step, const float* w, float* out, std::ptrdiff_t next) {
        const Complex a = load(in), b = load(in + step), c = load(in + 2 * step), d = load(in + 3 * step);
        const Complex even = add(a, c), odd = add(b, d);
        const Complex even_difference = sub(a, c), turned = over_i(sub(b, d));
        store(add(even, odd), out);
        store(mul(add(even_difference, turned), w), out + next);
        store(mul(sub(even, odd), w + 2), out + 2 * next);
        store(mul(sub(even_difference, turned), w + 4), out + 3 * next);
    }
};

struct Radix5 {
    static constexpr int kRadix = 5;
    static HWY_INLINE void run(const float* in, std::ptrdiff_t step, const float* w, float* out, std::ptrdiff_t next) {
        constexpr float kCos72 = 0.309016994374947424f, kCos144 = -0.809016994374947424f;
        constexpr float kSin72 = 0.951056516295153572f, kSin144 = 0.587785252292473129f;
        const Complex a = load(in);
        const Complex b = load(in + step), c = load(in + 2 * step), d = load(in + 3 * step), e = load(in + 4 * step);
        const Complex outer = add(b, e), inner = add(c, d);
        const Complex outer_difference = over_i(sub(b, e)), inner_difference = over_i(sub(c, d));
        const Complex middle1 = add(a, add(scaled(outer, kCos72), scaled(inner, kCos144)));
        const Complex middle2 = add(a, add(scaled(outer, kCos144), scaled(inner, kCos72)));
        const Complex turned1 = add(scaled(outer_difference, kSin72), scaled(inner_difference, kSin144));
        const Complex turned2 = sub(scaled(outer_difference, kSin144), scaled(inner_difference, kSin72));
        store(add(a, add(outer, inner)), out);
        store(mul(add(middle1, turned1), w), out + next);
        store(mul(add(middle2, turned2), w + 2), out + 2 * next);
        store(mul(sub(middle2, turned2), w + 4), out + 3 * next);
        store(mul(sub(middle1, turned1), w + 6), out + 4 * next);
    }
};

template <class Radix>
HWY_INLINE void run_stage(const FourierStage& stage, const float* in, float* out) {
    constexpr std::ptrdiff_t kRadix = Radix::kRadix;
    const std::ptrdiff_t m = stage.length / kRadix;
    const std::ptrdiff_t floats = static_cast<std::ptrdiff_t>(stage.stride) * kGroup;
    for (std::ptrdiff_t p = 0; p < m; ++p) {
        const float* w = stage.twiddles + 2 * (kRadix - 1) * p;
        const float* from = in + floats * p;
        float* to = out + floats * kRadix * p;
        for (std::ptrdiff_t q = 0; q < floats; q += kGroup) {
            for (int lane = 0; lane < kHalf; lane += kLanes)
                Radix::run(from + q + lane, floats * m, w, to + q + lane, floats);
        }
    }
}

void RunFourierStage(const FourierStage& stage, const float* in, float* out) {
    switch (stage.radix) {
        case 2: run_stage<Radix2>(stage, in, out); break;
        case 3: run_stage<Radix3>(stage, in, out); break;
        case 4: run_stage<Radix4>(stage, in, out); break;
        default: run_stage<Radix5>(stage, in, out); break;
    }
}

void MultiplyGroups(Product product, const float* factors, int count, float* data) {
    for (std::ptrdiff_t k = 0; k < count; ++k) {
        for (int lane = 0; lane < kHalf; lane += kLanes) {
            float* const group = data + k * kGroup + lane;
            Complex value = load(group);
            if (product == Product::of_conjugate) value.im = hn::Neg(value.im);
            value = mul(value, factors + 2 * k);
            if (product == Product::conjugate) value.im = hn::Neg(value.im);
            store(value, group);
        }
    }
}

// The spectra of the two real sequences in z, from z[k] and z[count - k].
struct Pair {
    Complex a, b;
};
HWY_INLINE Pair pair_at(const float* in, std::ptrdiff_t k, std::ptrdiff_t count, int lane) {
    const Complex z = load(in + k * kGroup + lane);
    const Complex m = load(in + (k == 0 ? 0 : count - k) * kGroup + lane);
    const Complex sum = scaled(add(z, m), 0.5f), difference = scaled(sub(z, m), 0.5f);
    return {{sum.re, difference.im}, {sum.im, hn::Neg(difference.re)}};
}

void HartleyOfFourier(const float* in, int count, float* out) {
    for (std::ptrdiff_t k = 0; k < count; ++k) {
        for (int lane = 0; lane < kHalf; lane += kLanes) {
            const Pair pair = pair_at(in, k, count, lane);
            store({hn::Sub(pair.a.re, pair.a.im), hn::Sub(pair.b.re, pair.b.im)}, out + k * kGroup + lane);
        }
    }
}

void CosineOfFourier(const float* in, const float* turns, int count, float* out) {
    for (std::ptrdiff_t k = 0; k < count; ++k) {
        const V c = hn::Set(kD, turns[2 * k]);
        const V s = hn::Set(kD, turns[2 * k + 1]);
        for (int lane = 0; lane < kHalf; lane += kLanes) {
            const Pair pair = pair_at(in, k, count, lane);
            store({hn::Add(hn::Mul(c, pair.a.re), hn::Mul(s, pair.a.im)),
                   hn::Add(hn::Mul(c, pair.b.re), hn::Mul(s, pair.b.im))},
                  out + k * kGroup + lane);
        }
    }
}

// exp(i pi k / (2 count)) (x[k] - i x[count - k]) of a real sequence.
HWY_INLINE Complex turned(V x, V mirrored, V c, V s) {
    return {hn::Add(hn::Mul(c, x), hn::Mul(s, mirrored)), hn::Sub(hn::Mul(s, x), hn::Mul(c, mirrored))};
}

void FourierOfCosine(const float* in, const float* turns, int count, float* out) {
    for (std::ptrdiff_t k = 0; k < count; ++k) {
        const V c = hn::Set(kD, turns[2 * k]);
        const V s = hn::Set(kD, turns[2 * k + 1]);
        for (int lane = 0; lane < kHalf; lane += kLanes) {
            const Complex x = load(in + k * kGroup + lane);
            const Complex m = k == 0 ? Complex{hn::Zero(kD), hn::Zero(kD)} : load(in + (count - k) * kGroup + lane);
            const Complex a = turned(x.re, m.re, c, s);
            const Complex b = turned(x.im, m.im, c, s);
            store({hn::Add(a.im, b.re), hn::Sub(a.re, b.im)}, out + k * kGroup + lane);
        }
    }
}

void DivideSpectrum(const SpectrumRow& row, int count, float* data) {
    const V y_slope = hn::Set(kD, row.y_slope), y_smooth = hn::Set(kD, row.y_smooth),
            y_ideal = hn::Set(kD, row.y_ideal);
    const V least = hn::Set(kD, row.least), scale = hn::Set(kD, row.scale);
    for (int i = 0; i < count; i += kLanes) {
        const V eigenvalue = hn::Add(hn::Mul(hn::LoadU(kD, row.x_slope + i), y_smooth),
                                     hn::Mul(hn::LoadU(kD, row.x_smooth + i), y_slope));
        const V limit = hn::Mul(least, hn::Add(hn::LoadU(kD, row.x_ideal + i), y_ideal));
        const V quotient = hn::Div(hn::Mul(hn::LoadU(kD, data + i), scale), eigenvalue);
        hn::StoreU(hn::IfThenElseZero(hn::Gt(eigenvalue, limit), quotient), kD, data + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, fourier_stage, RunFourierStage, (const FourierStage& stage, const float* in, float* out),
           (stage, in, out))

TEX_KERNEL(void, multiply_groups, MultiplyGroups, (Product product, const float* factors, int count, float* data),
           (product, factors, count, data))

TEX_KERNEL(void, hartley_of_fourier, HartleyOfFourier, (const float* in, int count, float* out), (in, count, out))

TEX_KERNEL(void, cosine_of_fourier, CosineOfFourier, (const float* in, const float* turns, int count, float* out),
           (in, turns, count, out))

TEX_KERNEL(void, fourier_of_cosine, FourierOfCosine, (const float* in, const float* turns, int count, float* out),
           (in, turns, count, out))

TEX_KERNEL(void, divide_spectrum, DivideSpectrum, (const SpectrumRow& row, int count, float* data), (row, count, data))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
