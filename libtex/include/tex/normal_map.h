// SPDX-License-Identifier: Apache-2.0
// normal_map.h: tangent-space normals in memory.
//
// x points right, y points *up* (towards the top row: OpenGL and Unity; "+Y"), z points out of the surface. Components
// are in [-1, 1], vectors have unit length, z >= 0. In files y may point down (DirectX, "-Y"): only pack() and unpack()
// flip it.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>

#include <tex/image.h>
#include <tex/names.h>

#pragma GCC visibility push(default)
namespace tex {

// The direction of green in a file.
enum class YAxis { up, down };

inline constexpr Named<YAxis> kYAxisNames[] = {
    {YAxis::up, "up", "+Y: OpenGL, Unity, Blender, glTF"},
    {YAxis::down, "down", "-Y: DirectX, Unreal"},
};

// Three planes of one extent. The constructor takes them from one piece of memory, equally far apart, so that all three
// can be seen as one array of rows, columns and components. Memory is released with the last plane.
//
// `blue`, `alpha` and `length` are other data that a texture holds beside the normals: heights, occlusion, roughness, a
// mask. They are empty, or have the extent of the normals and values from 0 to 1. pack() stores `alpha` in A and `blue`
// in B instead of z, so that whoever reads the texture must reconstruct z. `length` is occlusion c (1 where nothing
// occludes), stored as the length of the vector:
//
//     length = 0.5 + 0.5 sqrt(c), c = clamp(2 length - 1, 0, 1)^2     (Terrain3D for Godot, pull request 868, 2025)
//
// unpack() finds all of them again; build_mip_chain() averages them (OtherKind; `length` as occlusion). scale() and the
// conversions of convert.h leave them as they are. blend() keeps those of the base, sampled as its normals are. Other
// verbs ignore them.
struct NormalMap {
    Plane<float> x;
    Plane<float> y;
    Plane<float> z;
    Plane<float> blue;
    Plane<float> alpha;
    Plane<float> length;

    NormalMap() = default;
    explicit NormalMap(Extent extent) {
        // Between two planes are a few lines of the cache. Otherwise the same texel of all three would often compete
        // for the same lines.
        constexpr std::ptrdiff_t kGap = 4 * static_cast<std::ptrdiff_t>(kRowAlignment / sizeof(float));
        const std::ptrdiff_t stride = padded_stride<float>(extent.width);
        const std::ptrdiff_t step = stride * extent.height + kGap;
        const std::shared_ptr<void> memory = allocate_rows(static_cast<std::size_t>(3 * step - kGap) * sizeof(float));
        float* rows = static_cast<float*>(memory.get());
        for (Plane<float>* plane : {&x, &y, &z}) {
            *plane = Plane<float>(extent, stride, std::shared_ptr<float>(memory, rows));
            plane->clear_padding();
            rows += step;
        }
    }
    [[nodiscard]] Extent extent() const { return x.extent(); }
};

// The effect of a bump scale s on a normal.
//
//   slope    normalize(s x, s y, z), as scaling the height by s does; glTF, Unity's SRP
//   xy       (s x, s y, reconstruct_z(s x, s y)): Catlike Coding, Rendering 6, 2.3 (UnpackScaleNormal); if s x and s y
//            leave the unit circle, they are divided by their length and z is 0
//
// For a normal tilted by 32 degrees, the results differ by 2 degrees at s = 0.5 and by 39 degrees at s = 2.
enum class ScaleMode { slope, xy };

inline constexpr Named<ScaleMode> kScaleModeNames[] = {
    {ScaleMode::slope, "slope", "multiply the slopes, as scaling the height does"},
    {ScaleMode::xy, "xy", "multiply x and y, then reconstruct z, as UnpackScaleNormal does"},
};

// z of the unit vector with the given x and y: sqrt(1 - saturate(x^2 + y^2)). Because of the clamp, the result is 0 and
// not NaN if quantisation made x^2 + y^2 greater than 1. (Catlike Coding, Rendering 6, 2.2.)
[[nodiscard]] inline float reconstruct_z(float x, float y) {
    return std::sqrt(1.0f - std::min(std::max(x * x + y * y, 0.0f), 1.0f));
}

// The cheap approximation 1 - (x^2 + y^2) / 2 (GLSL/Cg Programming in Unity, Lighting of Bumpy Surfaces), for
// comparison: it is 0.5 where the true z is 0.
[[nodiscard]] inline float reconstruct_z_approximate(float x, float y) { return 1.0f - (x * x + y * y) / 2.0f; }

}  // namespace tex
#pragma GCC visibility pop
