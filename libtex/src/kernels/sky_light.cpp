// SPDX-License-Identifier: Apache-2.0

#include "kernels/sky_light.h"

#include <algorithm>
#include <cstddef>

#include "kernels/bake.h"
#include "kernels/horizon.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/sky_light.cpp"
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
constexpr hn::RebindToSigned<D> kDI;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(kD));

// 1 / sqrt(x) within 7.5e-7 of its value: Newton's steps with factors that halve their errors (Walczyk, Moroz,
// Cieslinski: Improving the Accuracy of the Fast Inverse Square Root by Modifying Newton-Raphson Corrections, 2021), a
// quarter of the time of a root and a quotient. The instructions for it differ between processors.
HWY_INLINE V inverse_root(V x) {
    V root = hn::BitCast(kD, hn::Sub(hn::Set(kDI, 0x5f376908), hn::ShiftRight<1>(hn::BitCast(kDI, x))));
    const V half = hn::Mul(x, hn::Set(kD, 0.5f));
    for (const float factor : {1.50087896f, 1.50000057f})
        root = hn::Mul(root, hn::Sub(hn::Set(kD, factor), hn::Mul(half, hn::Mul(root, root))));
    return root;
}

// A texel in the plane of a direction: its slope, and the sine and cosine of its horizon. Its normal is (-slope, 1)
// there, times a factor that is the same for all directions.
struct Aspect {
    V slope, sine, cosine;
};

HWY_INLINE Aspect aspect_of(V horizon, V p, V q, const SkyDirection& direction) {
    const V one = hn::Set(kD, 1.0f);
    const V slope = hn::Add(hn::Mul(p, hn::Set(kD, direction.x)), hn::Mul(q, hn::Set(kD, direction.y)));
    // The plane of the texel itself hides what is below it.
    const V tangent = hn::Max(horizon, slope);
    const V cosine = inverse_root(hn::Add(one, hn::Mul(tangent, tangent)));
    return {slope, hn::Mul(tangent, cosine), cosine};
}

// The integral of cos^2 h from the horizon to the vertical: cosine^3 g(sine) above the level, for a polynomial g that
// was fitted at Chebyshev's points. Off by at most 3e-6.
HWY_INLINE V squared_cosines(const Aspect& of) {
    const V s = hn::Abs(of.sine);
    V sum = hn::Set(kD, -0.0769763179f);
    for (const float term :
         {0.378519943f, -0.846462495f, 1.19290942f, -1.27133175f, 1.17095128f, -0.999673595f, 0.785395634f})
        sum = hn::Add(hn::Mul(sum, s), hn::Set(kD, term));
    const V above = hn::Mul(hn::Mul(hn::Mul(of.cosine, of.cosine), of.cosine), sum);
    return hn::IfThenElse(hn::Lt(of.sine, hn::Zero(kD)), hn::Sub(hn::Set(kD, 1.57079633f), above), above);
}

// The integral of the cosine with the normal over angles h from the horizon to the vertical, times cos h, as
// directions are denser near the level: of (-slope cos h + sin h) cos h.
HWY_INLINE V shaded(const Aspect& of) {
    const V upwards = hn::Mul(hn::Set(kD, 0.5f), hn::Mul(of.cosine, of.cosine));
    return hn::Sub(upwards, hn::Mul(of.slope, squared_cosines(of)));
}

// The direction times that cosine, integrated likewise: along the level and upwards.
struct Light {
    V along, up;
};

HWY_INLINE Light bent(const Aspect& of) {
    const V third = hn::Set(kD, 0.333333343f);
    const V sine3 = hn::Mul(hn::Mul(of.sine, of.sine), of.sine);
    const V cosine3 = hn::Mul(hn::Mul(of.cosine, of.cosine), hn::Mul(of.cosine, third));
    const V level = hn::Add(hn::Sub(hn::Set(kD, 0.666666687f), of.sine), hn::Mul(sine3, third));
    const V upright = hn::Mul(hn::Sub(hn::Set(kD, 1.0f), sine3), third);
    return {hn::Sub(cosine3, hn::Mul(of.slope, level)), hn::Sub(upright, hn::Mul(of.slope, cosine3))};
}

HWY_INLINE void add(V more, float* sums) { hn::StoreU(hn::Add(hn::LoadU(kD, sums), more), kD, sums); }

// What a view adds to the sums; members that are not wanted stay unset.
struct More {
    V occlusion, sky, x, y, z;
};

HWY_INLINE More light_of(const SkyView& view, int i, const float* p, const float* q, const SkyRow& sky) {
    const V one = hn::Set(kD, 1.0f), zero = hn::Zero(kD), most = hn::Set(kD, kMaxSlope);
    const SkyDirection& direction = view.direction;
    V horizon = hn::Mul(hn::LoadU(kD, view.horizons + i), hn::Set(kD, direction.for_rows));
    horizon = hn::Min(hn::Max(horizon, direction.is_level ? zero : hn::Neg(most)), most);
    More more{zero, zero, zero, zero, zero};
    if (sky.sky != nullptr || sky.horizon != nullptr) {
        const V tangent = hn::Max(horizon, zero);
        const V sine = hn::Mul(tangent, inverse_root(hn::Add(one, hn::Mul(tangent, tangent))));
        more.sky = hn::Sub(one, sine);
        if (sky.horizon != nullptr) hn::StoreU(hn::Min(sine, one), kD, sky.horizon + i);
    }
    if (sky.occlusion == nullptr && sky.x == nullptr) return more;
    const Aspect aspect = aspect_of(horizon, hn::LoadU(kD, p + i), hn::LoadU(kD, q + i), direction);
    if (sky.occlusion != nullptr) more.occlusion = shaded(aspect);
    if (sky.x == nullptr) return more;
    const Light light = bent(aspect);
    more.x = hn::Mul(light.along, hn::Set(kD, direction.x));
    more.y = hn::Mul(light.along, hn::Set(kD, direction.y));
    more.z = light.up;
    return more;
}

HWY_INLINE void add_vector(const SkyView* views, int view_count, int i, const float* p, const float* q,
                           const SkyRow& sky) {
    More more = light_of(views[0], i, p, q, sky);
    if (view_count == 2) {
        const More other = light_of(views[1], i, p, q, sky);
        more = {hn::Add(more.occlusion, other.occlusion), hn::Add(more.sky, other.sky), hn::Add(more.x, other.x),
                hn::Add(more.y, other.y), hn::Add(more.z, other.z)};
    }
    if (sky.occlusion != nullptr) add(more.occlusion, sky.occlusion + i);
    if (sky.sky != nullptr) add(more.sky, sky.sky + i);
    if (sky.x == nullptr) return;
    add(more.x, sky.x + i);
    add(more.y, sky.y + i);
    add(more.z, sky.z + i);
}

void AddSky(const SkyView* views, int view_count, const float* p, const float* q, int count, const SkyRow& sky) {
    int i = 0;
    for (; i + kLanes <= count; i += kLanes) add_vector(views, view_count, i, p, q, sky);
    if (i == count) return;
    // Other threads may write what follows.
    const int rest = count - i;
    float in[4][kLanes] = {}, sums[6][kLanes] = {};
    const float* const from[4] = {p, q, views[0].horizons, view_count == 2 ? views[1].horizons : nullptr};
    float* const to[6] = {sky.occlusion, sky.sky, sky.x, sky.y, sky.z, sky.horizon};
    for (int k = 0; k < 4; ++k) {
        if (from[k] != nullptr) std::copy_n(from[k] + i, rest, in[k]);
    }
    const auto copy = [&](int k) { return to[k] == nullptr ? nullptr : std::copy_n(to[k] + i, rest, sums[k]) - rest; };
    SkyView few[2] = {{in[2], views[0].direction}, {in[3], views[view_count - 1].direction}};
    add_vector(few, view_count, 0, in[0], in[1], {copy(0), copy(1), copy(2), copy(3), copy(4), copy(5)});
    for (int k = 0; k < 6; ++k) {
        if (to[k] != nullptr) std::copy_n(sums[k], rest, to[k] + i);
    }
}

// The z of a normal with these slopes.
HWY_INLINE V upright(V p, V q) {
    const V one = hn::Set(kD, 1.0f);
    return hn::Div(one, hn::Sqrt(hn::Add(hn::Add(one, hn::Mul(p, p)), hn::Mul(q, q))));
}

void FinishSky(const float* heights, const float* p, const float* q, int directions, int count, const SkyRow& sky) {
    const V one = hn::Set(kD, 1.0f), zero = hn::Zero(kD);
    const V number = hn::Set(kD, static_cast<float>(directions));
    for (int i = 0; i < count; i += kLanes) {
        const M is_hole = hn::Eq(hn::LoadU(kD, heights + i), hn::Set(kD, kHoleHeight));
        // Comparisons, because sums of holes may be NaN.
        const auto store = [&](V value, float* to) {
            const V positive = hn::IfThenElseZero(hn::Gt(value, zero), value);
            const V part = hn::IfThenElse(hn::Lt(positive, one), positive, one);
            hn::StoreU(hn::IfThenElse(is_hole, one, part), kD, to);
        };
        if (sky.occlusion != nullptr) {
            const V sum =
                hn::Mul(hn::LoadU(kD, sky.occlusion + i), upright(hn::LoadU(kD, p + i), hn::LoadU(kD, q + i)));
            store(hn::Div(hn::Add(sum, sum), number), sky.occlusion + i);
        }
        if (sky.sky != nullptr) store(hn::Div(hn::LoadU(kD, sky.sky + i), number), sky.sky + i);
        if (sky.horizon != nullptr)
            hn::StoreU(hn::IfThenZeroElse(is_hole, hn::LoadU(kD, sky.horizon + i)), kD, sky.horizon + i);
        if (sky.x == nullptr) continue;  // there may be no slopes
        const V slope_x = hn::LoadU(kD, p + i), slope_y = hn::LoadU(kD, q + i);
        const V scale = hn::Div(upright(slope_x, slope_y), number);
        Vec3 sum = LoadVec3(kD, sky.x + i, sky.y + i, sky.z + i);
        sum = {hn::Mul(sum.x, scale), hn::Mul(sum.y, scale), hn::Mul(sum.z, scale)};
        const M is_closed = hn::Lt(SquaredLength(sum), hn::Set(kD, 1e-10f));
        const Vec3 normal = {hn::Neg(slope_x), hn::Neg(slope_y), one};
        const auto either = [&](V closed, V open) { return hn::IfThenElse(is_closed, closed, open); };
        // Lengths are above 1e-6: no slope is too steep for its square.
        const Vec3 vector = {either(normal.x, sum.x), either(normal.y, sum.y), either(normal.z, sum.z)};
        StoreVec3(kD, FlatUnless(kD, hn::Not(is_hole), Normalise(kD, vector)), sky.x + i, sky.y + i, sky.z + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {
TEX_KERNEL(void, add_sky, AddSky,
           (const SkyView* views, int view_count, const float* p, const float* q, int count, const SkyRow& sky),
           (views, view_count, p, q, count, sky))
TEX_KERNEL(void, finish_sky, FinishSky,
           (const float* heights, const float* p, const float* q, int directions, int count, const SkyRow& sky),
           (heights, p, q, directions, count, sky))
}  // namespace tex::inline v1
#endif  // HWY_ONCE
