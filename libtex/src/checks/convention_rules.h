// SPDX-License-Identifier: Apache-2.0
// convention_rules.h: the rules of the family "convention", see rules.cpp.

#pragma once

#include "checks/findings.h"

namespace tex::inline v1 {

void check_convention_rules(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
