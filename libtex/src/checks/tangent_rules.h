// SPDX-License-Identifier: Apache-2.0
// tangent_rules.h: the rules about the tangents of a mesh, without the map: N701 to N706.

#pragma once

#include "checks/findings.h"

namespace tex {

// Precondition: subject.options.mesh is not null. Errors: as make_tangents().
Result<void> check_tangent_rules(const Subject& subject, Findings& findings);

}  // namespace tex
