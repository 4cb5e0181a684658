// SPDX-License-Identifier: Apache-2.0

#include "kernels/png_filter.h"

#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/png_filter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"
#include "kernels/png_predict-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<std::uint8_t, 64>;
using V = hn::Vec<D>;

constexpr std::size_t kFilters = 5;  // none, sub, up, average, Paeth

using Bytes = PngNeighbours<D>;

template <std::size_t kFilter>
HWY_INLINE V Predict(D d, const Bytes& n) {
    if constexpr (kFilter == 0) return hn::Zero(d);
    if constexpr (kFilter == 1) return n.left;
    if constexpr (kFilter == 2) return n.above;
    if constexpr (kFilter == 3) return PngAverage(d, n);
    if constexpr (kFilter == 4) return PngPaeth(d, n);
}

HWY_INLINE std::uint8_t FilterOne(std::size_t filter, const std::uint8_t* row, const std::uint8_t* above,
                                  std::size_t step) {
    return static_cast<std::uint8_t>(*row - PngPredictOne(filter, *(row - step), *above, *(above - step)));
}

HWY_INLINE Bytes NeighboursAt(D d, const std::uint8_t* row, const std::uint8_t* above, std::size_t step) {
    return {hn::LoadU(d, row - step), hn::LoadU(d, above), hn::LoadU(d, above - step)};
}

#if HWY_TARGET == HWY_SCALAR
constexpr bool kHasSums = false;  // no SumsOf8
#else
constexpr bool kHasSums = true;

using Sums = hn::Vec<hn::Repartition<std::uint64_t, D> >;

template <std::size_t kFilter>
HWY_INLINE Sums AddMagnitudes(D d, Sums sums, V bytes, const Bytes& n) {
    const V difference = hn::Sub(bytes, Predict<kFilter>(d, n));
    return hn::Add(sums, hn::SumsOf8(hn::Min(difference, hn::Sub(hn::Zero(d), difference))));
}
#endif

std::array<std::uint64_t, kFilters> Magnitudes(const std::uint8_t* row, const std::uint8_t* above, std::size_t count,
                                               std::size_t step) {
    std::array<std::uint64_t, kFilters> totals{};
    std::size_t i = 0;
#if HWY_TARGET != HWY_SCALAR
    const D d;
    const hn::Repartition<std::uint64_t, D> d64;
    Sums none = hn::Zero(d64), sub = none, up = none, average = none, paeth = none;
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
        const V bytes = hn::LoadU(d, row + i);
        const Bytes n = NeighboursAt(d, row + i, above + i, step);
        none = AddMagnitudes<0>(d, none, bytes, n);
        sub = AddMagnitudes<1>(d, sub, bytes, n);
        up = AddMagnitudes<2>(d, up, bytes, n);
        average = AddMagnitudes<3>(d, average, bytes, n);
        paeth = AddMagnitudes<4>(d, paeth, bytes, n);
    }
    const auto total = [&](Sums sums) { return hn::GetLane(hn::SumOfLanes(d64, sums)); };
    totals = {total(none), total(sub), total(up), total(average), total(paeth)};
#endif
    for (; i < count; ++i) {
        for (std::size_t k = 0; k < kFilters; ++k) {
            const unsigned difference = FilterOne(k, row + i, above + i, step);
            totals[k] += difference < 128 ? difference : 256 - difference;
        }
    }
    return totals;
}

template <std::size_t kFilter>
void Apply(const std::uint8_t* row, const std::uint8_t* above, std::size_t count, std::size_t step, std::uint8_t* out) {
    const D d;
    std::size_t i = 0;
    for (; kHasSums && i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
        const Bytes n = NeighboursAt(d, row + i, above + i, step);
        hn::StoreU(hn::Sub(hn::LoadU(d, row + i), Predict<kFilter>(d, n)), d, out + i);
    }
    for (; i < count; ++i) out[i] = FilterOne(kFilter, row + i, above + i, step);
}

void FilterPngRow(const std::uint8_t* row, const std::uint8_t* above, std::size_t count, std::size_t step,
                  std::uint8_t* out) {
    const std::array<std::uint64_t, kFilters> totals = Magnitudes(row, above, count, step);
    std::size_t best = 0;
    for (std::size_t k = 1; k < kFilters; ++k) {
        if (totals[k] < totals[best]) best = k;
    }
    *out++ = static_cast<std::uint8_t>(best);
    switch (best) {
        case 0: return Apply<0>(row, above, count, step, out);
        case 1: return Apply<1>(row, above, count, step, out);
        case 2: return Apply<2>(row, above, count, step, out);
        case 3: return Apply<3>(row, above, count, step, out);
        default: return Apply<4>(row, above, count, step, out);
    }
}

void SwapSampleBytes(std::uint8_t* samples, std::size_t count) {
    std::size_t i = 0;
#if HWY_TARGET != HWY_SCALAR
    const D d;
    const hn::Repartition<std::uint16_t, D> d16;
    for (; i + hn::Lanes(d16) <= count; i += hn::Lanes(d16)) {
        const auto codes = hn::BitCast(d16, hn::LoadU(d, samples + 2 * i));
        hn::StoreU(hn::BitCast(d, hn::Or(hn::ShiftLeft<8>(codes), hn::ShiftRight<8>(codes))), d, samples + 2 * i);
    }
#endif
    for (; i < count; ++i) {
        const std::uint8_t low = samples[2 * i];
        samples[2 * i] = samples[2 * i + 1];
        samples[2 * i + 1] = low;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, filter_png_row, FilterPngRow,
           (const std::uint8_t* row, const std::uint8_t* above, std::size_t count, std::size_t step, std::uint8_t* out),
           (row, above, count, step, out))

TEX_KERNEL(void, swap_sample_bytes, SwapSampleBytes, (std::uint8_t * samples, std::size_t count), (samples, count))

}  // namespace tex::inline v1
#endif
