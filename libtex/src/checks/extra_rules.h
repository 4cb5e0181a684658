// SPDX-License-Identifier: Apache-2.0
// extra_rules.h: what is in alpha and blue beside the normals.

#pragma once

#include "checks/findings.h"

namespace tex::inline v1 {

// Errors: cancelled, out_of_memory.
Result<void> check_extra_rules(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
