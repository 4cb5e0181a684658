// SPDX-License-Identifier: Apache-2.0
// html_mesh.h: the triangles of a mesh for a page, as the reader's GPU draws them.

#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <tex/mesh.h>

#include "cli/json.h"

namespace tex::cli {

// The most characters that the meshes of a page may take, each counted once: about 200,000 triangles with smooth
// normals.
inline constexpr std::size_t kHtmlMeshBudget = 8'000'000;

// Vertices, then the triangles' indices: little-endian, and ready for WebGL. A vertex has kHtmlVertexSize bytes:
//
//   position   3 x int16   in the sphere of preview.h, whose radius is 32767: 1/60 of a pixel in a picture of 1024
//   normal     3 x int16   unit, times 32767 (or 0): 0.002 degrees. 8 bits would be 0.3 degrees, which a light shows
//   tangent    4 x int16   the same, and w
//   uv         2 x float   v down. 16 bits would be too few: charts may repeat, and large maps have 8192 texels
//
// Corners with the same vertex share it. Indices are uint16 if there are at most 65535 vertices, else uint32.
struct HtmlMesh {
    std::string arguments;  // --mesh and the options that choose its parts, as a shell reads them
    Decoder decoder = Decoder::gltf;
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    std::vector<std::byte> bytes;
    // Where the page draws it: at x, y, z in the sphere of another mesh, with its radius as a part of that one's.
    std::array<double, 4> place = {0.0, 0.0, 0.0, 1.0};

    // The number of characters that the bytes take in a page.
    [[nodiscard]] std::size_t size() const;
    // The data that the page's script needs besides the bytes.
    [[nodiscard]] Json json() const;
    friend bool operator==(const HtmlMesh&, const HtmlMesh&) = default;
};

inline constexpr std::size_t kHtmlVertexSize = 28;

// The mesh for a page, or null if it alone would take more than kHtmlMeshBudget. Depends on the arguments alone.
// Precondition: preview() accepts the space.
[[nodiscard]] std::shared_ptr<const HtmlMesh> html_mesh(const TangentSpace& space, std::string arguments);

// The mesh for a page that draws it as it lies beside another one: both have the same scale.
[[nodiscard]] std::shared_ptr<const HtmlMesh> html_mesh_beside(const TangentSpace& space, const MeshPart& other);

}  // namespace tex::cli
