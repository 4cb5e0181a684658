// SPDX-License-Identifier: Apache-2.0
// chart_rules.h: the rules about the charts of a mesh, and whether its map is in object space: N721 to N724.

#pragma once

#include "checks/findings.h"

namespace tex::inline v1 {

// Preconditions: context.options.mesh is not null, context.has_vectors. Errors: unsupported, as described in mesh.h;
// cancelled.
Result<void> check_chart_rules(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
