// SPDX-License-Identifier: Apache-2.0
// Rays hit the same triangles in the tree of boxes as if every triangle is tested by itself, whatever the triangles.
// Bytes are a seed of the scale, then coordinates of triangles, nine bytes each, then of rays, eight bytes each. Few
// different coordinates make neighbours, copies, needles and rays through vertices and along edges. Each ray has seven
// neighbours, which move and turn away from it step by step, or not at all. Triangles that the ray sees edge-on, to the
// rounding of doubles, may be hit or not: where their area is nothing but rounding, so is t.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "rays/box_tree.h"

namespace {

using tex::Facing;

constexpr std::size_t kMostFuzzed = 96, kRays = 8, kNeighbours = 8, kRayBytes = 8, kHeader = 2;

double side_of(double ax, double ay, double bx, double by) { return ax * by - ay * bx; }

// The formulas of kernels/trace.h, once more.
tex::RayHit hit_of_all(const tex::Triangles& triangles, const tex::Ray& ray) {
    std::size_t z = 0;
    for (std::size_t k = 1; k < 3; ++k) {
        if (std::abs(ray.direction[k]) > std::abs(ray.direction[z])) z = k;
    }
    std::size_t x = (z + 1) % 3, y = (x + 1) % 3;
    if (ray.direction[z] < 0.0) std::swap(x, y);
    const double sx = ray.direction[x] / ray.direction[z], sy = ray.direction[y] / ray.direction[z],
                 sz = 1.0 / ray.direction[z];
    tex::RayHit best;
    for (std::size_t k = 0; k < triangles.count(); ++k) {
        double px[3], py[3], pz[3];
        const auto corners = triangles.at(k).corners();
        for (std::size_t c = 0; c < 3; ++c) {
            const double at[3] = {corners[c].x - ray.origin[0], corners[c].y - ray.origin[1],
                                  corners[c].z - ray.origin[2]};
            px[c] = at[x] - sx * at[z];
            py[c] = at[y] - sy * at[z];
            pz[c] = sz * at[z];
        }
        const double u = side_of(px[2], py[2], px[1], py[1]), v = side_of(px[0], py[0], px[2], py[2]),
                     w = side_of(px[1], py[1], px[0], py[0]), area = u + v + w;
        const bool front = u >= 0.0 && v >= 0.0 && w >= 0.0, back = u <= 0.0 && v <= 0.0 && w <= 0.0;
        const bool meets = ray.facing == Facing::front ? front : ray.facing == Facing::back ? back : front || back;
        if (!meets || area == 0.0) continue;
        const double t = (u * pz[0] + v * pz[1] + w * pz[2]) / area;
        if (!(t >= 0.0 && t <= ray.length) || (best.triangle != tex::kNoHit && t >= best.t)) continue;
        best = {t, {u / area, v / area, w / area}, static_cast<std::uint32_t>(k)};
    }
    return best;
}

// A third of the bytes are small integers; the others spread over many magnitudes.
float coordinate(std::uint8_t byte, float scale) {
    const int value = static_cast<int>(byte & 7) - 3;
    const int exponent = byte < 96 ? 0 : static_cast<int>(byte >> 3) - 22;
    return scale * std::ldexp(static_cast<float>(value), exponent);
}

// Whether the area of the triangle, as the ray sees it, may be nothing but rounding.
bool is_edge_on(const tex::Triangles& triangles, const tex::Ray& ray, std::uint32_t triangle) {
    if (triangle == tex::kNoHit) return false;
    const auto [a, b, c] = triangles.at(triangle).corners();
    const tex::Vector3 origin{ray.origin[0], ray.origin[1], ray.origin[2]},
        direction{ray.direction[0], ray.direction[1], ray.direction[2]};
    const tex::Vector3 normal = cross(b - a, c - a);
    double longest = 0.0;
    for (const tex::Vector3& corner : {a, b, c}) longest = std::max(longest, dot(corner - origin, corner - origin));
    return std::abs(dot(normal, direction)) <= 1e-12 * longest;
}

bool same_bits(const tex::RayHit& a, const tex::RayHit& b) {
    return a.triangle == b.triangle && a.t == b.t && a.weights[0] == b.weights[0] && a.weights[1] == b.weights[1] &&
           a.weights[2] == b.weights[2];
}

void expect_same(const tex::MeshPart& part, const std::vector<tex::Ray>& rays) {
    const tex::Triangles triangles({&part});
    const auto tree = tex::BoxTree::build(triangles, {1, {}});
    if (!tree) std::abort();
    std::vector<tex::RayHit> hits(rays.size());
    tex::trace_rays(tree->view(), rays.data(), rays.size(), hits.data());
    for (std::size_t k = 0; k < rays.size(); ++k) {
        const tex::RayHit wanted = hit_of_all(triangles, rays[k]);
        if (same_bits(hits[k], wanted)) continue;
        if (!is_edge_on(triangles, rays[k], hits[k].triangle) && !is_edge_on(triangles, rays[k], wanted.triangle))
            std::abort();
    }
}

// The last two bytes say how far neighbours are from each other.
void add_rays(const std::uint8_t* data, float scale, std::vector<tex::Ray>& rays) {
    const double step = static_cast<double>(coordinate(data[6], scale)) / 16.0,
                 turn = static_cast<double>(coordinate(data[7], 1.0f)) / 64.0;
    for (std::size_t n = 0; n < kNeighbours; ++n) {
        tex::Ray ray{};
        double squared = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto way = static_cast<double>((n * (k + 1)) % kNeighbours);
            ray.origin[k] = static_cast<double>(coordinate(data[k], scale)) + way * step;
            ray.direction[k] = static_cast<double>(coordinate(data[3 + k], 1.0f)) + way * turn;
            squared += ray.direction[k] * ray.direction[k];
        }
        if (squared == 0.0) continue;
        for (double& d : ray.direction) d /= std::sqrt(squared);
        ray.length = 1000.0 * static_cast<double>(scale);
        ray.facing = static_cast<Facing>(data[0] % 3);
        rays.push_back(ray);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < kHeader + 9 + kRayBytes) return 0;
    const float scale = std::ldexp(1.0f, static_cast<int>(data[0] % 200) - 100);
    const std::size_t rays_wanted = std::min<std::size_t>(kRays, 1 + data[1] % kRays);
    tex::MeshPart part;
    std::size_t at = kHeader;
    for (; at + 9 + kRayBytes * rays_wanted <= size && part.triangles() < kMostFuzzed; at += 9) {
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint8_t* p = data + at + 3 * c;
            part.indices.push_back(static_cast<std::uint32_t>(part.positions.size()));
            part.positions.push_back({coordinate(p[0], scale), coordinate(p[1], scale), coordinate(p[2], scale)});
        }
    }
    if (part.indices.empty()) return 0;
    std::vector<tex::Ray> rays;
    for (; at + kRayBytes <= size && rays.size() < kNeighbours * rays_wanted; at += kRayBytes)
        add_rays(data + at, scale, rays);
    if (!rays.empty()) expect_same(part, rays);
    return 0;
}
