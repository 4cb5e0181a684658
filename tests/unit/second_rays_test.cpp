// SPDX-License-Identifier: Apache-2.0
// Occlusion, bent normals and thickness of transfer(), against closed forms.

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/mesh.h>

#include "rays/box_tree.h"
#include "rays/hemisphere.h"
#include "unit/targets.h"
#include "unit/transfers.h"

namespace tex {
namespace {

TransferOptions second_maps(int rays) {
    TransferOptions options;
    options.occlusion = options.bent = options.thickness = true;
    options.rays_per_hit = rays;
    return options;
}

// A rectangle with the corner `at` and two sides; it faces cross(x, y). The map lies on it.
MeshPart rectangle(Float3 at, Float3 x, Float3 y) {
    MeshPart part = square(0.0f, 1.0f);
    part.normals.clear();
    for (std::size_t v = 0; v < 4; ++v) {
        const Float2 uv = part.uvs[0][v];
        part.positions[v] = {at.x + uv.x * x.x + uv.y * y.x, at.y + uv.x * x.y + uv.y * y.y,
                             at.z + uv.x * x.z + uv.y * y.z};
    }
    return part;
}

MeshPart with_normals(MeshPart part, Float3 normal) {
    part.normals.assign(part.positions.size(), normal);
    return part;
}

// How far texels are from the truth in standard deviations of N rays, and how far their mean is.
struct Deviation {
    double mean = 0.0, most = 0.0;
    std::int64_t texels = 0, beyond = 0;  // 3 of them

    void see(double value, double truth, double sigma) {
        const double deviation = (value - truth) / sigma;
        mean += deviation;
        most = std::max(most, std::abs(deviation));
        beyond += std::abs(deviation) > 3.0 ? 1 : 0;
        ++texels;
    }
    // The mean of so many values has a deviation of 1 / sqrt(texels).
    void expect_unbiased() const {
        EXPECT_LT(std::abs(mean) / std::sqrt(static_cast<double>(texels)), 3.0);
        EXPECT_LE(static_cast<double>(beyond), 0.003 * static_cast<double>(texels)) << most;
    }
};

double deviation_of(double share, int rays) { return std::sqrt(share * (1.0 - share) / rays); }

TEST(Hemisphere, PlacesOneDirectionInEachCell) {
    for (const std::uint32_t seed : {0U, 1U, 77U, 0xffffffffU}) {
        const Hemisphere set(64);
        std::array<Vector3, 64> d;
        set.about({0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}, seed, d.data());
        for (const auto& [columns, rows] : {std::pair{8, 8}, {64, 1}, {1, 64}, {4, 16}}) {
            std::set<int> cells;
            for (const Vector3& v : d) {
                EXPECT_NEAR(dot(v, v), 1.0, 1e-12);
                const double u = 1.0 - v.z * v.z, turn = std::atan2(v.y, v.x) / 6.283185307179586;
                cells.insert(static_cast<int>(u * columns) * rows +
                             static_cast<int>((turn < 0.0 ? turn + 1.0 : turn) * rows));
            }
            EXPECT_EQ(cells.size(), 64u) << columns << " " << rows;
        }
    }
}

TEST(Hemisphere, ReflectsWhatLiesBelowTheFace) {
    std::mt19937 random(3);
    std::normal_distribution<double> number;
    const Hemisphere set(37);
    std::array<Vector3, 37> d;
    for (int k = 0; k < 200; ++k) {
        const Vector3 face = normalized({number(random), number(random), number(random)});
        Vector3 axis = normalized({number(random), number(random), number(random)});
        if (dot(axis, face) < 0.0) axis = -1.0 * axis;
        set.about(axis, face, Hemisphere::seed_of(k, 2 * k, 0), d.data());
        for (const Vector3& v : d) {
            EXPECT_GE(dot(v, face), 0.0);
            EXPECT_NEAR(dot(v, v), 1.0, 1e-12);
            // It, or its image, is on the side of the axis.
            EXPECT_GE(std::max(dot(v, axis), dot(v - 2.0 * dot(v, face) * face, axis)), 0.0);
        }
    }
}

TEST(Trace, FindsBlockedRaysAsItFindsHits) {
    const MeshPart part = wavy_part(30);
    const auto tree = BoxTree::build(Triangles({&part}), {});
    ASSERT_TRUE(tree);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-0.2, 1.2);
    std::normal_distribution<double> number;
    std::vector<Ray> rays;
    for (int k = 0; k < 20000; ++k) {
        const Vector3 d = normalized({number(random), number(random), number(random)});
        rays.push_back({{place(random), place(random), place(random)},
                        {d.x, d.y, d.z},
                        std::abs(place(random)),
                        static_cast<Facing>(k % 3)});
    }
    on_every_target([&] {
        std::vector<RayHit> hits(rays.size());
        std::vector<std::uint8_t> blocked(rays.size());
        trace_rays(tree->view(), rays.data(), rays.size(), hits.data());
        find_blocked(tree->view(), rays.data(), rays.size(), blocked.data());
        std::int64_t count = 0;
        for (std::size_t k = 0; k < rays.size(); ++k) {
            ASSERT_EQ(blocked[k] != 0, hits[k].triangle != kNoHit) << k;
            count += blocked[k];
        }
        EXPECT_GT(count, 500);
    });
}

TEST(SecondRays, OfConvexMeshesAreAllOpen) {
    std::vector<MeshPart> parts = {flat_square({16, 16}), sphere().part, hard_cube(1.0f), smooth_cube().part};
    for (const MeshPart& part : parts) {
        for (const float scale : {1e-4f, 1.0f, 1e5f}) {
            const MeshPart scaled = lifted(part, 37.0f * scale, scale);
            TransferOptions options;
            options.occlusion = options.bent = true;
            options.rays_per_hit = 32;
            const auto maps = transferred(scaled, only(scaled), {48, 32}, options);
            ASSERT_TRUE(maps) << maps.error().message();
            EXPECT_EQ(maps->rays, maps->covered * 33);
            for_hits(*maps, [&](int i, int j) { ASSERT_EQ(maps->occlusion.at(i, j), 1.0f) << i << " " << j; });
        }
    }
}

// Nothing leaks through the edges of a room.
TEST(SecondRays, OfClosedRoomsAreAllBlocked) {
    for (const float scale : {1e-4f, 1.0f, 1e5f}) {
        MeshPart room = inside_out(lifted(hard_cube(1.0f), 11.0f, scale));
        for (Float3& n : room.normals) n = {-n.x, -n.y, -n.z};
        const auto maps = transferred(room, only(room), {96, 64}, second_maps(64));
        ASSERT_TRUE(maps) << maps.error().message();
        EXPECT_EQ(maps->missed, 0);
        for_hits(*maps, [&](int i, int j) {
            ASSERT_EQ(maps->occlusion.at(i, j), 0.0f) << i << " " << j;
            ASSERT_NEAR(maps->bent.z.at(i, j), 1.0f, 1e-6f);  // the normal's own direction
            ASSERT_EQ(maps->thickness.at(i, j), 0.0f);        // nothing is behind
        });
    }
}

// A floor at a distance d from a wall of height h and any length sees the part (1 + d / sqrt(d^2 + h^2)) / 2 of the
// sky: the form factor of a strip at a right angle.
TEST(SecondRays, OfAFloorAtAWallFollowTheFormFactor) {
    constexpr float kLong = 4000.0f;
    const MeshPart floor = with_normals(rectangle({0, -1, 0}, {2, 0, 0}, {0, 2, 0}), {0, 0, 1});
    std::vector<MeshPart> high = only(rectangle({0, -kLong, 0}, {2, 0, 0}, {0, 2 * kLong, 0}));
    high.push_back(rectangle({0, -kLong, 0}, {0, 2 * kLong, 0}, {0, 0, 1.5f}));  // faces x
    for (const int rays : {16, 64, 256}) {
        TransferOptions options = second_maps(rays);
        options.front = options.back = {Reach::Unit::absolute, 0.01};
        const Extent extent{32, 64};
        const auto maps = transferred(floor, high, extent, options);
        ASSERT_TRUE(maps) << maps.error().message();
        Deviation deviation;
        for_hits(*maps, [&](int i, int j) {
            const double d = 2.0 * (i + 0.5) / extent.width, truth = 0.5 * (1.0 + d / std::sqrt(d * d + 2.25));
            deviation.see(static_cast<double>(maps->occlusion.at(i, j)), truth, deviation_of(truth, rays));
        });
        EXPECT_EQ(deviation.texels, 2048);
        deviation.expect_unbiased();
    }
}

// At the foot of an endless wall, half of the sky is open: the mean direction leans away from it by atan(2 / pi).
TEST(SecondRays, BendNormalsAwayFromAWall) {
    const MeshPart floor = with_normals(rectangle({0.001f, -1, 0}, {1, 0, 0}, {0, 2, 0}), {0, 0, 1});
    std::vector<MeshPart> high = only(rectangle({-1, -2, 0}, {4, 0, 0}, {0, 4, 0}));
    high.push_back(rectangle({0, -1e6f, 0}, {0, 2e6f, 0}, {0, 0, 1e6f}));
    TransferOptions options = second_maps(1024);
    options.front = options.back = {Reach::Unit::absolute, 0.0001};
    const auto maps = transferred(floor, high, {16, 16}, options);
    ASSERT_TRUE(maps) << maps.error().message();
    Deviation open;
    double x = 0.0, y = 0.0;
    const auto hits = for_hits(*maps, [&](int i, int j) {
        open.see(static_cast<double>(maps->occlusion.at(i, j)), 0.5, deviation_of(0.5, 1024));
        x += static_cast<double>(maps->bent.x.at(i, j));
        y += static_cast<double>(maps->bent.y.at(i, j));
        EXPECT_NEAR(maps->bent.x.at(i, j), std::sin(std::atan(2.0 / 3.141592653589793)), 0.02);
    });
    open.expect_unbiased();
    EXPECT_NEAR(x / static_cast<double>(hits), std::sin(std::atan(2.0 / 3.141592653589793)), 0.002);
    EXPECT_NEAR(y / static_cast<double>(hits), 0.0, 0.002);
}

// A sphere of radius R whose centre is H above a plane, at a distance a along it, hides the part R^2 H / (H^2 +
// a^2)^1.5.
TEST(SecondRays, BelowASphereFollowTheFormFactor) {
    const MeshPart floor = with_normals(rectangle({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), {0, 0, 1});
    std::vector<MeshPart> high = only(floor);
    const auto normal = [](float u, float v) -> Float3 {
        const float a = 6.2831853f * u, b = 3.1415927f * (v - 0.5f);
        return {std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)};
    };
    const auto at = [&](float u, float v) {
        const Float3 n = normal(u, v);
        return Float3{0.6f * n.x, 0.6f * n.y, 0.6f * n.z + 1.0f};
    };
    high.push_back(grid_part(256, 128, at, normal));
    TransferOptions options = second_maps(256);
    options.front = options.back = {Reach::Unit::absolute, 0.01};
    const Extent extent{64, 64};
    const auto maps = transferred(floor, high, extent, options);
    ASSERT_TRUE(maps) << maps.error().message();
    Deviation deviation;
    for_hits(*maps, [&](int i, int j) {
        const double x = 4.0 * (i + 0.5) / 64.0 - 2.0, y = 2.0 - 4.0 * (j + 0.5) / 64.0;
        const double truth = 1.0 - 0.36 / std::pow(1.0 + x * x + y * y, 1.5);
        deviation.see(static_cast<double>(maps->occlusion.at(i, j)), truth, deviation_of(truth, 256));
    });
    deviation.expect_unbiased();
    // What is farther away than the limit does not count.
    options.occlusion_distance = {Reach::Unit::absolute, 0.39};
    const auto none = transferred(floor, high, extent, options);
    ASSERT_TRUE(none);
    for_hits(*none, [&](int i, int j) { ASSERT_EQ(none->occlusion.at(i, j), 1.0f); });
}

// The mean chord of a sphere is 4/3 r, with a variance of 2/9 r^2. Through a slab of thickness T it is 2 T; where
// rays end at L, 2 T - T^2 / L.
TEST(SecondRays, MeasureSpheresAndSlabs) {
    const auto normal = [](float u, float v) -> Float3 {
        const float a = 6.2831853f * u, b = 3.1415927f * (v - 0.5f);
        return {std::cos(a) * std::cos(b), std::sin(b), -std::sin(a) * std::cos(b)};
    };
    const MeshPart low = sphere().part;
    const auto maps = transferred(low, only(grid_part(400, 200, normal, normal)), {48, 32}, second_maps(64));
    ASSERT_TRUE(maps) << maps.error().message();
    Deviation chord;
    for_hits(*maps, [&](int i, int j) {
        chord.see(static_cast<double>(maps->thickness.at(i, j)), 4.0 / 3.0, std::sqrt(2.0 / 9.0 / 64.0));
    });
    EXPECT_GT(chord.texels, 1000);
    chord.expect_unbiased();
    EXPECT_LE(maps->thinnest, 4.0f / 3.0f);
    EXPECT_GE(maps->thickest, 4.0f / 3.0f);

    const MeshPart top = with_normals(rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), {0, 0, 1});
    std::vector<MeshPart> slab = only(rectangle({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}));
    slab.push_back(inside_out(rectangle({-9, -9, -0.5f}, {18, 0, 0}, {0, 18, 0})));
    TransferOptions options = second_maps(64);
    options.occlusion_distance = {Reach::Unit::absolute, 2.0};
    options.front = options.back = {Reach::Unit::absolute, 0.1};
    const auto limited = transferred(top, slab, {32, 32}, options);
    ASSERT_TRUE(limited);
    const double truth = 2.0 * 0.5 - 0.25 / 2.0;
    // The mean square is 2 T^2 ln(L / T) + T^2.
    const double square = 0.5 * std::log(4.0) + 0.25;
    Deviation deviation;
    for_hits(*limited, [&](int i, int j) {
        deviation.see(static_cast<double>(limited->thickness.at(i, j)), truth,
                      std::sqrt((square - truth * truth) / 64.0));
    });
    deviation.expect_unbiased();
}

TEST(SecondRays, GiveTheSameBytesForEveryNumberOfThreadsAndInstructionSet) {
    const auto high = only(wavy_part(40));
    const MeshPart low = wavy_part(5);
    const auto tangents = make_tangents(low);
    ASSERT_TRUE(tangents);
    TransferOptions options = second_maps(20);
    options.subsamples = 2;
    const auto same = [](const TransferredMaps& a, const TransferredMaps& b) {
        return same_maps(a, b) && same_plane(a.occlusion, b.occlusion) && same_plane(a.thickness, b.thickness) &&
               same_plane(a.bent.x, b.bent.x) && same_plane(a.bent.y, b.bent.y) && same_plane(a.bent.z, b.bent.z) &&
               a.rays == b.rays && a.thickest == b.thickest;
    };
    std::atomic<std::int64_t> rays{0};
    TransferInputs inputs;
    inputs.rays = &rays;
    const auto one = transfer({50, 40}, {low, *tangents}, high, inputs, options, {1, {}});
    ASSERT_TRUE(one);
    EXPECT_EQ(rays, one->rays);
    for (const int threads : {2, 8}) {
        const auto many = transfer({50, 40}, {low, *tangents}, high, options, {threads, {}});
        ASSERT_TRUE(many);
        EXPECT_TRUE(same(*one, *many)) << threads;
    }
    on_every_target([&] {
        const auto again = transfer({50, 40}, {low, *tangents}, high, options);
        ASSERT_TRUE(again);
        EXPECT_TRUE(same(*one, *again));
    });
}

// For triangles that a ray meets from behind, the side counts from which it came.
TEST(SecondRays, OfBackFacesStartWhereTheRayCameFrom) {
    const MeshPart low = flat_square({16, 16});
    std::vector<MeshPart> high = only(inside_out(lifted(low, -0.25f)));
    high.push_back(lifted(low, -0.5f, 50.0f));
    TransferOptions options = second_maps(16);
    options.backfaces = true;
    options.front = options.back = {Reach::Unit::absolute, 1.0};
    const auto maps = transferred(low, high, {16, 16}, options);
    ASSERT_TRUE(maps);
    for_hits(*maps, [&](int i, int j) { ASSERT_EQ(maps->occlusion.at(i, j), 1.0f); });
}

}  // namespace
}  // namespace tex
