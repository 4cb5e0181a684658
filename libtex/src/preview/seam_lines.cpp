// SPDX-License-Identifier: Apache-2.0

#include "preview/seam_lines.h"

#include <optional>
#include <vector>

#include "checks/mesh_seams.h"
#include "checks/seam_evidence.h"
#include "preview/measures.h"
#include "preview/mesh_body.h"
#include "preview/shading.h"
#include "preview/surfaces.h"

namespace tex::inline v1::render {
namespace {

// A part whose set 0 of UVs is that of the space, where the functions of seams expect it; made only if it is not.
class PartOfSpace {
public:
    explicit PartOfSpace(const TangentSpace& space) : part_(&space.part) {
        if (space.uv_set == 0) return;
        changed_ = space.part;
        changed_->uvs = {changed_->uvs[static_cast<std::size_t>(space.uv_set)]};
        part_ = &*changed_;
    }
    [[nodiscard]] const MeshPart& get() const { return *part_; }

private:
    std::optional<MeshPart> changed_;
    const MeshPart* part_;
};

// What a shader unpacks at (x, y), in texels.
TexelAt unpacked(const Sampler& map, const PreviewScene& scene, const PreviewOptions& options) {
    return [&](double x, double y) {
        const Sample s = sample(map, {x / map.extent().width, 1.0 - y / map.extent().height}, {}, 1);
        const Vec3 n = unpack_normal({s[0], s[1], s[2]}, reconstructs_z(scene), static_cast<double>(options.bump_scale),
                                     options.scale_mode);
        return Vector3{n.x, n.y, n.z};
    };
}

// The point of the seam at a fraction of the way along it.
Vec3 on_edge(const MeshBody& mesh, const SeamEdge& edge, double way) {
    const auto corners = mesh.corners(edge.a.triangle);
    const Vec3 from = corners[edge.a.corner[0]], to = corners[edge.a.corner[1]];
    return from + (to - from) * way;
}

Code code_of(Vec3 color) { return {display_code(color.x), display_code(color.y), display_code(color.z)}; }

}  // namespace

SeamLines seam_lines(const MeshBody& mesh, const PreviewScene& scene, const PreviewOptions& options, double width) {
    const TangentSpace& space = mesh.space();
    const PartOfSpace of_space(space);
    const MeshPart& part = of_space.get();
    const std::vector<SeamEdge> edges = find_seams(part);
    SeamLines result;
    result.lines.width = width;
    if (edges.empty()) return result;
    const Sampler map = sampler_of(*scene.map, options.wrap_x, options.wrap_y);
    const SeamSamples samples(part, edges, map.extent(), unpacked(map, scene, options));
    const std::vector<Vector3> gaps = samples.gaps({space.decoder, &space.tangents, true});
    const SeamEvidence evidence = seam_evidence(samples, gaps, map.extent());
    result.scale.title = "seams: mean " + number(evidence.mean) + ", p99 " + number(evidence.p99) + " degrees";
    result.scale.greatest = options.maximum > 0.0f ? static_cast<double>(options.maximum) : round_angle(evidence.p99);

    const auto& places = samples.samples();
    for (std::size_t first = 0; first < places.size();) {
        std::size_t end = first + 1;
        while (end < places.size() && places[end].edge == places[first].edge) ++end;
        const SeamEdge& edge = edges[places[first].edge];
        const auto count = static_cast<double>(end - first);
        for (std::size_t k = first; k < end; ++k) {
            const auto way = static_cast<double>(k - first);
            result.lines.lines.push_back({on_edge(mesh, edge, way / count), on_edge(mesh, edge, (way + 1.0) / count),
                                          code_of(result.scale.color(seam_degrees(gaps[k])))});
        }
        first = end;
    }
    return result;
}

}  // namespace tex::inline v1::render
