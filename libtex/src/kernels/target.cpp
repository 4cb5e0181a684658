// SPDX-License-Identifier: Apache-2.0

#include "kernels/target.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/target.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace tex::inline v1 {
namespace HWY_NAMESPACE {

std::int64_t KernelTarget() { return HWY_TARGET; }

}  // namespace HWY_NAMESPACE
}  // namespace tex::inline v1
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
// A stopgap, by symbol interposition. When Highway's library (1.0.3) is loaded, one of its constructors measures the
// resolution of the processor's clock, which only Highway's benchmarks use. That takes 3 to 4 ms, a third of the total
// time for a small texture. In every process that links libtex before Highway, the constructor finds this function
// instead. This function can be removed if Highway no longer measures when it is loaded, or if libtex dispatches
// kernels itself, without Highway's library.
namespace hwy::platform {
__attribute__((visibility("default"))) double TimerResolution();
double TimerResolution() { return 1e-8; }
}  // namespace hwy::platform

namespace tex::inline v1 {

TEX_KERNEL(std::int64_t, kernel_target, KernelTarget, (), ())

const char* kernel_target_name() { return hwy::TargetName(kernel_target()); }

std::string highway_version() {
    return std::to_string(HWY_MAJOR) + "." + std::to_string(HWY_MINOR) + "." + std::to_string(HWY_PATCH);
}

}  // namespace tex::inline v1
#endif  // HWY_ONCE
