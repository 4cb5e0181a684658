// SPDX-License-Identifier: Apache-2.0

#include "kernels/bc7_lines.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bc7_lines.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/bc7_lines-inl.h"
#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

void FitBc7Lines(const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group) {
    if (kind.has_alpha && group.has_alpha) return FitLines<Bc7Rules, 4>(kind, steps, group);
    FitLines<Bc7Rules, 3>(kind, steps, group);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, fit_bc7_lines, FitBc7Lines, (const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group),
           (kind, steps, group))

}  // namespace tex::inline v1
#endif
