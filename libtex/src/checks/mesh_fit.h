// SPDX-License-Identifier: Apache-2.0
// mesh_fit.h: whether a map fits its mesh, judged by its UV seams: N711.

#pragma once

#include "checks/findings.h"

namespace tex::inline v1 {

// Where green of the map points on the mesh of context.options.mesh, which is not null: see MeshToCheck.
[[nodiscard]] YAxis y_on_mesh(const CheckContext& context);

// Measures the seams as context.options.mesh says that the map is decoded, and adds a finding if it was made for
// another decoder, other tangents or the other direction of green. Returns nullopt if there are no seams.
//
// Precondition: context.options.mesh is not null, context.has_vectors. Errors: as make_tangents().
Result<std::optional<SeamEvidence>> check_mesh_fit(const CheckContext& context, Findings& findings);

}  // namespace tex::inline v1
