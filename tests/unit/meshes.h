// SPDX-License-Identifier: Apache-2.0
// meshes.h: meshes for tests, from formulas and from seeds. Only integers and + - * / sqrt make them, so that they have
// the same bits everywhere.

#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <tex/mesh.h>

namespace tex {

inline Float3 unit_vector(Float3 v) {
    const float n = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return {v.x / n, v.y / n, v.z / n};
}

// A wavy sheet of 2 n^2 triangles. Its normals are smooth, its UVs are a grid; beyond the middle they are mirrored if
// asked for.
inline MeshPart wavy_part(int n, bool mirrored = false) {
    MeshPart part;
    part.uvs.resize(1);
    const auto f = [](int k) { return static_cast<float>(k); };
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
            const float x = f(i) / f(n), y = f(j) / f(n);
            part.positions.push_back({x, y, 0.5f * x * (1.0f - x) + 0.25f * y * y * x});
            part.normals.push_back(unit_vector({-0.5f + x - 0.25f * y * y, -0.5f * y * x, 1.0f}));
            part.uvs[0].push_back({mirrored && 2 * i > n ? 1.0f - x : x, y + 0.125f * x});
        }
    }
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const auto a = static_cast<std::uint32_t>(j * (n + 1) + i), c = a + static_cast<std::uint32_t>(n) + 1;
            for (const std::uint32_t v : {a, a + 1, c + 1, a, c + 1, c}) part.indices.push_back(v);
        }
    }
    return part;
}

// Triangles that nobody would model: from a few positions, normals and UVs, so that edges are shared by many triangles,
// in both directions; with triangles without area in space or in UV space, and mirrored ones.
inline MeshPart random_part(unsigned seed) {
    std::minstd_rand random(seed * 7919 + 1);
    for (int k = 0; k < 8; ++k) random();
    const auto below = [&](unsigned n) { return static_cast<unsigned>(random() >> 8) % n; };
    const auto coordinate = [&](unsigned steps) { return static_cast<float>(below(steps)) / 8.0f - 1.0f; };

    if (seed % 5 == 0) {                      // a sheet with a few wild vertices
        const bool mirrored = below(2) == 0;  // drawn first: the order of a call's arguments depends on the compiler
        MeshPart part = wavy_part(3 + static_cast<int>(below(5)), mirrored);
        for (unsigned k = below(6); k > 0; --k) {
            const unsigned v = below(static_cast<unsigned>(part.positions.size()));
            switch (below(3)) {
                case 0: part.positions[v] = part.positions[below(v + 1)]; break;
                case 1: part.uvs[0][v] = part.uvs[0][below(v + 1)]; break;
                default: part.indices[below(static_cast<unsigned>(part.indices.size()))] = v; break;
            }
        }
        return part;
    }
    MeshPart part;
    part.uvs.resize(1);
    const unsigned steps = seed % 5 == 1 ? 3 : seed % 5 == 2 ? 5 : 1000, normals = seed % 5 == 3 ? 6 : 1;
    const unsigned vertices = 4 + below(30);
    for (unsigned v = 0; v < vertices; ++v) {
        part.positions.push_back({coordinate(steps), coordinate(steps), coordinate(2)});
        const unsigned n = below(normals);
        part.normals.push_back(unit_vector({static_cast<float>(n) - 2.0f, 0.5f * static_cast<float>(n % 3), 1.0f}));
        part.uvs[0].push_back({coordinate(steps), coordinate(steps)});
    }
    for (unsigned k = 3 * (2 + below(60)); k > 0; --k) part.indices.push_back(below(vertices));
    return part;
}

}  // namespace tex
