// SPDX-License-Identifier: Apache-2.0
//
// A byte depends on the byte to its left, so one row alone leaves a processor waiting. Here each lane of a vector has a
// row, and is one texel behind the lane above it, so that the three neighbours of a byte are known from earlier steps:
// the left one in the same lane, the other two in the lane above. One step undoes all five filters and picks that of
// each lane. The first lane has the row above, without a filter.

#include "kernels/png_unfilter.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/png_unfilter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"
#include "kernels/png_predict-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Whether a filter of these rows looks to the left.
bool HasChain(int rows, const std::uint8_t* filters) {
    return std::any_of(filters, filters + rows, [](std::uint8_t filter) { return filter != 0 && filter != 2; });
}

void UnfilterAlone(const std::uint8_t* above, std::uint8_t* row, std::size_t count, std::size_t step,
                   std::size_t filter) {
    for (std::size_t i = 0; i < count; ++i) {
        const int predicted = PngPredictOne(filter, *(row + i - step), above[i], *(above + i - step));
        row[i] = static_cast<std::uint8_t>(row[i] + predicted);
    }
}

void AddAbove(const std::uint8_t* above, std::uint8_t* row, std::size_t count) {
    const hn::CappedTag<std::uint8_t, 64> d;
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d))
        hn::StoreU(hn::Add(hn::LoadU(d, row + i), hn::LoadU(d, above + i)), d, row + i);
    for (; i < count; ++i) row[i] = static_cast<std::uint8_t>(row[i] + above[i]);
}

void UnfilterRowByRow(std::uint8_t* above, std::size_t stride, std::size_t count, std::size_t step, int rows,
                      const std::uint8_t* filters) {
    for (int k = 0; k < rows; ++k, above += stride) {
        switch (filters[k]) {
            case 0: break;
            case 1: UnfilterAlone(above, above + stride, count, step, 1); break;
            case 2: AddAbove(above, above + stride, count); break;
            case 3: UnfilterAlone(above, above + stride, count, step, 3); break;
            default: UnfilterAlone(above, above + stride, count, step, 4); break;
        }
    }
}

#if HWY_TARGET == HWY_SCALAR

void UnfilterPngRows(std::uint8_t* above, std::size_t stride, std::size_t count, std::size_t step, int rows,
                     const std::uint8_t* filters) {
    UnfilterRowByRow(above, stride, count, step, rows, filters);
}

#else

constexpr std::size_t kLanes = 16;
constexpr std::size_t kTile = 48;  // steps between transpositions: a multiple of kLanes and of every size of a texel
constexpr int kFewRows = 4;        // as slow together as one by one

using D = hn::FixedTag<std::uint8_t, kLanes>;
using V = hn::Vec<D>;

// A round interleaves the two halves of the rows; after four rounds, rows and columns have changed places.
HWY_INLINE void Transpose(V (&v)[kLanes]) {
    const D d;
    for (int round = 0; round < 4; ++round) {
        V w[kLanes];
        for (std::size_t k = 0; k < kLanes / 2; ++k) {
            w[2 * k] = hn::InterleaveLower(d, v[k], v[k + kLanes / 2]);
            w[2 * k + 1] = hn::InterleaveUpper(d, v[k], v[k + kLanes / 2]);
        }
        for (std::size_t k = 0; k < kLanes; ++k) v[k] = w[k];
    }
}

// Which lanes have which filter.
struct Filters {
    V sub, up, average, paeth;
};

Filters FiltersOf(int rows, const std::uint8_t* filters) {
    const D d;
    alignas(kLanes) std::uint8_t numbers[kLanes] = {};
    std::copy_n(filters, rows, numbers + 1);
    const V lanes = hn::Load(d, numbers);
    const auto with = [&](std::uint8_t filter) { return hn::VecFromMask(d, hn::Eq(lanes, hn::Set(d, filter))); };
    return {with(1), with(2), with(3), with(4)};
}

template <std::size_t kStep>
struct Chain {
    V left[kStep], corner[kStep];
};

// Turns the filtered bytes of kTile steps into those of the rows.
template <std::size_t kStep>
HWY_INLINE void UnfilterTile(const Filters& filters, Chain<kStep>& chain, std::uint8_t* tile) {
    const D d;
    for (std::size_t k = 0; k < kTile; k += kStep) {
        for (std::size_t m = 0; m < kStep; ++m) {
            const PngNeighbours<D> n = {chain.left[m], hn::ShiftLeftLanes<1>(d, chain.left[m]), chain.corner[m]};
            const V rough = hn::Or(hn::And(filters.sub, n.left), hn::And(filters.up, n.above));
            const V fine = hn::Or(hn::And(filters.average, PngAverage(d, n)), hn::And(filters.paeth, PngPaeth(d, n)));
            const V bytes = hn::Add(hn::Load(d, tile + (k + m) * kLanes), hn::Or(rough, fine));
            hn::Store(bytes, d, tile + (k + m) * kLanes);
            chain.left[m] = bytes;
            chain.corner[m] = n.above;
        }
    }
}

template <std::size_t kStep>
void UnfilterTogether(std::uint8_t* above, std::size_t stride, std::size_t count, int rows,
                      const std::uint8_t* filters) {
    const D d;
    const auto lanes = static_cast<std::size_t>(rows) + 1;
    const Filters lane_filters = FiltersOf(rows, filters);
    Chain<kStep> chain;
    for (std::size_t m = 0; m < kStep; ++m) chain.left[m] = chain.corner[m] = hn::Zero(d);
    alignas(64) std::uint8_t tile[kTile * kLanes];
    const std::size_t end = count + (lanes - 1) * kStep;
    for (std::size_t t = 0; t < end; t += kTile) {
        V v[kLanes];
        for (std::size_t k = 0; k < kTile; k += kLanes) {
            for (std::size_t r = 0; r < kLanes; ++r)
                v[r] = r < lanes ? hn::LoadU(d, above + r * stride + t + k - r * kStep) : hn::Zero(d);
            Transpose(v);
            for (std::size_t r = 0; r < kLanes; ++r) hn::Store(v[r], d, tile + (k + r) * kLanes);
        }
        UnfilterTile<kStep>(lane_filters, chain, tile);
        for (std::size_t k = 0; k < kTile; k += kLanes) {
            for (std::size_t r = 0; r < kLanes; ++r) v[r] = hn::Load(d, tile + (k + r) * kLanes);
            Transpose(v);
            for (std::size_t r = 1; r < lanes; ++r) hn::StoreU(v[r], d, above + r * stride + t + k - r * kStep);
        }
    }
}

void UnfilterPngRows(std::uint8_t* above, std::size_t stride, std::size_t count, std::size_t step, int rows,
                     const std::uint8_t* filters) {
    if (rows <= kFewRows || !HasChain(rows, filters))
        return UnfilterRowByRow(above, stride, count, step, rows, filters);
    switch (step) {
        case 1: return UnfilterTogether<1>(above, stride, count, rows, filters);
        case 2: return UnfilterTogether<2>(above, stride, count, rows, filters);
        case 3: return UnfilterTogether<3>(above, stride, count, rows, filters);
        case 4: return UnfilterTogether<4>(above, stride, count, rows, filters);
        case 6: return UnfilterTogether<6>(above, stride, count, rows, filters);
        default: return UnfilterTogether<8>(above, stride, count, rows, filters);
    }
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, unfilter_png_rows, UnfilterPngRows,
           (std::uint8_t * above, std::size_t stride, std::size_t count, std::size_t step, int rows,
            const std::uint8_t* filters),
           (above, stride, count, step, rows, filters))

}  // namespace tex::inline v1
#endif
