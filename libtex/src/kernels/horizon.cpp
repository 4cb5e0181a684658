// SPDX-License-Identifier: Apache-2.0

#include "kernels/horizon.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "kernels/bake.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/horizon.cpp"
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
using DI = hn::RebindToSigned<D>;
using I = hn::Vec<DI>;
constexpr D kD;
constexpr DI kDI;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(kD));
static_assert(kBandLines % 16 == 0);

// Points of hulls.
struct Point {
    V height, row;
};

HWY_INLINE Point select(M mask, Point yes, Point no) {
    return {hn::IfThenElse(mask, yes.height, no.height), hn::IfThenElse(mask, yes.row, no.row)};
}

// Whether `far` is at least as high above the horizon as `near`, seen from `eye`. Without quotients: all distances are
// above 0.
HWY_INLINE M is_higher(Point eye, Point near, Point far, V bend) {
    const V near_rise = hn::Sub(near.height, eye.height), near_way = hn::Sub(eye.row, near.row);
    const V far_rise = hn::Sub(far.height, eye.height), far_way = hn::Sub(eye.row, far.row);
    const V difference = hn::Sub(hn::Mul(far_rise, near_way), hn::Mul(near_rise, far_way));
    const V bent = hn::Mul(hn::Mul(bend, hn::Mul(near_way, far_way)), hn::Sub(far_way, near_way));
    return hn::Ge(difference, bent);
}

// Entry `depth` of the stacks of lines from `line` on, where that is 0 or more.
HWY_INLINE I place_of(I depth, int line) {
    const I lane = hn::Add(hn::Iota(kDI, 0), hn::Set(kDI, line));
    return hn::Add(hn::ShiftLeft<kBandBits + 1>(depth), hn::Add(lane, lane));
}
HWY_INLINE Point entry(const HullBand& band, I depth, int line) {
    const I at = place_of(hn::Max(depth, hn::Zero(kDI)), line);
    return {hn::GatherIndex(kD, band.points, at), hn::GatherIndex(kD, band.points + 1, at)};
}

HWY_INLINE M at_least(I number, int least) { return hn::RebindMask(kD, hn::Gt(number, hn::Set(kDI, least - 1))); }

HWY_INLINE I less_one(I number, M where) {
    return hn::Add(number, hn::VecFromMask(kDI, hn::RebindMask(kDI, where)));  // a mask is -1
}

template <int kCount>
HWY_INLINE bool none_of(const M (&masks)[kCount]) {
    M any = masks[0];
    for (int v = 1; v < kCount; ++v) any = hn::Or(any, masks[v]);
    return hn::AllFalse(kD, any);
}

HWY_INLINE Point point_at(const LineRow& row, int i) {
    const V left = hn::LoadU(kD, row.heights + i), right = hn::LoadU(kD, row.heights + i + 1);
    const V height = hn::Add(left, hn::Mul(hn::Set(kD, row.fraction), hn::Sub(right, left)));
    return {height, hn::Set(kD, row.row)};
}

// Vectors that are searched together, so that one waits for memory while another computes: a fifth less time than one
// at a time; 4 gain nothing more.
constexpr int kTogether = 2;
static_assert(kBandLines % (kTogether * kLanes) == 0);

void PushHighest(HullBand& band, const LineRow* rows, int row_count, float bend) {
    const V bending = hn::Set(kD, bend);
    for (int first = 0; first < kBandLines; first += kTogether * kLanes) {
        Point point[kTogether], top[kTogether], second[kTogether];
        I count[kTogether];
        M hidden[kTogether];
        for (int v = 0; v < kTogether; ++v) {
            const int i = first + v * kLanes;
            point[v] = point_at(rows[0], i);
            for (int k = 1; k < row_count; ++k) {
                const Point other = point_at(rows[k], i);
                point[v] = select(hn::Ge(other.height, point[v].height), other, point[v]);
            }
            top[v] = {hn::Load(kD, band.top_heights + i), hn::Load(kD, band.top_rows + i)};
            second[v] = {hn::Load(kD, band.second_heights + i), hn::Load(kD, band.second_rows + i)};
            count[v] = hn::Load(kDI, band.counts + i);
            // What the new point and one behind it hide is not on the hull any more.
            hidden[v] = hn::And(at_least(count[v], 2), is_higher(point[v], top[v], second[v], bending));
        }
        while (!none_of(hidden)) {
            for (int v = 0; v < kTogether; ++v) {
                count[v] = less_one(count[v], hidden[v]);
                const Point third = entry(band, hn::Sub(count[v], hn::Set(kDI, 2)), first + v * kLanes);
                top[v] = select(hidden[v], second[v], top[v]);
                second[v] = select(hidden[v], third, second[v]);
                hidden[v] =
                    hn::And(hidden[v], hn::And(at_least(count[v], 2), is_higher(point[v], top[v], second[v], bending)));
            }
        }
        for (int v = 0; v < kTogether; ++v) {
            const int i = first + v * kLanes;
            const I at = place_of(count[v], i);
            hn::ScatterIndex(point[v].height, kD, band.points, at);
            hn::ScatterIndex(point[v].row, kD, band.points + 1, at);
            const M has_top = at_least(count[v], 1);
            hn::Store(hn::IfThenElse(has_top, top[v].height, hn::Set(kD, kHoleHeight)), kD, band.second_heights + i);
            hn::Store(top[v].row, kD, band.second_rows + i);
            hn::Store(point[v].height, kD, band.top_heights + i);
            hn::Store(point[v].row, kD, band.top_rows + i);
            hn::Store(hn::Add(count[v], hn::Set(kDI, 1)), kDI, band.counts + i);
        }
    }
}

void FindHorizons(const HullBand& band, const float* own, const NearPoint* points, int count, float row, float bend,
                  float* horizons) {
    const V bending = hn::Set(kD, bend);
    for (int first = 0; first < kBandLines; first += kTogether * kLanes) {
        Point eye[kTogether], found[kTogether], next[kTogether];
        I depth[kTogether];
        M rises[kTogether];
        for (int v = 0; v < kTogether; ++v) {
            const int i = first + v * kLanes;
            eye[v] = {hn::LoadU(kD, own + i), hn::Set(kD, row)};
            found[v] = {hn::Load(kD, band.top_heights + i), hn::Load(kD, band.top_rows + i)};
            next[v] = {hn::Load(kD, band.second_heights + i), hn::Load(kD, band.second_rows + i)};
            depth[v] = hn::Sub(hn::Load(kDI, band.counts + i), hn::Set(kDI, 1));  // of `found`
            // The slopes of a hull rise up to the horizon and fall behind it.
            rises[v] = hn::And(at_least(depth[v], 1), is_higher(eye[v], found[v], next[v], bending));
        }
        while (!none_of(rises)) {
            for (int v = 0; v < kTogether; ++v) {
                depth[v] = less_one(depth[v], rises[v]);
                const Point behind = entry(band, hn::Sub(depth[v], hn::Set(kDI, 1)), first + v * kLanes);
                found[v] = select(rises[v], next[v], found[v]);
                next[v] = select(rises[v], behind, next[v]);
                rises[v] =
                    hn::And(rises[v], hn::And(at_least(depth[v], 1), is_higher(eye[v], found[v], next[v], bending)));
            }
        }
        for (int v = 0; v < kTogether; ++v) {
            const int i = first + v * kLanes;
            const V way = hn::Sub(eye[v].row, found[v].row);
            V horizon = hn::Sub(hn::Div(hn::Sub(found[v].height, eye[v].height), way), hn::Mul(bending, way));
            for (int k = 0; k < count; ++k) {
                const NearPoint& point = points[k];
                const V a = hn::Mul(hn::Set(kD, point.a_weight), hn::Sub(hn::LoadU(kD, point.a + i), eye[v].height));
                const V b = hn::Mul(hn::Set(kD, point.b_weight), hn::Sub(hn::LoadU(kD, point.b + i), eye[v].height));
                horizon = hn::Max(horizon, hn::Sub(hn::Add(a, b), hn::Set(kD, point.drop)));
            }
            hn::StoreU(horizon, kD, horizons + i);
        }
    }
}

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

HWY_INLINE void add_vector(const float* horizons, const float* p, const float* q, const SkyDirection& direction,
                           const SkyRow& sky) {
    const V one = hn::Set(kD, 1.0f), zero = hn::Zero(kD), most = hn::Set(kD, kMaxSlope);
    V horizon = hn::Mul(hn::LoadU(kD, horizons), hn::Set(kD, direction.for_rows));
    horizon = hn::Min(hn::Max(horizon, direction.is_level ? zero : hn::Neg(most)), most);
    if (sky.sky != nullptr || sky.horizon != nullptr) {
        const V tangent = hn::Max(horizon, zero);
        const V sine = hn::Mul(tangent, inverse_root(hn::Add(one, hn::Mul(tangent, tangent))));
        if (sky.sky != nullptr) add(hn::Sub(one, sine), sky.sky);
        if (sky.horizon != nullptr) hn::StoreU(hn::Min(sine, one), kD, sky.horizon);
    }
    if (sky.occlusion == nullptr && sky.x == nullptr) return;
    const Aspect aspect = aspect_of(horizon, hn::LoadU(kD, p), hn::LoadU(kD, q), direction);
    if (sky.occlusion != nullptr) add(shaded(aspect), sky.occlusion);
    if (sky.x == nullptr) return;
    const Light light = bent(aspect);
    add(hn::Mul(light.along, hn::Set(kD, direction.x)), sky.x);
    add(hn::Mul(light.along, hn::Set(kD, direction.y)), sky.y);
    add(light.up, sky.z);
}

void AddSky(const float* horizons, const float* p, const float* q, const SkyDirection& direction, int count,
            const SkyRow& sky) {
    const auto moved = [](auto* row, int i) { return row == nullptr ? nullptr : row + i; };
    int i = 0;
    for (; i + kLanes <= count; i += kLanes) {
        const SkyRow at{moved(sky.occlusion, i), moved(sky.sky, i), moved(sky.x, i),
                        moved(sky.y, i),         moved(sky.z, i),   moved(sky.horizon, i)};
        add_vector(horizons + i, moved(p, i), moved(q, i), direction, at);
    }
    if (i == count) return;
    // Other threads may write what follows.
    const int rest = count - i;
    float in[3][kLanes] = {}, sums[6][kLanes] = {};
    const float* const from[3] = {horizons, p, q};
    float* const to[6] = {sky.occlusion, sky.sky, sky.x, sky.y, sky.z, sky.horizon};
    for (int k = 0; k < 3; ++k) {
        if (from[k] != nullptr) std::copy_n(from[k] + i, rest, in[k]);
    }
    const auto copy = [&](int k) { return to[k] == nullptr ? nullptr : std::copy_n(to[k] + i, rest, sums[k]) - rest; };
    add_vector(in[0], in[1], in[2], direction, {copy(0), copy(1), copy(2), copy(3), copy(4), copy(5)});
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

ScaledHeights ScaleHeights(const float* in, float scale, int count, float* out) {
    const V most = hn::Set(kD, kMaxSlope), factor = hn::Set(kD, scale);
    const V infinity = hn::Set(kD, std::numeric_limits<float>::infinity());
    std::size_t holes = 0, infinite = 0;
    for (int i = 0; i < count; i += kLanes) {
        const V height = hn::LoadU(kD, in + i);
        const M inside = hn::FirstN(kD, static_cast<std::size_t>(count - i));
        const M is_hole = hn::Not(hn::Eq(height, height));  // NaN: Ne() of Highway 1.0.3 is false for it with AVX-512
        holes += hn::CountTrue(kD, hn::And(is_hole, inside));
        infinite += hn::CountTrue(kD, hn::And(hn::Eq(hn::Abs(height), infinity), inside));
        const V scaled = hn::Mul(hn::IfThenElse(is_hole, hn::Zero(kD), height), factor);
        const V limited = hn::Min(hn::Max(scaled, hn::Neg(most)), most);
        hn::StoreU(hn::IfThenElse(is_hole, hn::Set(kD, kHoleHeight), limited), kD, out + i);
    }
    return {static_cast<std::int64_t>(holes), infinite == 0};
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {
void clear_hulls(HullBand& band) {
    std::fill_n(band.counts, kBandLines, 0);
    for (float* const values : {band.top_heights, band.second_heights}) std::fill_n(values, kBandLines, kHoleHeight);
    for (float* const values : {band.top_rows, band.second_rows}) std::fill_n(values, kBandLines, 0.0f);
}

TEX_KERNEL(void, push_highest, PushHighest, (HullBand & band, const LineRow* rows, int count, float bend),
           (band, rows, count, bend))
TEX_KERNEL(void, find_horizons, FindHorizons,
           (const HullBand& band, const float* own, const NearPoint* points, int count, float row, float bend,
            float* horizons),
           (band, own, points, count, row, bend, horizons))
TEX_KERNEL(void, add_sky, AddSky,
           (const float* horizons, const float* p, const float* q, const SkyDirection& direction, int count,
            const SkyRow& sky),
           (horizons, p, q, direction, count, sky))
TEX_KERNEL(void, finish_sky, FinishSky,
           (const float* heights, const float* p, const float* q, int directions, int count, const SkyRow& sky),
           (heights, p, q, directions, count, sky))
TEX_KERNEL(ScaledHeights, scale_heights, ScaleHeights, (const float* in, float scale, int count, float* out),
           (in, scale, count, out))
}  // namespace tex::inline v1
#endif  // HWY_ONCE
