// SPDX-License-Identifier: Apache-2.0
// mesh_pictures.h: meshes with their tangents, for tests of preview() with a mesh.

#pragma once

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include <tex/preview.h>

#include "unit/preview_pictures.h"
#include "unit/solids.h"

namespace tex {

// A mesh, and the tangent of each corner.
struct MeshWithTangents {
    MeshPart part;
    std::vector<Float4> tangents;

    [[nodiscard]] TangentSpace space(Decoder decoder = Decoder::gltf) const { return {part, tangents, 0, decoder}; }
};

inline MeshWithTangents with_tangents(MeshPart part, const std::function<Float4(std::uint32_t vertex)>& tangent) {
    MeshWithTangents mesh{std::move(part), {}};
    for (const std::uint32_t v : mesh.part.indices) mesh.tangents.push_back(tangent(v));
    return mesh;
}

// A square in z = 0 with the corners (+-half, +-half), seen from +z, with the whole map on it.
inline MeshWithTangents quad(float half = 0.5f, float w = 1.0f) {
    const auto at = [half](float u, float v) { return Float3{(2.0f * u - 1.0f) * half, (2.0f * v - 1.0f) * half, 0}; };
    MeshPart part = grid_part(1, 1, at, [](float, float) { return Float3{0, 0, 1}; });
    return with_tangents(std::move(part), [w](std::uint32_t) { return Float4{1, 0, 0, w}; });
}

// The sphere of Shape::sphere for a map that is twice as wide as high.
inline MeshWithTangents fine_sphere(int rows) {
    const auto at = [](float u, float v) {
        const double a = 6.283185307179586 * (static_cast<double>(u) - 0.5);
        const double b = 3.141592653589793 * (static_cast<double>(v) - 0.5);
        return Float3{static_cast<float>(std::sin(a) * std::cos(b)), static_cast<float>(std::sin(b)),
                      static_cast<float>(std::cos(a) * std::cos(b))};
    };
    MeshPart part = grid_part(2 * rows, rows, at, at);
    const std::vector<Float2> uvs = part.uvs[0];
    return with_tangents(std::move(part), [&](std::uint32_t v) {
        const double a = 6.283185307179586 * (static_cast<double>(uvs[v].x) - 0.5);
        return Float4{static_cast<float>(std::cos(a)), 0, static_cast<float>(-std::sin(a)), 1};
    });
}

// The picture of a mesh with a map.
inline Texture mesh_picture(const MeshWithTangents& mesh, const MipChain& map, const PreviewOptions& options,
                            const Execution& execution = {}) {
    const TangentSpace space = mesh.space();
    return render_or_fail({.map = &map, .mesh = &space}, options, execution);
}

// From the front, in parallel projection: the pixel of (x, y) of a mesh whose sphere has the radius 1.
inline Pixel front_pixel(const Texture& picture, int size, double x, double y) {
    const auto place = [&](double at) { return static_cast<int>(std::floor((1.06 + at) / 2.12 * size)); };
    return pixel(picture, place(x), place(-y));
}

}  // namespace tex
