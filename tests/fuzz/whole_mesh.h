// SPDX-License-Identifier: Apache-2.0
// whole_mesh.h: what fuzz targets require of a mesh that was read: parts that pass check_part(), and tangents of all
// corners that are finite.

#pragma once

#include <cmath>
#include <cstddef>
#include <cstdlib>

#include <tex/mesh.h>

inline void expect(bool holds) {
    if (!holds) std::abort();
}

inline void expect_whole(const tex::MeshPart& part) {
    expect(static_cast<bool>(tex::check_part(part)));
    if (part.normals.empty() || part.uvs.empty()) return;
    for (const tex::TangentMethod method : {tex::TangentMethod::mikktspace, tex::TangentMethod::meshopt}) {
        const auto tangents = tex::make_tangents(part, method, 0, {1, {}});
        expect(tangents || tangents.error().code == tex::ErrorCode::unsupported);
        if (!tangents) continue;
        expect(tangents->size() == part.indices.size());
        for (const tex::Float4& t : *tangents) expect(std::isfinite(t.x + t.y + t.z) && (t.w == 1.0f || t.w == -1.0f));
    }
}

inline void expect_whole(const tex::Mesh& mesh) {
    expect(!mesh.parts.empty());
    for (const tex::MeshPart& part : mesh.parts) expect_whole(part);
    std::size_t nodes = 0;
    for (const tex::MeshNode& node : mesh.nodes) {
        if (++nodes > 100) break;
        for (const tex::MeshPart& part : mesh.parts) {
            if (part.mesh != node.mesh || part.positions.size() > 1000) continue;
            const auto moved = tex::in_scene(part, node);
            if (moved) expect(static_cast<bool>(tex::check_part(*moved)));
        }
    }
}
