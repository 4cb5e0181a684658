// SPDX-License-Identifier: Apache-2.0

#include "kernels/bc7_planes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bc7_planes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/bc7_planes-inl.h"
#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

void FitBc7Planes(const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group) {
    FitPlanes<Bc7Rules>(kind, steps, group);
}

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex::inline v1 {

TEX_KERNEL(void, fit_bc7_planes, FitBc7Planes, (const Bc7Kind& kind, const Bc7Steps& steps, Bc7Group& group),
           (kind, steps, group))

}  // namespace tex::inline v1
#endif
