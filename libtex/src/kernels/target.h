// SPDX-License-Identifier: Apache-2.0
// kernels/target.h: the instruction set that the kernels use.

#pragma once

#include <cstdint>
#include <string>

namespace tex::inline v1 {

// The Highway target (HWY_AVX2, ...) to which kernels are dispatched now. For tests and reports: results do not depend
// on it.
std::int64_t kernel_target();

// The name of the target, for example "AVX2".
const char* kernel_target_name();

std::string highway_version();

}  // namespace tex::inline v1
