// SPDX-License-Identifier: Apache-2.0
// RayMode::straight on what artists bake: a bevelled cube, a cylinder with caps, a panel with bolts. The table of
// transfer-normals(1).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/mesh.h>

#include "unit/transfers.h"

namespace tex {
namespace {

void append(MeshPart& to, const MeshPart& part) {
    const auto first = static_cast<std::uint32_t>(to.positions.size());
    to.uvs.resize(1);
    to.positions.insert(to.positions.end(), part.positions.begin(), part.positions.end());
    to.normals.insert(to.normals.end(), part.normals.begin(), part.normals.end());
    to.uvs[0].insert(to.uvs[0].end(), part.uvs[0].begin(), part.uvs[0].end());
    for (const std::uint32_t v : part.indices) to.indices.push_back(first + v);
}

// A whole turn is none, so that ends meet.
Float3 around(float turn, float radius, float z) {
    const float angle = turn < 1.0f ? 6.2831853f * turn : 0.0f;
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

// The side of a cone about z, from one radius and height to another, on the rows [v, v + 0.2] of the map.
MeshPart cone_side(int columns, std::pair<float, float> from, std::pair<float, float> to, float v) {
    const float rise = to.second - from.second, out = to.first - from.first;
    MeshPart part = grid_part(
        columns, 1, [&](float u, float w) { return around(u, from.first + w * out, from.second + w * rise); },
        [&](float u, float) {
            const Float3 n = around(u, rise, -out);
            return unit_vector(n);
        });
    for (Float2& uv : part.uvs[0]) uv = {0.05f + 0.9f * uv.x, v + 0.2f * uv.y};
    return part;
}

// A disc that faces up or down.
MeshPart disc(int columns, float radius, float z, bool up, float u, float v) {
    MeshPart part;
    part.uvs.resize(1);
    const Float3 normal{0.0f, 0.0f, up ? 1.0f : -1.0f};
    part.positions.push_back({0.0f, 0.0f, z});
    part.uvs[0].push_back({u, v});
    for (int k = 0; k < columns; ++k) {
        const Float3 p = around(static_cast<float>(k) / static_cast<float>(columns), radius, z);
        part.positions.push_back(p);
        part.uvs[0].push_back({u + 0.2f * p.x / radius, v + (up ? 0.2f : -0.2f) * p.y / radius});
        const auto next = static_cast<std::uint32_t>((k + 1) % columns + 1), own = static_cast<std::uint32_t>(k + 1);
        for (const std::uint32_t c : {0U, up ? own : next, up ? next : own}) part.indices.push_back(c);
    }
    part.normals.assign(part.positions.size(), normal);
    return part;
}

// About z, with a bevel of this width at both ends, or none.
MeshPart cylinder(int columns, float radius, float half, float bevel) {
    MeshPart part = cone_side(columns, {radius, -half + bevel}, {radius, half - bevel}, 0.75f);
    append(part, disc(columns, radius - bevel, half, true, 0.25f, 0.25f));
    append(part, disc(columns, radius - bevel, -half, false, 0.75f, 0.25f));
    if (bevel == 0.0f) return part;
    append(part, cone_side(columns, {radius, half - bevel}, {radius - bevel, half}, 0.5f));
    append(part, cone_side(columns, {radius - bevel, -half}, {radius, -half + bevel}, 0.5f));
    return part;
}

MeshPart box(Float3 half) {
    MeshPart part = hard_cube(1.0f);
    for (Float3& p : part.positions) p = {half.x * p.x, half.y * p.y, half.z * p.z};
    return part;
}

// Faces of a cube, moved inwards by the bevel, with its twelve edges and eight corners.
MeshPart bevelled_cube(float bevel) {
    MeshPart part = box({1.0f, 1.0f, 1.0f});
    const float b = 1.0f - bevel;
    for (std::size_t v = 0; v < part.positions.size(); ++v) {
        Float3& p = part.positions[v];
        const Float3 n = part.normals[v];
        p = {n.x != 0.0f ? p.x : b * p.x, n.y != 0.0f ? p.y : b * p.y, n.z != 0.0f ? p.z : b * p.z};
    }
    part.normals.clear();
    // Corners of faces that share a corner of the cube are joined by triangles, those that share an edge by quads.
    const auto octant = [&](std::uint32_t v) {
        const Float3 p = part.positions[v];
        return std::array<bool, 3>{p.x > 0.0f, p.y > 0.0f, p.z > 0.0f};
    };
    const auto add = [&](std::uint32_t a, std::uint32_t c, std::uint32_t d) {
        const Float3 p = part.positions[a], q = part.positions[c], r = part.positions[d];
        const Float3 x{q.x - p.x, q.y - p.y, q.z - p.z}, y{r.x - p.x, r.y - p.y, r.z - p.z};
        const Float3 n{x.y * y.z - x.z * y.y, x.z * y.x - x.x * y.z, x.x * y.y - x.y * y.x};
        const bool outwards = n.x * (p.x + q.x + r.x) + n.y * (p.y + q.y + r.y) + n.z * (p.z + q.z + r.z) > 0.0f;
        for (const std::uint32_t v : {a, outwards ? c : d, outwards ? d : c}) part.indices.push_back(v);
    };
    for (std::uint32_t a = 0; a < 24; ++a) {
        for (std::uint32_t c = a + 1; c < 24; ++c) {
            if (c / 4 == a / 4 || octant(a) != octant(c)) continue;
            for (std::uint32_t d = c + 1; d < 24; ++d) {
                if (d / 4 != c / 4 && octant(d) == octant(a)) add(a, c, d);
            }
            // These two faces at the other end of the edge.
            for (std::uint32_t e = a + 1; e < 24; ++e) {
                if (e / 4 != a / 4) continue;
                for (std::uint32_t f = 0; f < 24; ++f) {
                    if (f / 4 != c / 4 || octant(f) != octant(e)) continue;
                    add(a, c, e);
                    add(c, e, f);
                }
            }
        }
    }
    return part;
}

// How far rays lean from the normals of the low mesh, in degrees; `beyond` the width, where `is_far` says so.
struct Leans {
    double mean = 0.0, most = 0.0, beyond = 0.0;
    std::int64_t missed = 0;
};

template <class IsFar>
Leans leans_of(const MeshPart& low, const std::vector<MeshPart>& high, RayMode rays, const IsFar& is_far) {
    const Extent extent{192, 192};
    TransferOptions options = all_maps();
    options.rays = rays;
    options.straight_width = {Reach::Unit::absolute, 0.2};
    options.front = options.back = {Reach::Unit::absolute, 0.3};
    const auto maps = transferred(low, high, extent, options);
    options.rays = RayMode::vertex;
    const auto starts = transferred(low, only(low), extent, options);
    EXPECT_TRUE(maps && starts);
    if (!maps || !starts) return {};
    Leans leans;
    leans.missed = maps->missed;
    std::int64_t count = 0;
    for_hits(*maps, [&](int i, int j) {
        const Float3 p = position_at(*maps, i, j), q = position_at(*starts, i, j);
        const double height = static_cast<double>(maps->heights.at(i, j));
        if (std::abs(height) < 0.01) return;  // too near for a direction
        const auto sign = static_cast<float>(height > 0.0 ? 1 : -1);
        const Float3 way = unit_vector({sign * (p.x - q.x), sign * (p.y - q.y), sign * (p.z - q.z)});
        const double lean = degrees_between(way, vector_at(starts->object, i, j));
        ++count;
        leans.mean += lean;
        leans.most = std::max(leans.most, lean);
        if (is_far(q)) leans.beyond = std::max(leans.beyond, lean);
    });
    EXPECT_GT(count, 5000);
    leans.mean /= static_cast<double>(std::max<std::int64_t>(1, count));
    return leans;
}

MeshPart grown(MeshPart part, float factor) { return lifted(std::move(part), 0.0f, factor); }

void expect_leans(const Leans& leans, double mean, double most, double beyond) {
    EXPECT_EQ(leans.missed, 0);
    EXPECT_NEAR(leans.mean, mean, 0.1);
    EXPECT_NEAR(leans.most, most, 0.1);
    EXPECT_NEAR(leans.beyond, beyond, 0.1);
}

TEST(StraightRays, TakeTheSkewOutOfABevelledCube) {
    const MeshPart low = box({1, 1, 1});
    const auto high = only(grown(bevelled_cube(0.1f), 1.05f));
    const auto is_far = [](Float3 p) {
        float at[3] = {std::abs(p.x), std::abs(p.y), std::abs(p.z)};
        std::sort(at, at + 3);
        return at[1] < 0.8f;
    };
    expect_leans(leans_of(low, high, RayMode::smooth, is_far), 35.6, 54.4, 47.7);
    expect_leans(leans_of(low, high, RayMode::straight, is_far), 7.5, 54.3, 0.0);
}

TEST(StraightRays, TakeTheSkewOutOfACylinderWithCaps) {
    const MeshPart low = cylinder(24, 1.0f, 1.0f, 0.0f);
    const auto high = only(grown(cylinder(96, 1.0f, 1.0f, 0.1f), 1.06f));
    const auto is_far = [](Float3 p) {
        const float radius = std::sqrt(p.x * p.x + p.y * p.y);
        return std::abs(p.z) > 0.999f ? radius < 0.75f : std::abs(p.z) < 0.8f;
    };
    expect_leans(leans_of(low, high, RayMode::smooth, is_far), 28.2, 47.1, 36.6);
    expect_leans(leans_of(low, high, RayMode::straight, is_far), 6.4, 47.1, 0.0);
}

// On top of the panel, texels show the sides of bolts only if rays lean.
TEST(StraightRays, ShowBoltsFromAbove) {
    const MeshPart low = box({1.0f, 1.0f, 0.2f});
    std::vector<MeshPart> high = only(low);
    for (int k = 0; k < 9; ++k) {
        MeshPart bolt = cylinder(32, 0.1f, 0.1f, 0.0f);
        for (Float3& p : bolt.positions)
            p = {p.x + 0.5f * static_cast<float>(k % 3 - 1), p.y + 0.5f * static_cast<float>(k / 3 - 1), p.z + 0.2f};
        high.push_back(std::move(bolt));
    }
    const auto sides = [&](RayMode rays) {
        TransferOptions options = all_maps();
        options.rays = rays;
        options.straight_width = {Reach::Unit::absolute, 0.2};
        options.front = options.back = {Reach::Unit::absolute, 0.2};
        const auto maps = transferred(low, high, {384, 256}, options);
        EXPECT_TRUE(maps);
        EXPECT_EQ(maps->missed, 0);
        int count = 0;
        for_hits(*maps, [&](int i, int j) {
            const Float3 n = vector_at(maps->object, i, j), p = position_at(*maps, i, j);
            count += p.z > 0.21f && std::abs(n.z) < 0.1f ? 1 : 0;
        });
        return count;
    };
    EXPECT_NEAR(sides(RayMode::smooth), 252, 3);
    EXPECT_EQ(sides(RayMode::straight), 0);
}

}  // namespace
}  // namespace tex
