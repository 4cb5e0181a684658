// SPDX-License-Identifier: Apache-2.0
// mesh_fits.h: maps of a surface with waves, and what rule N711 finds in them.

#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/check.h>
#include <tex/mesh.h>
#include <tex/pack.h>

#include "mesh/coverage.h"
#include "unit/solids.h"

namespace tex {

// A map in object space of a surface with waves, which depend on the position in space alone.
inline NormalMap wavy_surface(const MeshPart& part, Extent extent, double waves) {
    NormalMap map(extent);
    map.x = Plane<float>(extent, 0.0f);
    map.y = Plane<float>(extent, 0.0f);
    map.z = Plane<float>(extent, 1.0f);
    const auto coverage = CoverageMap::make(part, 0, extent, 2);
    EXPECT_TRUE(coverage);
    Float3 low = part.positions.front(), high = low;
    for (const Float3& p : part.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const float size = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    const float k = static_cast<float>(6.28 * waves) / size;
    std::vector<Covered> texels;
    for (int strip = 0; strip < coverage->strips(); ++strip) {
        coverage->cover(strip, texels);
        for (std::size_t at = 0; at < texels.size(); ++at) {
            if (texels[at].triangle == kNoTriangle) continue;
            Float3 p, n;
            for (std::size_t c = 0; c < 3; ++c) {
                const std::uint32_t v = part.indices[3 * static_cast<std::size_t>(texels[at].triangle) + c];
                const auto w = static_cast<float>(texels[at].weights[c]);
                const Float3 &q = part.positions[v], &m = part.normals[v];
                p = {p.x + w * q.x, p.y + w * q.y, p.z + w * q.z};
                n = {n.x + w * m.x, n.y + w * m.y, n.z + w * m.z};
            }
            n = unit_vector({n.x + 0.4f * std::sin(k * (p.y + 0.5f * p.z)),
                             n.y + 0.4f * std::sin(k * (p.z + 0.5f * p.x)),
                             n.z + 0.4f * std::sin(k * (p.x + 0.5f * p.y))});
            const int i = static_cast<int>(at) % extent.width,
                      j = strip * coverage->strip_rows() + static_cast<int>(at) / extent.width;
            map.x.at(i, j) = n.x;
            map.y.at(i, j) = n.y;
            map.z.at(i, j) = n.z;
        }
    }
    return map;
}

// The map as a baker for this space makes it, in 8 bits.
inline Texture baked(const NormalMap& surface, const TangentSpace& space, YAxis y = YAxis::up) {
    auto map = to_tangent_space(surface, space);
    EXPECT_TRUE(map);
    MipChain chain;
    chain.levels.push_back(std::move(map->map));
    auto texture = pack(chain, {Encoding::rgb8, y, Effort::fast});
    EXPECT_TRUE(texture);
    texture->y_known = false;
    return std::move(*texture);
}

struct Fit {
    std::optional<Finding> finding;
    std::optional<SeamEvidence> seams;
};

inline Fit fit_of(const Texture& texture, const SelectedPart& selected, Decoder decoder = Decoder::gltf) {
    const MeshToCheck mesh{selected, decoder, "mesh.glb"};
    CheckOptions options;
    options.mesh = &mesh;
    const auto report = check("map", texture, options);
    EXPECT_TRUE(report);
    Fit fit;
    fit.seams = report->seams;
    for (const Finding& finding : report->findings) {
        EXPECT_NE(finding.rule->id, "N721");
        if (finding.rule->id == "N711") fit.finding = finding;
    }
    return fit;
}

inline std::string message_of(const Fit& fit) { return fit.finding ? fit.finding->message : ""; }

inline bool says(const Fit& fit, const std::string& words) { return message_of(fit).find(words) != std::string::npos; }

inline SelectedPart selected_cube() {
    SelectedPart selected;
    selected.part = smooth_cube().part;
    selected.tangents = *make_tangents(selected.part);
    selected.source = TangentSource::mikktspace;
    return selected;
}

// Finds every wrong space of a map on this mesh, and nothing in the right one.
inline void expect_verdicts(const SelectedPart& selected, Extent extent, double waves, const std::string& name) {
    const NormalMap surface = wavy_surface(selected.part, extent, waves);
    const std::vector<Float4>& own = selected.tangents;
    const Texture right = baked(surface, {selected.part, own});
    EXPECT_EQ(message_of(fit_of(right, selected)), "") << name;
    const Texture per_vertex = baked(surface, {selected.part, own, 0, Decoder::godot});
    const Fit fit = fit_of(per_vertex, selected);
    EXPECT_TRUE(says(fit, "the decoder is one of unity-builtin, godot, substance-vertex")) << name << message_of(fit);
    EXPECT_FALSE(says(fit, "green")) << name;
    EXPECT_EQ(message_of(fit_of(per_vertex, selected, Decoder::unity_builtin)), "") << name;
    const Texture down = baked(surface, {selected.part, own}, YAxis::down);
    EXPECT_TRUE(says(fit_of(down, selected), "green points down, or w")) << name;
    EXPECT_FALSE(says(fit_of(down, selected), "decoder")) << name;
    EXPECT_EQ(message_of(fit_of(down, selected, Decoder::unreal)), "") << name;  // which reads maps with y down
    std::vector<Float4> flipped = own;
    for (Float4& t : flipped) t.w = -t.w;
    EXPECT_TRUE(says(fit_of(baked(surface, {selected.part, flipped}), selected), "w of the tangents is flipped"))
        << name;
}

}  // namespace tex
