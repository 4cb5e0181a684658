// SPDX-License-Identifier: Apache-2.0

#include "tasks/lod_notes.h"

#include <cmath>

#include <fmt/format.h>

#include "cli/text.h"
#include "tasks/model_output.h"

namespace tex::cli {

bool has_coarse_normals(const Mesh& mesh) {
    bool is_slanted = false;
    for (const MeshPart& part : mesh.parts) {
        if (part.uvs.empty()) continue;
        for (const Float3& normal : part.normals) {
            int components = 0;
            for (const float value : {normal.x, normal.y, normal.z}) {
                constexpr float kSteps = 127.0f, kSlack = 1e-4f;
                if (std::abs(value * kSteps - std::round(value * kSteps)) > kSlack) return false;
                components += std::abs(value) > 0.5f / kSteps ? 1 : 0;
            }
            is_slanted = is_slanted || components > 1;
        }
    }
    return is_slanted;
}

Result<void> note_lacks(Job& job) {
    const ModelOutput& output = *job.task.model_output;
    const auto model = output.images.front().front()->read(LastModel::Part::all, job.read_options);
    if (!model) return model.error();
    if (output.adds_material)
        job.warn("its triangles have no material; they get one for the map, which is as white as they were");
    if (has_coarse_normals((*model)->mesh)) {
        job.report["coarse_normals"] = true;
        job.say(
            fmt::format("{}: the simplified model's normals have 8 bits, steps of half a degree; the maps make up for "
                        "that (gltfpack -vn 12 writes finer ones)\n",
                        printable(job.task.output)));
    }
    return {};
}

}  // namespace tex::cli
