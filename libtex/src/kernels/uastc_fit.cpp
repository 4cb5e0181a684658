// SPDX-License-Identifier: Apache-2.0

#include "kernels/uastc_fit.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/uastc_fit.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/bc7_lines-inl.h"
#include "kernels/bc7_planes-inl.h"
#include "kernels/dispatch.h"
#include "kernels/uastc_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

void FitUastcPlanes(const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group) {
    FitPlanes<UastcRules>(kind, steps, group);
}

void FitUastcLines(const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group) {
    FitLines<UastcRules, 3>(kind, steps, group);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, fit_uastc_planes, FitUastcPlanes, (const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group),
           (kind, steps, group))

TEX_KERNEL(void, fit_uastc_lines, FitUastcLines, (const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group),
           (kind, steps, group))

}  // namespace tex::inline v1
#endif
