// SPDX-License-Identifier: Apache-2.0

#include "kernels/level_sums.h"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/level_sums.cpp"
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

constexpr int kLanes = 16;                                  // of the sums, on every target
constexpr int kChunk = 256;                                 // texels whose sums are floats
constexpr std::size_t kParts = kLanes / hn::MaxLanes(D());  // registers for 16 texels

// The sum of one quantity over a chunk.
struct LaneSum {
    V part[kParts];

    HWY_INLINE void Clear() {
        for (std::size_t k = 0; k < kParts; ++k) part[k] = hn::Zero(D());
    }
    HWY_INLINE void Add(std::size_t k, V value) { part[k] = hn::Add(part[k], value); }
    HWY_INLINE void MoveTo(double& sum) {
        HWY_ALIGN float lanes[kLanes];
        for (std::size_t k = 0; k < kParts; ++k) hn::Store(part[k], D(), lanes + k * hn::MaxLanes(D()));
        for (const float lane : lanes) sum += static_cast<double>(lane);
        Clear();
    }
};

// The texels of a register that lie from `first` to `last`; texel i is in its first lane.
HWY_INLINE M Within(int i, int first, int last) {
    const D d;
    const V at = hn::Add(hn::Iota(d, 0.0f), hn::Set(d, static_cast<float>(i)));
    return hn::And(hn::Ge(at, hn::Set(d, static_cast<float>(first))), hn::Le(at, hn::Set(d, static_cast<float>(last))));
}

HWY_INLINE V Half(V a, V b) { return hn::Mul(hn::Sub(a, b), hn::Set(D(), 0.5f)); }

struct ChunkSums {
    LaneSum s[2], r[2], ss, rr, rs, length, average_length, normalised_square, average_square;
    LaneSum xx, xy, yy, xr, yr, xs, ys;

    // Sums of the components, and of x and y of `a` and `b` multiplied.
    HWY_INLINE void AddVectors(std::size_t k, const Vec3& stored, const Vec3& average, V rx, V ry) {
        const auto product = [](V ax, V bx, V ay, V by) { return hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)); };
        s[0].Add(k, stored.x), s[1].Add(k, stored.y);
        r[0].Add(k, rx), r[1].Add(k, ry);
        ss.Add(k, product(stored.x, stored.x, stored.y, stored.y));
        rr.Add(k, product(rx, rx, ry, ry));
        rs.Add(k, product(stored.x, rx, stored.y, ry));
        length.Add(k, hn::Sqrt(SquaredLength(stored)));
        average_length.Add(k, hn::Sqrt(SquaredLength(average)));
        const V dx = hn::Sub(stored.x, rx), dy = hn::Sub(stored.y, ry);
        normalised_square.Add(k, product(dx, dx, dy, dy));
        const V ex = hn::Sub(stored.x, average.x), ey = hn::Sub(stored.y, average.y);
        average_square.Add(k, product(ex, ex, ey, ey));
    }
    // Adds one component, whose differences are gx and gy.
    HWY_INLINE void AddGradients(std::size_t k, V gx, V gy, V of_r, V of_s) {
        xx.Add(k, hn::Mul(gx, gx)), xy.Add(k, hn::Mul(gx, gy)), yy.Add(k, hn::Mul(gy, gy));
        xr.Add(k, hn::Mul(gx, of_r)), yr.Add(k, hn::Mul(gy, of_r));
        xs.Add(k, hn::Mul(gx, of_s)), ys.Add(k, hn::Mul(gy, of_s));
    }
    template <class F>
    HWY_INLINE void ForEach(LevelSums& to, const F& f) {
        f(s[0], to.s[0]), f(s[1], to.s[1]), f(r[0], to.r[0]), f(r[1], to.r[1]);
        f(ss, to.ss), f(rr, to.rr), f(rs, to.rs), f(length, to.length), f(average_length, to.average_length);
        f(normalised_square, to.normalised_square), f(average_square, to.average_square);
        f(xx, to.xx), f(xy, to.xy), f(yy, to.yy), f(xr, to.xr), f(yr, to.yr), f(xs, to.xs), f(ys, to.ys);
    }
};

// Adds the texels of one register: those from texel i on, of `count` in the row.
HWY_INLINE void AddTexels(const LevelRow& row, int i, int count, std::size_t part, ChunkSums& sums) {
    const D d;
    const M inside = Within(i, 0, count - 1);
    const auto load = [&](const float* from) { return hn::IfThenElseZero(inside, hn::LoadU(d, from + i)); };
    const Vec3 stored{load(row.s.x), load(row.s.y), load(row.s.z)},
        average{load(row.a.x), load(row.a.y), load(row.a.z)};
    const V rx = load(row.r.x), ry = load(row.r.y);
    sums.AddVectors(part, stored, average, rx, ry);
    if (row.above.x == nullptr || row.below.x == nullptr) return;
    const M inner = Within(i, 1, count - 2);
    const auto difference = [&](const float* after, const float* before) {
        return hn::IfThenElseZero(inner, Half(hn::LoadU(d, after + i), hn::LoadU(d, before + i)));
    };
    sums.AddGradients(part, difference(row.r.x + 1, row.r.x - 1), difference(row.below.x, row.above.x), rx, stored.x);
    sums.AddGradients(part, difference(row.r.y + 1, row.r.y - 1), difference(row.below.y, row.above.y), ry, stored.y);
}

void AddLevelRow(const LevelRow& row, int count, LevelSums& sums) {
    ChunkSums chunk;
    chunk.ForEach(sums, [](LaneSum& lanes, double&) { lanes.Clear(); });
    for (int first = 0; first < count; first += kChunk) {
        for (int group = first; group < std::min(count, first + kChunk); group += kLanes) {
            for (std::size_t part = 0; part < kParts; ++part) {
                AddTexels(row, group + static_cast<int>(part * hn::MaxLanes(D())), count, part, chunk);
            }
        }
        chunk.ForEach(sums, [](LaneSum& lanes, double& sum) { lanes.MoveTo(sum); });
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, add_level_row, AddLevelRow, (const LevelRow& row, int count, LevelSums& sums), (row, count, sums))

void LevelSums::add(const LevelSums& o) {
    for (std::size_t c = 0; c < 2; ++c) s[c] += o.s[c], r[c] += o.r[c];
    ss += o.ss, rr += o.rr, rs += o.rs;
    length += o.length, average_length += o.average_length;
    normalised_square += o.normalised_square, average_square += o.average_square;
    xx += o.xx, xy += o.xy, yy += o.yy, xr += o.xr, yr += o.yr, xs += o.xs, ys += o.ys;
}

}  // namespace tex::inline v1
#endif
