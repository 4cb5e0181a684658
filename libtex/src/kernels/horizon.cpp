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

void PushHighest(HullBand& band, const LineRow* rows, int row_count, const TexelRow& seen_from, float bend) {
    const V bending = hn::Set(kD, bend);
    for (int first = 0; first < kBandLines; first += kTogether * kLanes) {
        Point point[kTogether], top[kTogether], second[kTogether];
        I count[kTogether];
        M hidden[kTogether];
        for (int v = 0; v < kTogether; ++v) {
            const int i = first + v * kLanes;
            const Point eye{hn::LoadU(kD, seen_from.own + i), hn::Set(kD, seen_from.line.row)};
            point[v] = point_at(rows[row_count - 1], i);
            for (int k = row_count - 2; k >= 0; --k) {
                const Point other = point_at(rows[k], i);
                point[v] = select(is_higher(eye, point[v], other, bending), other, point[v]);
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

// A texel of a line in the middle of the rows: its height and row. A hole is no texel, so it has the height of the
// highest.
HWY_INLINE Point middle_of(const TexelRow* rows, int count, int i) {
    V highest = hn::LoadU(kD, rows[0].own + i);
    for (int k = 1; k < count; ++k) highest = hn::Max(highest, hn::LoadU(kD, rows[k].own + i));
    V sum = hn::Zero(kD);
    float row = 0.0f;
    for (int k = 0; k < count; ++k) {
        const V own = hn::LoadU(kD, rows[k].own + i);
        sum = hn::Add(sum, hn::IfThenElse(hn::Eq(own, hn::Set(kD, kHoleHeight)), highest, own));
        row += rows[k].line.row;
    }
    const float part = 1.0f / static_cast<float>(count);
    return {hn::Mul(sum, hn::Set(kD, part)), hn::Set(kD, row * part)};
}

// What is farthest above the horizon of a texel, of three points.
HWY_INLINE V highest_of(Point eye, Point nearer, Point found, Point farther, V bend) {
    Point best = select(is_higher(eye, nearer, found, bend), found, nearer);
    best = select(is_higher(eye, best, farther, bend), farther, best);
    const V way = hn::Sub(eye.row, best.row);
    return hn::Sub(hn::Div(hn::Sub(best.height, eye.height), way), hn::Mul(bend, way));
}

HWY_INLINE V highest_near(const TexelRow& row, V own, int i, V horizon) {
    for (int k = 0; k < row.count; ++k) {
        const NearPoint& point = row.points[k];
        const V a = hn::Mul(hn::Set(kD, point.a_weight), hn::Sub(hn::LoadU(kD, point.a + i), own));
        const V b = hn::Mul(hn::Set(kD, point.b_weight), hn::Sub(hn::LoadU(kD, point.b + i), own));
        horizon = hn::Max(horizon, hn::Sub(hn::Add(a, b), hn::Set(kD, point.drop)));
    }
    return horizon;
}

void FindHorizons(const HullBand& band, const TexelRow* rows, int count, float bend) {
    const V bending = hn::Set(kD, bend);
    for (int first = 0; first < kBandLines; first += kTogether * kLanes) {
        Point eye[kTogether], nearer[kTogether], found[kTogether], next[kTogether];
        I depth[kTogether];
        M rises[kTogether];
        for (int v = 0; v < kTogether; ++v) {
            const int i = first + v * kLanes;
            eye[v] = middle_of(rows, count, i);
            found[v] = {hn::Load(kD, band.top_heights + i), hn::Load(kD, band.top_rows + i)};
            nearer[v] = found[v];
            next[v] = {hn::Load(kD, band.second_heights + i), hn::Load(kD, band.second_rows + i)};
            depth[v] = hn::Sub(hn::Load(kDI, band.counts + i), hn::Set(kDI, 1));  // of `found`
            // The slopes of a hull rise up to the horizon and fall behind it.
            rises[v] = hn::And(at_least(depth[v], 1), is_higher(eye[v], found[v], next[v], bending));
        }
        while (!none_of(rises)) {
            for (int v = 0; v < kTogether; ++v) {
                depth[v] = less_one(depth[v], rises[v]);
                const Point behind = entry(band, hn::Sub(depth[v], hn::Set(kDI, 1)), first + v * kLanes);
                nearer[v] = select(rises[v], found[v], nearer[v]);
                found[v] = select(rises[v], next[v], found[v]);
                next[v] = select(rises[v], behind, next[v]);
                rises[v] =
                    hn::And(rises[v], hn::And(at_least(depth[v], 1), is_higher(eye[v], found[v], next[v], bending)));
            }
        }
        for (int v = 0; v < kTogether; ++v) {
            const int i = first + v * kLanes;
            const Point farther = select(at_least(depth[v], 1), next[v], found[v]);
            for (int k = 0; k < count; ++k) {
                const V own = hn::LoadU(kD, rows[k].own + i);
                // A line that lies up to half a texel beside a valley is higher than the valley, far away and here.
                Point eye_on_line = point_at(rows[k].line, i);
                eye_on_line.height = hn::Max(eye_on_line.height, own);
                const V far = highest_of(eye_on_line, nearer[v], found[v], farther, bending);
                hn::StoreU(highest_near(rows[k], own, i, far), kD, rows[k].horizons + i);
            }
        }
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

TEX_KERNEL(void, push_highest, PushHighest,
           (HullBand & band, const LineRow* rows, int count, const TexelRow& seen_from, float bend),
           (band, rows, count, seen_from, bend))
TEX_KERNEL(void, find_horizons, FindHorizons, (const HullBand& band, const TexelRow* rows, int count, float bend),
           (band, rows, count, bend))
TEX_KERNEL(ScaledHeights, scale_heights, ScaleHeights, (const float* in, float scale, int count, float* out),
           (in, scale, count, out))
}  // namespace tex::inline v1
#endif  // HWY_ONCE
