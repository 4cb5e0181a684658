// SPDX-License-Identifier: Apache-2.0

#include "kernels/corner_vectors.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/corner_vectors.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using WideTag = hn::CappedTag<double, kMoreVectors + 1>;
using WideVec = hn::Vec<WideTag>;
using WideMask = hn::Mask<WideTag>;
using TexelTag = hn::Rebind<float, WideTag>;
constexpr WideTag kWide;
constexpr std::size_t kWideLanes = hn::MaxLanes(WideTag());

struct Wide3 {
    WideVec x, y, z;
};

HWY_INLINE Wide3 load(VectorArrays<const double> from, std::size_t k) {
    return {hn::LoadU(kWide, from.x + k), hn::LoadU(kWide, from.y + k), hn::LoadU(kWide, from.z + k)};
}

HWY_INLINE void store(Wide3 v, VectorArrays<double> to, std::size_t k) {
    hn::StoreU(v.x, kWide, to.x + k);
    hn::StoreU(v.y, kWide, to.y + k);
    hn::StoreU(v.z, kWide, to.z + k);
}

HWY_INLINE Wide3 set(const double (&v)[3]) {
    return {hn::Set(kWide, v[0]), hn::Set(kWide, v[1]), hn::Set(kWide, v[2])};
}
HWY_INLINE Wide3 add(Wide3 a, Wide3 b) { return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)}; }
HWY_INLINE Wide3 scaled(WideVec s, Wide3 a) { return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)}; }
HWY_INLINE WideVec dot(Wide3 a, Wide3 b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Wide3 cross(Wide3 a, Wide3 b) {
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

HWY_INLINE Wide3 unit(Wide3 v) {
    const WideVec one = hn::Set(kWide, 1.0), n = hn::Sqrt(dot(v, v));
    return scaled(hn::IfThenElse(hn::Gt(n, hn::Set(kWide, 1e-30)), hn::Div(one, n), one), v);
}

HWY_INLINE Wide3 mixed(const CornerVectors& corners, Wide3 weights) {
    return add(add(scaled(weights.x, set(corners[0])), scaled(weights.y, set(corners[1]))),
               scaled(weights.z, set(corners[2])));
}

// The lanes of the vector at k that count.
HWY_INLINE WideMask counted(std::size_t count, std::size_t k) { return hn::FirstN(kWide, count - k); }

void MixCorners(const CornerVectors& corners, VectorArrays<const double> weights, std::size_t count,
                VectorArrays<double> sums) {
    for (std::size_t k = 0; k < count; k += kWideLanes) store(mixed(corners, load(weights, k)), sums, k);
}

bool MixDirections(const CornerVectors& corners, VectorArrays<const double> weights, std::size_t count,
                   VectorArrays<double> directions) {
    bool all = true;
    for (std::size_t k = 0; k < count; k += kWideLanes) {
        const Wide3 direction = unit(mixed(corners, load(weights, k)));
        store(direction, directions, k);
        const WideMask has_length = hn::Gt(dot(direction, direction), hn::Set(kWide, 0.5));
        all = all && hn::AllFalse(kWide, hn::AndNot(has_length, counted(count, k)));
    }
    return all;
}

bool MixNormals(const float* const normals[9], VectorArrays<const double> weights, std::size_t count,
                VectorArrays<double> units) {
    const TexelTag f;
    bool all = true;
    for (std::size_t k = 0; k < count; k += kWideLanes) {
        const auto normal = [&](std::size_t corner) HWY_ATTR {
            const auto at = [&](std::size_t axis)
                                HWY_ATTR { return hn::PromoteTo(kWide, hn::LoadU(f, normals[3 * corner + axis] + k)); };
            return unit(Wide3{at(0), at(1), at(2)});
        };
        const Wide3 w = load(weights, k);
        const WideVec zero = hn::Zero(kWide);
        // From 0, so that a sum of -0 is 0, as in HighSurface::normal_at().
        const Wide3 first = add(Wide3{zero, zero, zero}, scaled(w.x, normal(0)));
        const Wide3 sum = add(add(first, scaled(w.y, normal(1))), scaled(w.z, normal(2)));
        const WideMask has_length = hn::Gt(dot(sum, sum), hn::Set(kWide, 1e-12));
        const Wide3 n = unit(sum);
        store({hn::IfThenElseZero(has_length, n.x), hn::IfThenElseZero(has_length, n.y),
               hn::IfThenElseZero(has_length, n.z)},
              units, k);
        all = all && hn::AllFalse(kWide, hn::AndNot(has_length, counted(count, k)));
    }
    return all;
}

struct WideFrame {
    Wide3 t, b, n;
};

template <DecoderKind kKind>
HWY_INLINE WideFrame frame_at(const FrameCorners& corners, Wide3 weights) {
    const Wide3 t = mixed(corners.tangents, weights), n = mixed(corners.normals, weights);
    if (kKind == DecoderKind::per_vertex) return {t, mixed(corners.bitangents, weights), n};
    if (kKind == DecoderKind::normalized) return {unit(t), unit(mixed(corners.bitangents, weights)), unit(n)};
    const Wide3 signs = set(corners.signs);
    const WideVec sign = dot(weights, signs), one = hn::Set(kWide, 1.0);
    const WideVec side = hn::IfThenElse(hn::Lt(sign, hn::Zero(kWide)), hn::Neg(one), one);
    return {t, scaled(side, cross(n, t)), n};
}

// encode() of mesh/frames.h, and in `sound` where it is anything.
HWY_INLINE Wide3 encoded(const WideFrame& frame, Wide3 n, WideMask& sound) {
    const WideVec zero = hn::Zero(kWide), one = hn::Set(kWide, 1.0);
    const Wide3 r0 = cross(frame.b, frame.n), r1 = cross(frame.n, frame.t), r2 = cross(frame.t, frame.b);
    const WideVec volume = dot(frame.t, r0);
    const WideVec cube = hn::Mul(hn::Mul(dot(frame.t, frame.t), dot(frame.b, frame.b)), dot(frame.n, frame.n));
    const WideVec s = hn::IfThenElse(hn::Lt(volume, zero), hn::Neg(one), one);
    const Wide3 t{hn::Mul(s, dot(n, r0)), hn::Mul(s, dot(n, r1)), hn::Mul(s, dot(n, r2))};
    const WideVec squared = dot(t, t);
    sound = hn::And(hn::Gt(hn::Mul(volume, volume), hn::Mul(hn::Set(kWide, 1e-12), cube)), hn::Gt(squared, zero));
    return scaled(hn::Div(one, hn::Sqrt(squared)), t);
}

template <DecoderKind kKind>
EncodedCounts encode_all(const FrameCorners& corners, VectorArrays<const double> weights,
                         VectorArrays<const double> vectors, std::size_t count, VectorArrays<double> units,
                         VectorArrays<float> texels) {
    const TexelTag f;
    EncodedCounts counts;
    for (std::size_t k = 0; k < count; k += kWideLanes) {
        const Wide3 n = unit(load(vectors, k));
        store(n, units, k);
        WideMask sound;
        const Wide3 t = encoded(frame_at<kKind>(corners, load(weights, k)), n, sound);
        hn::StoreU(hn::DemoteTo(f, hn::IfThenElseZero(sound, t.x)), f, texels.x + k);
        hn::StoreU(hn::DemoteTo(f, hn::IfThenElseZero(sound, t.y)), f, texels.y + k);
        hn::StoreU(hn::DemoteTo(f, hn::IfThenElse(sound, t.z, hn::Set(kWide, 1.0))), f, texels.z + k);
        const WideMask here = counted(count, k);
        counts.singular += hn::CountTrue(kWide, hn::AndNot(sound, here));
        counts.backward += hn::CountTrue(kWide, hn::And(here, hn::And(sound, hn::Lt(t.z, hn::Zero(kWide)))));
    }
    return counts;
}

EncodedCounts EncodeVectors(const FrameCorners& corners, VectorArrays<const double> weights,
                            VectorArrays<const double> vectors, std::size_t count, VectorArrays<double> units,
                            VectorArrays<float> texels) {
    switch (corners.kind) {
        case DecoderKind::per_vertex:
            return encode_all<DecoderKind::per_vertex>(corners, weights, vectors, count, units, texels);
        case DecoderKind::per_fragment:
            return encode_all<DecoderKind::per_fragment>(corners, weights, vectors, count, units, texels);
        case DecoderKind::normalized: break;
    }
    return encode_all<DecoderKind::normalized>(corners, weights, vectors, count, units, texels);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, mix_corners, MixCorners,
           (const CornerVectors& corners, VectorArrays<const double> weights, std::size_t count,
            VectorArrays<double> sums),
           (corners, weights, count, sums))

TEX_KERNEL(bool, mix_directions, MixDirections,
           (const CornerVectors& corners, VectorArrays<const double> weights, std::size_t count,
            VectorArrays<double> directions),
           (corners, weights, count, directions))

TEX_KERNEL(bool, mix_normals, MixNormals,
           (const float* const normals[9], VectorArrays<const double> weights, std::size_t count,
            VectorArrays<double> units),
           (normals, weights, count, units))

TEX_KERNEL(EncodedCounts, encode_vectors, EncodeVectors,
           (const FrameCorners& frame, VectorArrays<const double> weights, VectorArrays<const double> vectors,
            std::size_t count, VectorArrays<double> units, VectorArrays<float> texels),
           (frame, weights, vectors, count, units, texels))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
