// SPDX-License-Identifier: Apache-2.0
// occlusion_rules.h: the rule about an occlusion map beside the normals.

#pragma once

#include <optional>

#include "checks/findings.h"

namespace tex::inline v1 {

// Compares the occlusion that the options name with the surface that the normals show. Nothing if there is no
// occlusion, or nothing to compare. Errors: cancelled, out_of_memory.
Result<std::optional<OcclusionEvidence>> check_occlusion_rules(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
