// SPDX-License-Identifier: Apache-2.0
// transfers.h: meshes and maps for tests of transfer().

#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include <tex/transfer.h>

#include "unit/convert_maps.h"

namespace tex {

inline std::vector<MeshPart> only(MeshPart part) {
    std::vector<MeshPart> parts;
    parts.push_back(std::move(part));
    return parts;
}

inline TransferOptions all_maps() {
    TransferOptions options;
    options.object = options.heights = options.positions = true;
    return options;
}

inline Float3 position_at(const TransferredMaps& maps, int i, int j) {
    return {maps.position[0].at(i, j), maps.position[1].at(i, j), maps.position[2].at(i, j)};
}

// Calls body(i, j) for every texel that rays hit, and returns their number.
template <class Body>
std::int64_t for_hits(const TransferredMaps& maps, const Body& body) {
    std::int64_t hits = 0;
    const auto [width, height] = maps.map.extent();
    for (int j = 0; j < height; ++j) {
        for (int i = 0; i < width; ++i) {
            if (maps.origin.at(i, j) != TexelOrigin::hit) continue;
            ++hits;
            body(i, j);
        }
    }
    return hits;
}

inline bool same_plane(const Plane<float>& a, const Plane<float>& b) {
    for (int j = 0; j < a.extent().height; ++j) {
        if (std::memcmp(a.row(j), b.row(j), static_cast<std::size_t>(a.extent().width) * sizeof(float)) != 0)
            return false;
    }
    return true;
}

inline bool same_maps(const TransferredMaps& a, const TransferredMaps& b) {
    return same_plane(a.map.x, b.map.x) && same_plane(a.map.y, b.map.y) && same_plane(a.map.z, b.map.z) &&
           same_plane(a.heights, b.heights);
}

inline Result<TransferredMaps> transferred(const MeshPart& low, const std::vector<MeshPart>& high, Extent extent,
                                           const TransferOptions& options = all_maps(),
                                           Decoder decoder = Decoder::gltf) {
    const auto tangents = make_tangents(low);
    if (!tangents) return tangents.error();
    return transfer(extent, {low, *tangents, 0, decoder}, high, options);
}

// A square of the size of the map, in texels.
inline MeshPart flat_square(Extent extent) {
    MeshPart part = square(0.0f, 1.0f);
    for (std::size_t v = 0; v < part.positions.size(); ++v) {
        const Float2 uv = part.uvs[0][v];
        const float y = part.v_axis == YAxis::up ? uv.y : 1.0f - uv.y;
        part.positions[v] = {uv.x * static_cast<float>(extent.width), y * static_cast<float>(extent.height), 0.0f};
        part.normals[v] = {0.0f, 0.0f, 1.0f};
    }
    return part;
}

inline MeshPart lifted(MeshPart part, float height, float scale = 1.0f) {
    for (Float3& p : part.positions) p = {scale * p.x, scale * p.y, scale * p.z + height};
    return part;
}

inline MeshPart inside_out(MeshPart part) {
    for (std::size_t k = 0; k < part.indices.size(); k += 3) std::swap(part.indices[k + 1], part.indices[k + 2]);
    return part;
}

inline MeshPart hard_cube(float size) {
    MeshPart cube = smooth_cube().part;
    for (std::size_t v = 0; v < cube.positions.size(); ++v) {
        const std::size_t face = v / 4;
        constexpr Float3 kNormals[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
        cube.normals[v] = kNormals[face];
        const Float3 p = cube.positions[v];
        cube.positions[v] = {size * p.x, size * p.y, size * p.z};
    }
    return cube;
}

// The maps of `low` in its own tangent space.
inline Result<TransferredMaps> guided(const MeshPart& low, const std::vector<MeshPart>& high, Extent extent,
                                      const TransferInputs& inputs, const TransferOptions& options = all_maps()) {
    const auto tangents = make_tangents(low);
    if (!tangents) return tangents.error();
    return transfer(extent, {low, *tangents}, high, inputs, options);
}

inline Reach length(double value) { return {Reach::Unit::absolute, value}; }

}  // namespace tex
