// SPDX-License-Identifier: Apache-2.0
// model_rules.h: the rules of the family "model", see rules.cpp.

#pragma once

#include "checks/findings.h"

namespace tex::inline v1 {

// Checks how the model of context.options.model uses the map, if there is a model.
void check_model_rules(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
