// SPDX-License-Identifier: Apache-2.0
// kernels/target.h: which instruction set the kernels use.

#pragma once

#include <cstdint>
#include <string>

namespace tex {

// The Highway target (HWY_AVX2, ...) that kernels are dispatched to now. For tests and reports: results do
// not depend on it.
std::int64_t kernel_target();

// Its name: "AVX2".
const char* kernel_target_name();

std::string highway_version();

}  // namespace tex
