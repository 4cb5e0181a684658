// SPDX-License-Identifier: Apache-2.0
// broken_meshes.h: the meshes of samples/broken, as GLB files. Only integers and + - * / sqrt make them.

#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <tex/tex.h>

#include "unit/gltf_files.h"
#include "unit/meshes.h"
#include "unit/solids.h"

namespace tex {

// The part with the tangents of MikkTSpace, whose vertices need no splitting.
inline MeshPart with_tangents(MeshPart part) {
    const auto tangents = make_tangents(part);
    part.tangents.resize(part.positions.size());
    if (!tangents) return part;
    for (std::size_t c = 0; c < part.indices.size(); ++c) part.tangents[part.indices[c]] = (*tangents)[c];
    return part;
}

// A sheet over the whole map, with the tangents of MikkTSpace.
inline MeshPart broken_sheet() {
    MeshPart part = wavy_part(4);
    for (std::size_t k = 0; k < part.uvs[0].size(); ++k) part.uvs[0][k].y -= 0.125f * part.uvs[0][k].x;
    return with_tangents(std::move(part));
}

// Two sheets side by side, each in a half of the map: the second one mirrored, or both in the same half.
inline MeshPart two_sheets(bool mirrored) {
    MeshPart both = broken_sheet();
    const MeshPart one = both;
    const auto count = static_cast<std::uint32_t>(one.positions.size());
    for (Float2& uv : both.uvs[0]) uv.x *= 0.5f;
    for (std::size_t k = 0; k < one.positions.size(); ++k) {
        const Float3& p = one.positions[k];
        const Float2 uv = one.uvs[0][k];
        both.positions.push_back({p.x + 2.0f, p.y, p.z});
        both.normals.push_back(one.normals[k]);
        both.uvs[0].push_back({mirrored ? 1.0f - 0.5f * uv.x : 0.5f * uv.x, uv.y});
    }
    for (const std::uint32_t v : one.indices) both.indices.push_back(count + v);
    both.tangents.clear();
    return with_tangents(std::move(both));
}

template <class T>
std::vector<float> floats_of(const std::vector<T>& values) {
    std::vector<float> list;
    for (const T& value : values) {
        list.push_back(value.x);
        list.push_back(value.y);
        if constexpr (requires { value.z; }) list.push_back(value.z);
        if constexpr (requires { value.w; }) list.push_back(value.w);
    }
    return list;
}

// The material of a GLB file, and the image that its textures show.
struct BrokenMaterial {
    std::string material = R"("normalTexture":{"index":0})";
    std::string texture = R"("source":0)";
    std::vector<std::byte> image = {};  // empty: a file beside it
    std::string mime_type = "image/png";
    std::string extension = {};  // that it uses
};

// A GLB file of the part, whose material has a normal map.
inline std::string glb_of_part(const MeshPart& part, const BrokenMaterial& with = {}) {
    GltfMaker maker;
    std::array<float, 3> low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
    for (const Float3& p : part.positions) {
        const float xyz[3] = {p.x, p.y, p.z};
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = xyz[k] < low[k] ? xyz[k] : low[k];
            high[k] = xyz[k] > high[k] ? xyz[k] : high[k];
        }
    }
    const auto triple = [](const std::array<float, 3>& v) {
        std::string text;
        for (const float x : v) {
            char number[32];
            std::snprintf(number, sizeof number, "%.9g", static_cast<double>(x));
            text += (text.empty() ? "[" : ",") + std::string(number);
        }
        return text + "]";
    };
    const auto attribute = [](const char* name, int accessor) {
        return "\"" + std::string(name) + "\":" + std::to_string(accessor);
    };
    std::vector<Float2> uvs = part.uvs[0];
    if (part.v_axis == YAxis::up) {
        for (Float2& uv : uvs) uv.y = 1.0f - uv.y;
    }
    const std::string bounds = ",\"min\":" + triple(low) + ",\"max\":" + triple(high);
    std::string attributes = attribute("POSITION", maker.add(floats_of(part.positions), "VEC3", 5126, bounds));
    if (!part.normals.empty())
        attributes += "," + attribute("NORMAL", maker.add(floats_of(part.normals), "VEC3", 5126));
    attributes += "," + attribute("TEXCOORD_0", maker.add(floats_of(uvs), "VEC2", 5126));
    if (!part.tangents.empty())
        attributes += "," + attribute("TANGENT", maker.add(floats_of(part.tangents), "VEC4", 5126));
    const int indices = maker.add(part.indices, "SCALAR", 5125);
    const std::string image = with.image.empty()
                                  ? R"("uri":"normals.png")"
                                  : "\"name\":\"normals\",\"mimeType\":\"" + with.mime_type +
                                        "\",\"bufferView\":" + std::to_string(maker.add_view(with.image));
    return maker.glb("{\"attributes\":{" + attributes + "},\"indices\":" + std::to_string(indices) + ",\"material\":0}",
                     ",\"materials\":[{" + with.material + "}],\"textures\":[{" + with.texture + "}],\"images\":[{" +
                         image + R"(}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],"scene":0)" +
                         (with.extension.empty() ? "" : ",\"extensionsUsed\":[\"" + with.extension + "\"]"));
}

}  // namespace tex
