// SPDX-License-Identifier: Apache-2.0
// mesh_rules.h: the rules of the family "mesh", see rules.cpp.

#pragma once

#include "checks/findings.h"

namespace tex::inline v1 {

// Checks the mesh of context.options.mesh, and the map on it. Returns nullopt if there is no mesh, no seam to measure,
// or no normals. Errors: as check() with a mesh.
Result<std::optional<SeamEvidence>> check_mesh_rules(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
