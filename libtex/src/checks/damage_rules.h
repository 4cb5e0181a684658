// SPDX-License-Identifier: Apache-2.0
// damage_rules.h: the rules of the family "damage", see rules.cpp.

#pragma once

#include "checks/findings.h"

namespace tex::inline v1 {

// Errors: out_of_memory.
Result<void> check_damage_rules(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
