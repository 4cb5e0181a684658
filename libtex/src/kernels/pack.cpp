// SPDX-License-Identifier: Apache-2.0

#include "kernels/pack.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/pack.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;

template <class Code>
auto quantize(const PackChannel& channel, int i) {
    const Floats d;
    const hn::Rebind<std::int32_t, Floats> di;
    const hn::Rebind<Code, Floats> dc;
    constexpr int kTop = hwy::LimitsMax<Code>();
    if (channel.values == nullptr) return hn::Set(dc, static_cast<Code>(kTop));
    auto n = hn::LoadU(d, channel.values + i);
    if (channel.negate) n = hn::Neg(n);
    const auto one = hn::Set(d, 1.0f);
    const auto half = hn::Set(d, 0.5f);
    const auto top = hn::Set(d, static_cast<float>(kTop));
    if (!channel.is_other) n = hn::Mul(hn::Add(n, one), half);
    const auto scaled = hn::Add(hn::Mul(n, top), half);
    // Clamped first, so that truncating is the same as floor.
    const auto clamped = hn::Min(hn::Max(scaled, hn::Zero(d)), top);
    return hn::DemoteTo(dc, hn::ConvertTo(di, clamped));
}

template <class Code>
void pack_unorm(const PackChannel* channels, int count, int width, Code* out) {
    const Floats d;
    const hn::Rebind<Code, Floats> dc;
    const int step = static_cast<int>(hn::Lanes(d));
    for (int i = 0; i < width; i += step, out += count * step) {
        const auto c0 = quantize<Code>(channels[0], i);
        const auto c1 = quantize<Code>(channels[1], i);
        if (count == 2) {
            hn::StoreInterleaved2(c0, c1, dc, out);
        } else if (count == 3) {
            hn::StoreInterleaved3(c0, c1, quantize<Code>(channels[2], i), dc, out);
        } else {
            hn::StoreInterleaved4(c0, c1, quantize<Code>(channels[2], i), quantize<Code>(channels[3], i), dc, out);
        }
    }
}

void pack_unorm8(const PackChannel* channels, int count, int width, std::uint8_t* out) {
    pack_unorm(channels, count, width, out);
}

void pack_unorm16(const PackChannel* channels, int count, int width, std::uint16_t* out) {
    pack_unorm(channels, count, width, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, pack_unorm8, pack_unorm8, (const PackChannel* channels, int count, int width, std::uint8_t* out),
           (channels, count, width, out))

TEX_KERNEL(void, pack_unorm16, pack_unorm16, (const PackChannel* channels, int count, int width, std::uint16_t* out),
           (channels, count, width, out))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
