// SPDX-License-Identifier: Apache-2.0
// curve_rules.h: the rules N301, N302, N313 and N314, about curves that all channels went through.

#pragma once

#include "checks/centre.h"
#include "checks/findings.h"

namespace tex::inline v1 {

// `centre` is that of the stored values.
void check_curve(const CheckContext& context, const Centre& centre, Findings& findings);

}  // namespace tex::inline v1
