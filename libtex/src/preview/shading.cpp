// SPDX-License-Identifier: Apache-2.0

#include "preview/shading.h"

#include <algorithm>
#include <cmath>

namespace tex::inline v1::render {
namespace {

Vec3 vec(const Rgb& color) {
    return {static_cast<double>(color.r), static_cast<double>(color.g), static_cast<double>(color.b)};
}

// Adds z to make a unit vector with these x and y, which are shortened if they are longer than 1.
Vec3 with_z(double x, double y) {
    const double square = x * x + y * y;
    if (square <= 1.0) return {x, y, std::sqrt(1.0 - square)};
    const double n = std::sqrt(square);
    return {x / n, y / n, 0.0};
}

}  // namespace

Illumination illumination(const PreviewOptions& options) {
    Illumination with;
    with.point_light = options.light.kind == LightKind::point;
    const Vec3 light{static_cast<double>(options.light.x), static_cast<double>(options.light.y),
                     static_cast<double>(options.light.z)};
    with.light = with.point_light ? light : normalize(light);
    with.color = vec(options.light.color);
    with.ambient = vec(options.ambient);
    with.specular = vec(options.material.specular);
    with.shininess = static_cast<double>(options.material.shininess);
    with.model = options.material.model;
    return with;
}

Vec3 shade(const Illumination& with, Vec3 point, Vec3 normal, Vec3 view, Vec3 albedo) {
    Vec3 to_light = with.light;
    double attenuation = 1.0;
    if (with.point_light) {
        const Vec3 way = with.light - point;
        attenuation = 1.0 / std::max(length(way), 1e-6);
        to_light = normalize(way);
    }
    const double facing = dot(normal, to_light);
    double specular = 0.0;
    if (facing >= 0.0) {
        const double cosine = with.model == SpecularModel::phong ? dot(normal * (2.0 * facing) - to_light, view)
                                                                 : dot(normal, normalize(to_light + view));
        if (cosine > 0.0) specular = math::pow(cosine, with.shininess);
    }
    const Vec3 reflected = albedo * std::max(0.0, facing) + with.specular * specular;
    return times(with.ambient, albedo) + times(with.color, reflected) * attenuation;
}

Vec3 unpack_normal(Vec3 sampled, bool without_z, double scale, ScaleMode mode) {
    const double s = mode == ScaleMode::xy ? scale : 1.0;
    Vec3 n;
    if (without_z || (mode == ScaleMode::xy && scale != 1.0)) {
        if (!without_z) sampled = normalize(sampled);
        n = with_z(sampled.x * s, sampled.y * s);
    } else {
        n = normalize({sampled.x, sampled.y, std::max(sampled.z, 0.0)});
    }
    if (mode == ScaleMode::slope && scale != 1.0) n = normalize({n.x * scale, n.y * scale, n.z});
    return n;
}

Vec3 blend_whiteout(Vec3 base, Vec3 detail) {
    return normalize({base.x + detail.x, base.y + detail.y, base.z * detail.z});
}

}  // namespace tex::inline v1::render
