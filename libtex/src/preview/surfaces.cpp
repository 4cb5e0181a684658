// SPDX-License-Identifier: Apache-2.0

#include "preview/surfaces.h"

#include "preview/parallax.h"
#include "threads/parallel.h"

namespace tex::inline v1::render {
namespace {

std::optional<std::vector<PlaneView<const float>>> colors_of(const Image& image) {
    const int r = image.find("R"), g = image.find("G"), b = image.find("B");
    const auto plane = [&](int index) { return image.planes[static_cast<std::size_t>(index)].view(); };
    if (r >= 0 && g >= 0 && b >= 0) return std::vector{plane(r), plane(g), plane(b)};
    // Grey, with or without alpha.
    const int alpha = image.find("A");
    if (image.planes.size() == 1 || (image.planes.size() == 2 && alpha >= 0))
        return std::vector{plane(alpha == 0 ? 1 : 0)};
    return std::nullopt;
}

// Unity's unity_ColorSpaceDouble for linear light, 2^2.2, with which a detail albedo of sRGB grey 0.5 changes nothing.
constexpr double kColorSpaceDouble = 4.59479380;

Vec3 vec(const Sample& s) { return {s[0], s[1], s[2]}; }

Vec3 color_at(const Sampler& sampler, Vec2 uv, const Footprint& footprint, int anisotropy) {
    const Sample s = sample(sampler, uv, footprint, anisotropy);
    return sampler.channels == 1 ? Vec3{s[0], s[0], s[0]} : vec(s);
}

}  // namespace

Result<Textures> Textures::prepare(const PreviewScene& scene, const PreviewOptions& options,
                                   const Execution& execution) {
    Textures textures;
    textures.map = sampler_of(*scene.map, options.wrap_x, options.wrap_y);
    if (options.show == Show::plain) return textures;
    if (scene.detail != nullptr) textures.detail = sampler_of(*scene.detail, options.wrap_x, options.wrap_y);
    const auto colors = [&](const Image* image, std::optional<Pyramid>& pyramid, Sampler& sampler,
                            const Execution& step) -> Result<void> {
        if (image == nullptr) return {};
        const auto planes = colors_of(*image);
        if (!planes)
            return Error{ErrorCode::bad_option, {}, "an albedo has neither channels R, G and B nor a single one"};
        auto built = Pyramid::build(*planes, step);
        if (!built) return built.error();
        pyramid = std::move(*built);
        sampler = pyramid->sampler(options.wrap_x, options.wrap_y);
        return {};
    };
    if (auto done = colors(scene.albedo, textures.albedo_, textures.albedo, part_of(execution, 0.0, 0.5)); !done)
        return done.error();
    if (auto done =
            colors(scene.detail_albedo, textures.detail_albedo_, textures.detail_albedo, part_of(execution, 0.5, 0.8));
        !done) {
        return done.error();
    }
    const auto values = [&](const Plane<float>* plane, std::optional<Pyramid>& pyramid, Sampler& sampler,
                            const Execution& step) -> Result<void> {
        if (plane == nullptr) return {};
        auto built = Pyramid::build({plane->view()}, step);
        if (!built) return built.error();
        pyramid = std::move(*built);
        sampler = pyramid->sampler(options.wrap_x, options.wrap_y);
        return {};
    };
    if (auto done = values(scene.height, textures.height_, textures.height, part_of(execution, 0.8, 0.9)); !done)
        return done.error();
    auto done = values(scene.occlusion, textures.occlusion_, textures.occlusion, part_of(execution, 0.9, 1.0));
    if (!done) return done.error();
    return textures;
}

LitSurface::LitSurface(const Textures& textures, const PreviewScene& scene, const PreviewOptions& options,
                       const Stage& stage)
    : textures_(textures), scene_(scene), options_(options), stage_(stage), with_(illumination(options)) {
    with_.light = stage.light;
}

Vec3 LitSurface::linear_light(const Hit& hit, const Footprint& footprint) const {
    const Hit seen = displaced(hit, footprint);
    const Vec3 view = normalize(stage_.view.towards_viewer(hit.point));
    if (textures_.occlusion.empty())
        return shade(with_, hit.point, normal(seen, footprint), view, albedo(seen.uv, footprint));
    Illumination occluded = with_;
    occluded.ambient = with_.ambient * sample(textures_.occlusion, seen.uv, footprint, options_.anisotropy)[0];
    return shade(occluded, hit.point, normal(seen, footprint), view, albedo(seen.uv, footprint));
}

Vec3 LitSurface::normal(const Hit& hit, const Footprint& footprint) const {
    const Vec3 n = tangent_normal(hit.uv, footprint);
    return normalize(hit.tangent * n.x + hit.binormal * n.y + hit.normal * n.z);
}

// The hit with the texture coordinates after parallax.
Hit LitSurface::displaced(const Hit& hit, const Footprint& footprint) const {
    Hit seen = hit;
    if (textures_.height.empty() || options_.parallax.amount == 0.0f) return seen;
    const Vec3 way = stage_.view.towards_viewer(hit.point);
    const Vec3 view{dot(way, hit.tangent), dot(way, hit.binormal), dot(way, hit.normal)};
    const Relief relief{textures_.height, static_cast<double>(scene_.white)};
    seen.uv = hit.uv + parallax_offset(options_.parallax, relief, hit.uv, footprint, view, options_.anisotropy);
    return seen;
}

Vec3 LitSurface::tangent_normal(Vec2 uv, const Footprint& footprint) const {
    const int anisotropy = options_.anisotropy;
    const Vec3 base = unpack_normal(vec(sample(textures_.map, uv, footprint, anisotropy)), reconstructs_z(scene_),
                                    static_cast<double>(options_.bump_scale), options_.scale_mode);
    if (textures_.detail.empty()) return base;
    const Sample fetched = sample(textures_.detail, detail_place(uv), detail_area(footprint), anisotropy);
    const Vec3 fine = unpack_normal(vec(fetched), scene_.detail_without_z, static_cast<double>(options_.detail.scale),
                                    options_.scale_mode);
    return blend_whiteout(base, fine);
}

Vec2 LitSurface::detail_place(Vec2 uv) const {
    const Detail& detail = options_.detail;
    return {uv.x * static_cast<double>(detail.tiling_x) + static_cast<double>(detail.offset_x),
            uv.y * static_cast<double>(detail.tiling_y) + static_cast<double>(detail.offset_y)};
}

Footprint LitSurface::detail_area(const Footprint& footprint) const {
    const double x = options_.detail.tiling_x, y = options_.detail.tiling_y;
    return {{footprint.dx.x * x, footprint.dx.y * y}, {footprint.dy.x * x, footprint.dy.y * y}};
}

Vec3 LitSurface::albedo(Vec2 uv, const Footprint& footprint) const {
    const Rgb& tint = options_.material.albedo;
    Vec3 color{static_cast<double>(tint.r), static_cast<double>(tint.g), static_cast<double>(tint.b)};
    if (!textures_.albedo.empty()) color = times(color, color_at(textures_.albedo, uv, footprint, options_.anisotropy));
    if (!textures_.detail_albedo.empty()) {
        const Vec3 fine =
            color_at(textures_.detail_albedo, detail_place(uv), detail_area(footprint), options_.anisotropy);
        color = times(color, fine * kColorSpaceDouble);
    }
    return color;
}

}  // namespace tex::inline v1::render
