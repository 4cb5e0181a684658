// SPDX-License-Identifier: Apache-2.0
// sign_rules.h: the rule about files that declare the other sign than their texels have (N311).

#pragma once

#include <tex/types.h>

#include "checks/findings.h"

namespace tex::inline v1 {

// Errors: cancelled, out_of_memory.
Result<void> check_sign_rules(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
