// SPDX-License-Identifier: Apache-2.0
// field_rules.h: the rules about maps that are not those of a height field (N309 and N310).

#pragma once

#include <tex/types.h>

#include "checks/findings.h"

namespace tex::inline v1 {

// Errors: cancelled, out_of_memory.
Result<void> check_field_rules(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
