// SPDX-License-Identifier: Apache-2.0

#include "checks/mesh_rules.h"

#include <cassert>

#include "checks/chart_rules.h"
#include "checks/mesh_fit.h"
#include "checks/tangent_rules.h"

namespace tex::inline v1 {

Result<std::optional<SeamEvidence>> check_mesh_rules(const CheckContext& context, Findings& findings) {
    const MeshToCheck* const mesh = context.options.mesh;
    if (mesh == nullptr) return std::optional<SeamEvidence>();
    assert(check_part(mesh->selected.part) && mesh->selected.part.triangles() > 0);
    if (const auto checked = check_tangent_rules(context, findings); !checked) return checked.error().of(mesh->file);
    if (!context.has_vectors) return std::optional<SeamEvidence>();
    if (const auto checked = check_chart_rules(context, findings); !checked) return checked.error().of(mesh->file);
    auto seams = check_mesh_fit(context, findings);
    if (!seams) return seams.error().of(mesh->file);
    return seams;
}

}  // namespace tex::inline v1
