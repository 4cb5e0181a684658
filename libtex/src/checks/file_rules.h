// SPDX-License-Identifier: Apache-2.0
// file_rules.h: the rules of the family "file", see rules.cpp.

#pragma once

#include "checks/findings.h"

namespace tex::inline v1 {

void check_file_rules(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
