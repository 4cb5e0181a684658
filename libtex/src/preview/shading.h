// SPDX-License-Identifier: Apache-2.0
// shading.h: computes the light that a point of the surface sends to the viewer.

#pragma once

#include <tex/preview.h>

#include "preview/vector.h"

namespace tex::inline v1::render {

// Light and material of PreviewOptions, as doubles; red, green and blue are the x, y and z of a Vec3.
struct Illumination {
    bool point_light = false;
    Vec3 light;  // unit direction, or position
    Vec3 color;
    Vec3 ambient;
    Vec3 specular;
    double shininess = 1.0;
    SpecularModel model = SpecularModel::phong;
};

[[nodiscard]] Illumination illumination(const PreviewOptions& options);

// The lighting formula of preview() for a unit `normal` at `point`; `view` is unit.
[[nodiscard]] Vec3 shade(const Illumination& with, Vec3 point, Vec3 normal, Vec3 view, Vec3 albedo);

// Unpacks a sampled normal as a shader does: reconstructs z if the texture has none, otherwise normalises; then scales.
// z < 0 becomes 0.
[[nodiscard]] Vec3 unpack_normal(Vec3 sampled, bool without_z, double scale, ScaleMode mode);

// Whiteout: normalize(n1.xy + n2.xy, n1.z n2.z) (Oat 2007).
[[nodiscard]] Vec3 blend_whiteout(Vec3 base, Vec3 detail);

}  // namespace tex::inline v1::render
