// SPDX-License-Identifier: Apache-2.0

#include "reference/wikibook_shader.h"

#include <algorithm>
#include <cmath>

namespace tex::reference {
namespace {

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vec3 normalize(const Vec3& a) {
    const double n = std::sqrt(dot(a, a));
    return {a[0] / n, a[1] / n, a[2] / n};
}

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

// reflect() of GLSL: the incident vector i mirrored at the surface with normal n.
Vec3 reflect(const Vec3& i, const Vec3& n) {
    const double twice = 2.0 * dot(n, i);
    return {i[0] - twice * n[0], i[1] - twice * n[1], i[2] - twice * n[2]};
}

}  // namespace

Vec3 light_bumpy_surface(const ShaderInput& in) {
    Vec3 normal_direction{};
    for (std::size_t k = 0; k < 3; ++k) {
        normal_direction[k] = in.local_coords[0] * in.tangent[k] + in.local_coords[1] * in.binormal[k] +
                              in.local_coords[2] * in.normal[k];
    }
    normal_direction = normalize(normal_direction);
    const Vec3 view_direction = normalize(in.parallel_view ? in.camera : minus(in.camera, in.position));

    Vec3 light_direction = normalize(in.light);
    double attenuation = 1.0;
    if (in.point_light) {
        const Vec3 vertex_to_light_source = minus(in.light, in.position);
        attenuation = 1.0 / std::sqrt(dot(vertex_to_light_source, vertex_to_light_source));
        light_direction = normalize(vertex_to_light_source);
    }

    double power = 0.0;
    if (dot(normal_direction, light_direction) >= 0.0) {
        double cosine = dot(reflect({-light_direction[0], -light_direction[1], -light_direction[2]}, normal_direction),
                            view_direction);
        if (in.blinn) {
            const Vec3 sum{light_direction[0] + view_direction[0], light_direction[1] + view_direction[1],
                           light_direction[2] + view_direction[2]};
            cosine = dot(normal_direction, normalize(sum));
        }
        power = std::pow(std::max(0.0, cosine), in.shininess);
    }
    Vec3 color{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double ambient_lighting = in.ambient[k] * in.diffuse_color[k];
        const double diffuse_reflection = attenuation * in.light_color[k] * in.diffuse_color[k] *
                                          std::max(0.0, dot(normal_direction, light_direction));
        const double specular_reflection = attenuation * in.light_color[k] * in.specular_color[k] * power;
        color[k] = ambient_lighting + diffuse_reflection + specular_reflection;
    }
    return color;
}

double parallax_offset(double parallax, double height, double view_xy, double view_z, double max_offset) {
    const double raised = parallax * (-0.5 + height);
    return std::clamp(raised * view_xy / view_z, -max_offset, max_offset);
}

double encode_srgb(double linear) {
    linear = std::clamp(linear, 0.0, 1.0);
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

}  // namespace tex::reference
