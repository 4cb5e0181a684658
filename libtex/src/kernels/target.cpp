// SPDX-License-Identifier: Apache-2.0

#include "kernels/target.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/target.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tex {
namespace HWY_NAMESPACE {

std::int64_t KernelTarget() { return HWY_TARGET; }

}  // namespace HWY_NAMESPACE
}  // namespace tex
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tex {

HWY_EXPORT(KernelTarget);

std::int64_t kernel_target() { return HWY_DYNAMIC_DISPATCH(KernelTarget)(); }

const char* kernel_target_name() { return hwy::TargetName(kernel_target()); }

std::string highway_version() {
    return std::to_string(HWY_MAJOR) + "." + std::to_string(HWY_MINOR) + "." + std::to_string(HWY_PATCH);
}

}  // namespace tex
#endif  // HWY_ONCE
