// SPDX-License-Identifier: Apache-2.0
// mip_rules.h: the rules of the family "mips", see rules.cpp.

#pragma once

#include "checks/findings.h"

namespace tex::inline v1 {

// Errors: cancelled, out_of_memory.
Result<void> check_mip_rules(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
