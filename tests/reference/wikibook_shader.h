// SPDX-License-Identifier: Apache-2.0
// wikibook_shader.h: the fragment shaders of GLSL/Cg Programming in Unity, translated statement by statement to double
// and <cmath>.

#pragma once

#include <array>

namespace tex::reference {

using Vec3 = std::array<double, 3>;

struct ShaderInput {
    Vec3 local_coords;  // the normal in the tangent frame, unpacked
    Vec3 tangent, binormal, normal;
    Vec3 position, camera;  // camera: a position, or a direction if `parallel_view`
    bool parallel_view = false;
    Vec3 light;
    bool point_light = false;
    Vec3 light_color, ambient, diffuse_color, specular_color;
    double shininess = 10.0;
    bool blinn = false;
};

// "Lighting of Bumpy Surfaces", fragWithAmbient: linear red, green, blue.
Vec3 light_bumpy_surface(const ShaderInput& in);

// "Projection of Bumpy Surfaces": the texture coordinate offset for a height, on one axis.
double parallax_offset(double parallax, double height, double view_xy, double view_z, double max_offset);

// sRGB value of linear light, both 0 to 1 (IEC 61966-2-1), clamped.
double encode_srgb(double linear);

}  // namespace tex::reference
