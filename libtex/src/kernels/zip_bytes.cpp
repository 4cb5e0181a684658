// SPDX-License-Identifier: Apache-2.0

#include "kernels/zip_bytes.h"

#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/zip_bytes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::uint8_t kMiddle = 128;  // the stored difference of equal bytes. Adding and subtracting it are the same.

HWY_INLINE std::uint8_t Difference(std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(a - b + kMiddle);
}
HWY_INLINE std::uint8_t Sum(std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(a + b + kMiddle); }

void PredictZipBytes(const std::uint8_t* bytes, std::size_t count, std::uint8_t* out) {
    if (count == 0) return;
    const std::size_t pairs = count / 2;
    std::uint8_t* const odd = out + (count + 1) / 2;
    out[0] = bytes[0];
    if (pairs > 0) odd[0] = Difference(bytes[1], bytes[count % 2 == 0 ? count - 2 : count - 1]);
    std::size_t k = 1;
#if HWY_TARGET != HWY_SCALAR
    const hn::CappedTag<std::uint8_t, 64> d;
    const auto middle = hn::Set(d, kMiddle);
    hn::Vec<decltype(d)> even_bytes, odd_bytes, even_before, odd_before;
    for (; k + hn::Lanes(d) <= pairs; k += hn::Lanes(d)) {
        hn::LoadInterleaved2(d, bytes + 2 * k, even_bytes, odd_bytes);
        hn::LoadInterleaved2(d, bytes + 2 * k - 2, even_before, odd_before);
        hn::StoreU(hn::Add(hn::Sub(even_bytes, even_before), middle), d, out + k);
        hn::StoreU(hn::Add(hn::Sub(odd_bytes, odd_before), middle), d, odd + k);
    }
#endif
    for (; k < pairs; ++k) {
        out[k] = Difference(bytes[2 * k], bytes[2 * k - 2]);
        odd[k] = Difference(bytes[2 * k + 1], bytes[2 * k - 1]);
    }
    if (count % 2 != 0 && count > 1) out[pairs] = Difference(bytes[count - 1], bytes[count - 3]);
}

// The last byte that comes from `count` differences: their sum.
std::uint8_t SumAll(const std::uint8_t* differences, std::size_t count) {
    std::uint8_t total = kMiddle;
    std::size_t k = 0;
#if HWY_TARGET != HWY_SCALAR
    const hn::CappedTag<std::uint8_t, 64> d;
    const hn::Repartition<std::uint64_t, decltype(d)> d64;
    auto sums = hn::Zero(d64);
    for (; k + hn::Lanes(d) <= count; k += hn::Lanes(d))
        sums = hn::Add(sums, hn::SumsOf8(hn::LoadU(d, differences + k)));
    // `k` is even: what was added to as many differences cancels out.
    total = static_cast<std::uint8_t>(total + hn::GetLane(hn::SumOfLanes(d64, sums)));
#endif
    for (; k < count; ++k) total = Sum(total, differences[k]);
    return total;
}

#if HWY_TARGET != HWY_SCALAR
using Block = hn::CappedTag<std::uint8_t, 16>;

// Adds to each byte all bytes before it, and those of the blocks before.
HWY_INLINE hn::Vec<Block> RunningSums(Block d, hn::Vec<Block> differences, hn::Vec<Block> before) {
    auto sums = hn::Xor(differences, hn::Set(d, kMiddle));  // subtracts kMiddle
    sums = hn::Add(sums, hn::ShiftLeftBytes<1>(d, sums));
    sums = hn::Add(sums, hn::ShiftLeftBytes<2>(d, sums));
    sums = hn::Add(sums, hn::ShiftLeftBytes<4>(d, sums));
    sums = hn::Add(sums, hn::ShiftLeftBytes<8>(d, sums));
    return hn::Add(sums, before);
}
#endif

void RestoreZipBytes(const std::uint8_t* differences, std::size_t count, std::uint8_t* out) {
    const std::size_t evens = (count + 1) / 2, pairs = count / 2;
    const std::uint8_t* const odd = differences + evens;
    std::uint8_t even_byte = kMiddle;
    std::uint8_t odd_byte = SumAll(differences, evens);
    std::size_t k = 0;
#if HWY_TARGET != HWY_SCALAR
    const Block d;
    const auto last = hn::Set(d, std::uint8_t{15});
    auto even_before = hn::Set(d, even_byte);
    auto odd_before = hn::Set(d, odd_byte);
    for (; k + 16 <= pairs; k += 16) {
        const auto even_bytes = RunningSums(d, hn::LoadU(d, differences + k), even_before);
        const auto odd_bytes = RunningSums(d, hn::LoadU(d, odd + k), odd_before);
        hn::StoreU(hn::InterleaveLower(d, even_bytes, odd_bytes), d, out + 2 * k);
        hn::StoreU(hn::InterleaveUpper(d, even_bytes, odd_bytes), d, out + 2 * k + 16);
        even_before = hn::TableLookupBytes(even_bytes, last);
        odd_before = hn::TableLookupBytes(odd_bytes, last);
    }
    even_byte = hn::GetLane(even_before);
    odd_byte = hn::GetLane(odd_before);
#endif
    for (; k < pairs; ++k) {
        out[2 * k] = even_byte = Sum(even_byte, differences[k]);
        out[2 * k + 1] = odd_byte = Sum(odd_byte, odd[k]);
    }
    if (evens > pairs) out[count - 1] = Sum(even_byte, differences[pairs]);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, predict_zip_bytes, PredictZipBytes, (const std::byte* bytes, std::size_t count, std::byte* out),
           (reinterpret_cast<const std::uint8_t*>(bytes), count, reinterpret_cast<std::uint8_t*>(out)))

TEX_KERNEL(void, restore_zip_bytes, RestoreZipBytes, (const std::byte* differences, std::size_t count, std::byte* out),
           (reinterpret_cast<const std::uint8_t*>(differences), count, reinterpret_cast<std::uint8_t*>(out)))

}  // namespace tex::inline v1
#endif
