// SPDX-License-Identifier: Apache-2.0

#include "checks/mesh_rules.h"

#include <cassert>

#include "checks/chart_rules.h"
#include "checks/mesh_fit.h"
#include "checks/tangent_rules.h"

namespace tex::inline v1 {

Result<std::optional<SeamEvidence>> check_mesh_rules(const Subject& subject, Findings& findings) {
    const MeshToCheck* const mesh = subject.options.mesh;
    if (mesh == nullptr) return std::optional<SeamEvidence>();
    assert(check_part(mesh->selected.part) && mesh->selected.part.triangles() > 0);
    if (const auto checked = check_tangent_rules(subject, findings); !checked) return checked.error().of(mesh->file);
    if (!subject.has_vectors) return std::optional<SeamEvidence>();
    if (const auto checked = check_chart_rules(subject, findings); !checked) return checked.error().of(mesh->file);
    auto seams = check_mesh_fit(subject, findings);
    if (!seams) return seams.error().of(mesh->file);
    return seams;
}

}  // namespace tex::inline v1
