// SPDX-License-Identifier: Apache-2.0

#include <tex/preview.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "fields/field_check.h"
#include "fields/preview_fields.h"
#include "mesh/frames.h"
#include "preview/canvas.h"
#include "preview/measures.h"
#include "preview/mesh_body.h"
#include "preview/mesh_shows.h"
#include "preview/surfaces.h"
#include "rows/usable.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

using namespace render;

constexpr int kLargestDefault = 1024;
constexpr int kDefaultSize = 512;
constexpr int kLargestSize = 16384;

Error bad(std::string reason) { return {ErrorCode::bad_option, {}, std::move(reason)}; }

bool finite(std::initializer_list<float> values) {
    return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

bool not_negative(const Rgb& c) { return finite({c.r, c.g, c.b}) && c.r >= 0.0f && c.g >= 0.0f && c.b >= 0.0f; }

Result<void> check_light(const PreviewOptions& o) {
    if (o.light.kind == LightKind::directional && o.light.x == 0.0f && o.light.y == 0.0f && o.light.z == 0.0f) {
        return bad("the direction to the light has no length");
    }
    if (!not_negative(o.light.color) || !not_negative(o.ambient) || !not_negative(o.material.albedo) ||
        !not_negative(o.material.specular)) {
        return bad("a colour is below 0 or not finite");
    }
    return {};
}

Result<void> check_size(const PreviewOptions& o) {
    const auto outside = [](int value, int least) { return value < least || value > kLargestSize; };
    const bool chosen = o.size.width == 0 && o.size.height == 0;
    if (!chosen && (outside(o.size.width, 1) || outside(o.size.height, 0)))
        return bad("a picture is 1 to 16384 pixels wide and high");
    return {};
}

Extent size_of(const PreviewOptions& options, Extent map) {
    if (options.size.height > 0) return options.size;
    double w = 1.0, h = 1.0, longer = kDefaultSize;
    if (options.shape == Shape::plane) {
        w = static_cast<double>(map.width) * options.tiles_x;
        h = static_cast<double>(map.height) * options.tiles_y;
        longer = std::min(std::max(w, h), static_cast<double>(kLargestDefault));
    }
    if (options.size.width > 0) longer = options.size.width;
    const double scale = longer / std::max(w, h);
    const auto rounded = [&](double side) { return std::max(1, static_cast<int>(std::floor(side * scale + 0.5))); };
    return {rounded(w), rounded(h)};
}

// The data that all pictures of one call share.
struct Job {
    const PreviewScene& scene;
    const PreviewOptions& options;
    const Execution& execution;
    Stage stage;

    [[nodiscard]] const NormalMap& base() const { return scene.map->levels.front(); }
    [[nodiscard]] Result<Texture> finish(Texture picture, const ColorScale& scale) const {
        return options.legend ? with_legend(std::move(picture), scale) : std::move(picture);
    }
};

Result<Texture> show_lit(const Job& job) {
    const auto textures = Textures::prepare(job.scene, job.options, part_of(job.execution, 0.0, 0.2));
    if (!textures) return textures.error();
    const LitSurface surface(*textures, job.scene, job.options, job.stage);
    const Execution drawing = part_of(job.execution, 0.2, 1.0);
    if (job.options.show != Show::world_normals) {
        return render::render(
            job.stage, Space::linear,
            [&](const Hit& hit, const Footprint& footprint) { return surface.linear_light(hit, footprint); }, drawing);
    }
    return render::render(
        job.stage, Space::display,
        [&](const Hit& hit, const Footprint& footprint) {
            const Vec3 n = job.stage.to_world(surface.normal(hit, footprint));
            return (n + Vec3{1.0, 1.0, 1.0}) * 0.5;
        },
        drawing);
}

Result<Texture> show_colors(const Job& job) {
    const Sampler map = sampler_of(*job.scene.map, job.options.wrap_x, job.options.wrap_y);
    return render::render(
        job.stage, Space::display,
        [&](const Hit& hit, const Footprint& footprint) {
            const Sample n = sample(map, hit.uv, footprint, job.options.anisotropy);
            return (Vec3{n[0], n[1], n[2]} + Vec3{1.0, 1.0, 1.0}) * 0.5;
        },
        job.execution);
}

Result<Texture> show_plane(const Job& job, PlaneView<const float> values, const ColorScale& scale,
                           const Execution& execution) {
    const auto pyramid = Pyramid::build({values}, part_of(execution, 0.0, 0.2));
    if (!pyramid) return pyramid.error();
    const Sampler sampler = pyramid->sampler(job.options.wrap_x, job.options.wrap_y);
    auto picture = render::render(
        job.stage, Space::display,
        [&](const Hit& hit, const Footprint& footprint) {
            return scale.color(sample(sampler, hit.uv, footprint, job.options.anisotropy)[0]);
        },
        part_of(execution, 0.2, 1.0));
    if (!picture) return picture.error();
    return job.finish(std::move(*picture), scale);
}

Result<Texture> show_measure(const Job& job) {
    const auto found = measure(job.options, job.base(), part_of(job.execution, 0.0, 0.3));
    if (!found) return found.error();
    return show_plane(job, found->values.view(), found->scale, part_of(job.execution, 0.3, 1.0));
}

Result<Texture> show_channels(const Job& job) {
    std::vector<Panel> panels;
    const NormalMap& map = job.base();
    const std::pair<const Plane<float>&, ColorScale> channels[] = {
        {map.x, {"x, right", -1.0, 1.0, Palette::diverging}},
        {map.y, {"y, up", -1.0, 1.0, Palette::diverging}},
        {map.z, {"z, out", 0.0, 1.0, Palette::viridis}},
    };
    for (const auto& [plane, scale] : channels) {
        const double k = static_cast<double>(panels.size());
        auto picture = show_plane(job, plane.view(), scale, part_of(job.execution, k / 3.0, (k + 1.0) / 3.0));
        if (!picture) return picture.error();
        panels.push_back({std::move(*picture), {}});
    }
    return contact_sheet(panels, 3);
}

Result<Texture> show_height(const Job& job) {
    if (job.scene.height == nullptr) return bad("there is no height map to show");
    const Plane<float>& height = *job.scene.height;
    float least = height.at(0, 0), greatest = least;
    for (int j = 0; j < height.extent().height; ++j) {
        const auto [low, high] = std::minmax_element(height.row(j), height.row(j) + height.extent().width);
        least = std::min(least, *low);
        greatest = std::max(greatest, *high);
    }
    return show_plane(job, height.view(),
                      {"height, texels", static_cast<double>(least), static_cast<double>(greatest), Palette::grey},
                      job.execution);
}

void draw_level(Canvas& canvas, int x, int y, const NormalMap& level) {
    const auto code = [](float component) { return display_code((static_cast<double>(component) + 1.0) * 0.5); };
    for (int j = 0; j < level.extent().height; ++j) {
        for (int i = 0; i < level.extent().width; ++i) {
            canvas.set(x + i, y + j, {code(level.x.at(i, j)), code(level.y.at(i, j)), code(level.z.at(i, j))});
        }
    }
}

// Shows the first level that fits into the picture's size on the left, the other levels in a column beside it, and a
// line of text below.
Result<Texture> show_mips(const Job& job) {
    constexpr int kGap = 4;
    constexpr int kLine = 18;
    const std::vector<NormalMap>& levels = job.scene.map->levels;
    const auto fits = [&](Extent extent) {
        return extent.width <= job.stage.size.width && extent.height <= job.stage.size.height;
    };
    std::size_t first = 0;
    while (first + 1 < levels.size() && !fits(levels[first].extent())) ++first;
    const Extent largest = levels[first].extent();
    int column = 0, below = 0;
    for (std::size_t k = first + 1; k < levels.size(); ++k) {
        column = std::max(column, levels[k].extent().width);
        below += levels[k].extent().height + kGap;
    }
    const int width = largest.width + (column > 0 ? kGap + column : 0), height = std::max(largest.height, below - kGap);
    const int scale = text_scale(width);
    Canvas canvas({width, height + (job.options.legend ? kLine * scale : 0)});
    draw_level(canvas, 0, 0, levels[first]);
    int y = 0;
    for (std::size_t k = first + 1; k < levels.size(); ++k) {
        draw_level(canvas, largest.width + kGap, y, levels[k]);
        y += levels[k].extent().height + kGap;
    }
    const auto name = [&](std::size_t k) {
        return std::to_string(levels[k].extent().width) + "x" + std::to_string(levels[k].extent().height);
    };
    const std::string words = "levels " + std::to_string(first) + " to " + std::to_string(levels.size() - 1) + ": " +
                              name(first) + " to " + name(levels.size() - 1);
    if (job.options.legend) canvas.text(kGap, height + 5 * scale, scale, fitted(words, scale, width - 2 * kGap));
    return std::move(canvas).take();
}

// The pictures that are neither of a mesh nor false colours of a measure.
struct Picture {
    Show show;
    Result<Texture> (*draw)(const Job& job);
};
constexpr Picture kPictures[] = {
    {Show::lit, show_lit},        {Show::plain, show_lit},         {Show::world_normals, show_lit},
    {Show::normals, show_colors}, {Show::channels, show_channels}, {Show::mips, show_mips},
    {Show::height, show_height},
};

Result<Texture> show(const Job& job) {
    if (needs_mesh(job.options.show)) return show_mesh(job.scene, job.options, job.stage, job.execution);
    for (const Picture& picture : kPictures) {
        if (picture.show == job.options.show) return picture.draw(job);
    }
    return show_measure(job);
}

}  // namespace

Result<void> validate(const PreviewOptions& options) {
    return first_error(check_light(options), check_size(options), check_fields(options));
}

Result<Texture> preview(const PreviewScene& scene, const PreviewOptions& options, const Execution& execution) {
    return no_throw(execution, [&]() -> Result<Texture> {
        if (scene.map == nullptr) return bad("there is no map to show");
        if (auto usable = check_usable(*scene.map); !usable) return usable.error();
        if (auto valid = validate(options); !valid) return valid.error();
        if (!(scene.white > 0.0f) || !finite({scene.white})) return bad("the height of white must be above 0");
        const Extent map = scene.map->levels.front().extent();
        if (scene.mesh == nullptr) {
            if (needs_mesh(options.show)) return bad("there is no mesh to show");
            return show({scene, options, execution, stage(options, nullptr, map, size_of(options, map))});
        }
        if (auto sound = check_part(scene.mesh->part); !sound) return sound.error().of(scene.mesh->file);
        if (const auto sound = check_space(*scene.mesh); !sound) return sound.error().of(scene.mesh->file);
        const MeshBody mesh(*scene.mesh);
        PreviewOptions of_mesh = options;
        of_mesh.shape = options.show == Show::uv ? Shape::plane : Shape::sphere;
        of_mesh.tiles_x = of_mesh.tiles_y = 1;
        const Extent size = size_of(of_mesh, map);
        auto picture = show({scene, of_mesh, execution, stage(of_mesh, &mesh, map, size)});
        if (!picture && picture.error().file.empty() && picture.error().code == ErrorCode::unsupported)
            return picture.error().of(scene.mesh->file);
        return picture;
    });
}

}  // namespace tex::inline v1
