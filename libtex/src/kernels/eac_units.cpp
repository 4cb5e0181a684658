// SPDX-License-Identifier: Apache-2.0

#include "kernels/eac_units.h"

#include "blocks/eac.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/eac_units.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void EacUnits(const float* row, int count, bool negate, int top, std::int32_t* units) {
    const hn::CappedTag<float, 16> d;
    const hn::Rebind<std::int32_t, hn::CappedTag<float, 16>> di;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const float half_range = 0.5f * static_cast<float>(top) * static_cast<float>(kEacUnit);
    const auto half = hn::Set(d, half_range);
    const auto one = hn::Set(d, 1.0f);
    int i = 0;
    for (; i + lanes <= count; i += lanes) {
        auto n = hn::LoadU(d, row + i);
        if (negate) n = hn::Neg(n);
        const auto clamped = hn::Min(hn::Max(n, hn::Neg(one)), one);
        const auto value = hn::Add(hn::Add(hn::Mul(clamped, half), half), hn::Set(d, 0.5f));
        hn::StoreU(hn::ConvertTo(di, value), di, units + i);  // not negative, so truncating is the same as floor
    }
    for (; i < count; ++i) units[i] = to_eac_units(negate ? -row[i] : row[i], top);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, eac_units, EacUnits, (const float* row, int count, bool negate, int top, std::int32_t* units),
           (row, count, negate, top, units))

}  // namespace tex::inline v1
#endif  // HWY_ONCE
