// SPDX-License-Identifier: Apache-2.0
// pair_rules.h: the rules of the family "pair", see rules.cpp.

#pragma once

#include "checks/findings.h"

namespace tex::inline v1 {

// Checks whether the normals follow from context.options.height. Returns nullopt if there are no heights, or no slopes
// to compare.
std::optional<PairEvidence> check_pair_rules(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
