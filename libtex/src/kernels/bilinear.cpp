// SPDX-License-Identifier: Apache-2.0

#include "kernels/bilinear.h"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bilinear.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using PlaceTag = hn::CappedTag<double, 8>;
using PlaceVec = hn::Vec<PlaceTag>;
using IndexTag = hn::Rebind<std::int32_t, PlaceTag>;
using IndexVec = hn::Vec<IndexTag>;

// Moves a coordinate, in widths, by whole periods until its texel index is a small number. On clamped axes, everything
// beyond one width outside is the same.
HWY_INLINE PlaceVec Reduce(PlaceTag d, Wrap wrap, PlaceVec u) {
    switch (wrap) {
        case Wrap::repeat: return hn::Sub(u, hn::Floor(u));
        case Wrap::mirror: return hn::Sub(u, hn::Mul(hn::Set(d, 2.0), hn::Floor(hn::Mul(u, hn::Set(d, 0.5)))));
        case Wrap::clamp: break;
    }
    return hn::Min(hn::Max(u, hn::Set(d, -1.0)), hn::Set(d, 2.0));
}

// The texel at an index. The index is at most one texel outside a period (repeat: n texels, mirror: 2 n). If borders
// are clamped, it may have any value.
HWY_INLINE IndexVec Wrapped(IndexTag d, Wrap wrap, IndexVec index, int n) {
    const IndexVec zero = hn::Zero(d);
    const IndexVec last = hn::Set(d, n - 1);
    if (wrap == Wrap::clamp) return hn::Min(hn::Max(index, zero), last);
    const IndexVec period = hn::Set(d, wrap == Wrap::mirror ? 2 * n : n);
    index = hn::IfThenElse(hn::Lt(index, zero), hn::Add(index, period), index);
    index = hn::IfThenElse(hn::Lt(index, period), index, hn::Sub(index, period));
    if (wrap == Wrap::repeat) return index;
    return hn::IfThenElse(hn::Gt(index, last), hn::Sub(hn::Set(d, 2 * n - 1), index), index);
}

void Taps(double start, double step, double rest, Wrap wrap, int n, int count, const TapRow& taps) {
    const PlaceTag d;
    const IndexTag di;
    const hn::Rebind<float, PlaceTag> df;
    const auto end = static_cast<std::size_t>(count);
    for (std::size_t i = 0; i < end; i += hn::Lanes(d)) {
        const PlaceVec x = hn::Add(hn::Iota(d, static_cast<double>(i)), hn::Set(d, 0.5));
        const PlaceVec u = hn::Add(hn::Add(hn::Set(d, start), hn::Mul(hn::Set(d, step), x)), hn::Set(d, rest));
        const PlaceVec place =
            hn::Sub(hn::Mul(Reduce(d, wrap, u), hn::Set(d, static_cast<double>(n))), hn::Set(d, 0.5));
        const PlaceVec whole = hn::Floor(place);
        const IndexVec index = hn::DemoteTo(di, whole);
        hn::StoreU(Wrapped(di, wrap, index, n), di, taps.first + i);
        hn::StoreU(Wrapped(di, wrap, hn::Add(index, hn::Set(di, 1)), n), di, taps.second + i);
        hn::StoreU(hn::DemoteTo(df, hn::Sub(place, whole)), df, taps.weight + i);
    }
}

using ColumnTag = hn::RebindToSigned<FloatTag>;
using ColumnVec = hn::Vec<ColumnTag>;

void FindRuns(const TapRow& taps, int count, int readable, std::int32_t* start) {
    const ColumnTag d;
    const auto lanes = static_cast<int>(hn::Lanes(d));
    for (int i = 0; i < count; i += lanes) {
        const ColumnVec first = hn::LoadU(d, taps.first + i);
        const ColumnVec second = hn::LoadU(d, taps.second + i);
        const int least = hn::GetLane(hn::MinOfLanes(d, hn::Min(first, second)));
        const int most = hn::GetLane(hn::MaxOfLanes(d, hn::Max(first, second)));
        const bool is_run = most < least + 2 * lanes && least + 2 * lanes <= readable;
        start[i / lanes] = is_run ? least : -1;
    }
}

// Interpolates; the result is exactly a at 0 and b at 1.
HWY_INLINE FloatVec Mix(FloatVec a, FloatVec b, FloatVec t, FloatVec rest) {
    return hn::Add(hn::Mul(a, rest), hn::Mul(b, t));
}

// Texels at the columns of one vector.
struct Gathered {
    ColumnVec columns;

    HWY_INLINE FloatVec operator()(const float* row) const { return hn::GatherIndex(FloatTag(), row, columns); }
};

class Permuted {
public:
    HWY_INLINE Permuted(ColumnVec columns, int start)
        : start_(start), offsets_(hn::Sub(columns, hn::Set(ColumnTag(), start))) {}

    HWY_INLINE FloatVec operator()(const float* row) const {
        const FloatTag d;
        const ColumnTag di;
        const ColumnVec lanes = hn::Set(di, static_cast<std::int32_t>(hn::Lanes(di)));
        const auto within = hn::IndicesFromVec(d, hn::And(offsets_, hn::Sub(lanes, hn::Set(di, 1))));
        const FloatVec near = hn::TableLookupLanes(hn::LoadU(d, row + start_), within);
        const FloatVec far = hn::TableLookupLanes(hn::LoadU(d, row + start_ + hn::Lanes(d)), within);
        return hn::IfThenElse(hn::RebindMask(d, hn::Lt(offsets_, lanes)), near, far);
    }

private:
    int start_;
    ColumnVec offsets_;
};

template <class Texels>
HWY_INLINE FloatVec Bilinear(const float* upper, const float* lower, const Texels& first, const Texels& second,
                             FloatVec x, FloatVec y) {
    const FloatVec one = hn::Set(FloatTag(), 1.0f);
    const FloatVec rest = hn::Sub(one, x);
    return Mix(Mix(first(upper), second(upper), x, rest), Mix(first(lower), second(lower), x, rest), y,
               hn::Sub(one, y));
}

void BilinearRow(const float* upper, const float* lower, const TapRow& columns, const std::int32_t* runs, float weight,
                 int count, float* out) {
    const FloatTag d;
    const ColumnTag di;
    const FloatVec y = hn::Set(d, weight);
    const auto lanes = static_cast<int>(hn::Lanes(d));
    for (int i = 0; i < count; i += lanes) {
        const int start = runs[i / lanes];
        const ColumnVec first = hn::LoadU(di, columns.first + i);
        const ColumnVec second = hn::LoadU(di, columns.second + i);
        const FloatVec x = hn::LoadU(d, columns.weight + i);
        const FloatVec samples = start < 0 ? Bilinear<Gathered>(upper, lower, {first}, {second}, x, y)
                                           : Bilinear<Permuted>(upper, lower, {first, start}, {second, start}, x, y);
        hn::StoreU(samples, d, out + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, tap_row, Taps, (double start, double step, double rest, Wrap wrap, int n, int count, TapRow taps),
           (start, step, rest, wrap, n, count, taps))

TEX_KERNEL(void, find_runs, FindRuns, (const TapRow& taps, int count, int readable, std::int32_t* start),
           (taps, count, readable, start))

TEX_KERNEL(void, bilinear_row, BilinearRow,
           (const float* upper, const float* lower, const TapRow& columns, const std::int32_t* runs, float weight,
            int count, float* out),
           (upper, lower, columns, runs, weight, count, out))

}  // namespace tex::inline v1
#endif
