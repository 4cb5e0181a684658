// SPDX-License-Identifier: Apache-2.0

#include "preview/mesh_shows.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "preview/canvas.h"
#include "preview/legend.h"
#include "preview/mesh_renderer.h"
#include "preview/seam_lines.h"
#include "preview/shading.h"
#include "preview/tangent_lines.h"
#include "preview/uv_layout.h"

namespace tex::inline v1::render {
namespace {

// The mesh without the map, so that lines stand out.
constexpr Vec3 kBareAlbedo{0.25, 0.25, 0.25};

Result<Texture> draw_bare(const Stage& stage, const PreviewOptions& options, const MeshLines& lines,
                          const Execution& execution) {
    Illumination with = illumination(options);
    with.light = stage.light;
    with.specular = {};
    with.ambient = {0.35, 0.35, 0.35};
    return render_mesh(
        stage, Space::linear,
        [&](const Hit& hit, const Footprint&) {
            const Vec3 view = normalize(stage.view.towards_viewer(hit.point));
            return shade(with, hit.point, normalize(hit.normal), view, kBareAlbedo);
        },
        lines, execution);
}

Result<Texture> show_tangents(const PreviewScene&, const PreviewOptions& options, const Stage& stage,
                              const Execution& execution) {
    const MeshLines lines = tangent_lines(*stage.mesh, stage.view, 1.5 * text_scale(stage.size.width));
    auto picture = draw_bare(stage, options, lines, execution);
    if (!picture || !options.legend) return picture;
    return with_key(std::move(*picture),
                    {{"tangent", kTangentColor}, {"binormal", kBinormalColor}, {"normal", kNormalColor}});
}

Result<Texture> show_uvs(const PreviewScene& scene, const PreviewOptions& options, const Stage& stage,
                         const Execution& execution) {
    return uv_layout(*stage.mesh, scene, options, stage.size, execution);
}

Result<Texture> show_seams(const PreviewScene& scene, const PreviewOptions& options, const Stage& stage,
                           const Execution& execution) {
    const SeamLines seams = seam_lines(*stage.mesh, scene, options, 2.5 * text_scale(stage.size.width));
    auto picture = draw_bare(stage, options, seams.lines, execution);
    if (!picture || !options.legend) return picture;
    if (seams.lines.lines.empty()) return with_key(std::move(*picture), {{"no UV seams", kInk}});
    return with_legend(std::move(*picture), seams.scale);
}

struct MeshPicture {
    Show show;
    Result<Texture> (*draw)(const PreviewScene& scene, const PreviewOptions& options, const Stage& stage,
                            const Execution& execution);
};
constexpr MeshPicture kMeshPictures[] = {
    {Show::tangents, show_tangents},
    {Show::uv, show_uvs},
    {Show::seams, show_seams},
};

const MeshPicture* picture_of(Show show) {
    const auto* const row = std::find_if(std::begin(kMeshPictures), std::end(kMeshPictures),
                                         [show](const MeshPicture& picture) { return picture.show == show; });
    return row == std::end(kMeshPictures) ? nullptr : row;
}

}  // namespace

Result<Texture> show_mesh(const PreviewScene& scene, const PreviewOptions& options, const Stage& stage,
                          const Execution& execution) {
    return picture_of(options.show)->draw(scene, options, stage, execution);
}

}  // namespace tex::inline v1::render

namespace tex::inline v1 {

bool needs_mesh(Show show) { return render::picture_of(show) != nullptr; }

}  // namespace tex::inline v1
