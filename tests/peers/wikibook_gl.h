// SPDX-License-Identifier: Apache-2.0
// wikibook_gl.h: the shaders of GLSL Programming in Unity, run by Mesa's software OpenGL.

#pragma once

#include <array>
#include <vector>

#include <tex/types.h>

namespace peers {

using Vec3 = std::array<float, 3>;

struct GlScene {
    tex::Extent picture;
    const tex::MipChain* map = nullptr;         // x in alpha and y in green, as Unity stores them; 32-bit floats
    const tex::Plane<float>* height = nullptr;  // or none: no parallax
    float parallax = 0.0f, parallax_limit = 0.0f;
    Vec3 eye, right, up, toward;  // the camera looks along -toward
    float slope = 0.0f;           // tan(field of view / 2)
    Vec3 tangent = {1, 0, 0};
    float tangent_w = 1.0f;   // -1 where the UVs are mirrored
    float half_width = 1.0f;  // of the plane, which is 2 high
    Vec3 light;
    bool point_light = false;
    Vec3 light_color, ambient, diffuse, specular;
    float shininess = 10.0f;
};

// RGBA of the picture, rows from the top: sRGB values, and 1 in A where the plane was drawn. Empty where OpenGL
// reported an error.
std::vector<float> draw_wikibook_plane(const GlScene& scene);

}  // namespace peers
