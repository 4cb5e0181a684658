// SPDX-License-Identifier: Apache-2.0

#include "preview/tangent_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "preview/mesh_body.h"

namespace tex::inline v1::render {
namespace {

constexpr std::size_t kMostVertices = 4096;
constexpr double kShortest = 0.03, kLongest = 0.15;
constexpr double kOffset = 0.1;  // in lengths of the lines

double mean_edge(const MeshBody& mesh) {
    double sum = 0.0;
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        const auto [a, b, c] = mesh.corners(t);
        sum += length(b - a) + length(c - b) + length(a - c);
    }
    return sum / (3.0 * static_cast<double>(mesh.triangles()));
}

bool same(const Float4& a, const Float4& b) { return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w; }

// Corners of triangles that face the viewer: one for each tangent of each vertex (more if they alternate).
std::vector<std::size_t> corners_to_show(const MeshBody& mesh, const View& view) {
    constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    const TangentSpace& space = mesh.space();
    std::vector<std::size_t> latest(space.part.positions.size(), kNone), shown;
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        if (!mesh.faces(t, view)) continue;
        for (std::size_t corner = 3 * t; corner < 3 * t + 3; ++corner) {
            std::size_t& last = latest[space.part.indices[corner]];
            if (last != kNone && same(space.tangents[last], space.tangents[corner])) continue;
            last = corner;
            shown.push_back(corner);
        }
    }
    if (shown.size() <= kMostVertices) return shown;
    std::vector<std::size_t> spread;
    for (std::size_t k = 0; k < kMostVertices; ++k) spread.push_back(shown[k * shown.size() / kMostVertices]);
    return spread;
}

}  // namespace

MeshLines tangent_lines(const MeshBody& mesh, const View& view, double width) {
    const TangentSpace& space = mesh.space();
    const double size = std::clamp(mean_edge(mesh), kShortest, kLongest);
    MeshLines result;
    result.width = width;
    for (const std::size_t corner : corners_to_show(mesh, view)) {
        const std::uint32_t v = space.part.indices[corner];
        const Float3& n = space.part.normals[v];
        const Float4& t = space.tangents[corner];
        const Vec3 normal = normalize({static_cast<double>(n.x), static_cast<double>(n.y), static_cast<double>(n.z)});
        const Vec3 tangent = normalize({static_cast<double>(t.x), static_cast<double>(t.y), static_cast<double>(t.z)});
        const Vec3 binormal = cross(normal, tangent) * (t.w < 0.0f ? -1.0 : 1.0);
        const Vec3 from = mesh.place(v) + normal * (kOffset * size);
        const auto add = [&](Vec3 direction, Code color) {
            result.lines.push_back({from, from + direction * size, color});
        };
        add(tangent, kTangentColor);
        add(binormal, kBinormalColor);
        add(normal, kNormalColor);
    }
    return result;
}

}  // namespace tex::inline v1::render
