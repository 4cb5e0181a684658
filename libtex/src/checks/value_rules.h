// SPDX-License-Identifier: Apache-2.0
// value_rules.h: the rules of the family "values", see rules.cpp.

#pragma once

#include <tex/types.h>

#include "checks/findings.h"

namespace tex::inline v1 {

Result<void> check_value_rules(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
