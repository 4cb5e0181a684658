// SPDX-License-Identifier: Apache-2.0

#include "kernels/trace.h"

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "rays/box_tree.h"
#include "reference/rays.h"
#include "unit/meshes.h"
#include "unit/solids.h"
#include "unit/targets.h"

namespace tex {
namespace {

using reference::PlainTriangle;
using reference::Point;

constexpr double kFar = 1e9;

Point plain_point(Float3 p) { return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)}; }

std::vector<PlainTriangle> plain_triangles(const MeshPart& part) {
    std::vector<PlainTriangle> triangles;
    for (std::size_t t = 0; t < part.triangles(); ++t) {
        PlainTriangle triangle;
        for (std::size_t k = 0; k < 3; ++k) triangle[k] = plain_point(part.positions[part.indices[3 * t + k]]);
        triangles.push_back(triangle);
    }
    return triangles;
}

Ray make_ray(const Point& o, const Point& to, Facing facing, double length = kFar) {
    const Point d{to[0] - o[0], to[1] - o[1], to[2] - o[2]};
    const double n = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    return {{o[0], o[1], o[2]}, {d[0] / n, d[1] / n, d[2] / n}, length, facing};
}

int sign_of(Facing facing) { return facing == Facing::front ? 1 : facing == Facing::back ? -1 : 0; }

RayHit one_hit(const BoxTree& tree, const Ray& ray) {
    RayHit hit;
    trace_rays(tree.view(), &ray, 1, &hit);
    return hit;
}

class Randoms {
public:
    explicit Randoms(unsigned seed) : random_(seed * 7919 + 1) {}
    double unit() { return static_cast<double>(random_() >> 4) / static_cast<double>(0x7fffffffU >> 4); }
    double around(double size) { return size * (2.0 * unit() - 1.0); }
    unsigned below(unsigned n) { return static_cast<unsigned>(random_() >> 8) % n; }

private:
    std::minstd_rand random_;
};

// Triangles of all shapes: needles, points, copies, flat, huge and tiny ones. `plain`: of one size.
MeshPart mixed_triangles(unsigned seed, int count, bool plain = false) {
    Randoms random(seed);
    MeshPart part;
    const auto f = [](double value) { return static_cast<float>(value); };
    const double scale = std::pow(10.0, random.around(static_cast<double>(seed % 4) * 5.0));
    for (int k = 0; k < count; ++k) {
        const unsigned kind = plain ? 7 : random.below(8);
        if (kind == 0 && k > 0) {  // a copy
            const auto of = random.below(static_cast<unsigned>(k));
            for (unsigned c = 0; c < 3; ++c) part.indices.push_back(part.indices[3 * of + c]);
            continue;
        }
        const double size = kind == 1 ? 1e-6 : kind == 2 ? 2.0 : 0.2;
        const double x = random.around(1.0), y = random.around(1.0), z = random.around(1.0);
        for (int c = 0; c < 3; ++c) {
            const double thin = kind == 3 ? 1e-5 : 1.0, flat = kind == 4 ? 0.0 : 1.0;
            part.positions.push_back({f(scale * (x + random.around(size))), f(scale * (y + thin * random.around(size))),
                                      f(scale * (z + flat * random.around(size)))});
            part.indices.push_back(static_cast<std::uint32_t>(part.positions.size() - 1));
        }
    }
    return part;
}

void expect_same_hit(const BoxTree& tree, const std::vector<PlainTriangle>& triangles, const Ray& ray) {
    const RayHit hit = one_hit(tree, ray);
    const auto wanted =
        reference::first_hit(triangles, {ray.origin[0], ray.origin[1], ray.origin[2]},
                             {ray.direction[0], ray.direction[1], ray.direction[2]}, ray.length, sign_of(ray.facing));
    ASSERT_EQ(hit.triangle != kNoHit, wanted.found);
    if (!wanted.found) return;
    ASSERT_EQ(hit.triangle, wanted.triangle);
    ASSERT_EQ(hit.t, wanted.t);
    for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(hit.weights[k], wanted.weights[k]);
}

constexpr Facing kFacings[] = {Facing::front, Facing::back, Facing::both};

// To a vertex, to a point of an edge, along an axis, or anywhere.
Ray aimed_ray(Randoms& random, const std::vector<PlainTriangle>& triangles, double scale) {
    const PlainTriangle& triangle = triangles[random.below(static_cast<unsigned>(triangles.size()))];
    const Facing facing = kFacings[random.below(3)];
    const Point from{random.around(2.0 * scale), random.around(2.0 * scale), random.around(2.0 * scale)};
    const Point &a = triangle[0], &b = triangle[1];
    const double length = random.below(4) == 0 ? 2.0 * scale * random.unit() : kFar * scale;
    switch (random.below(5)) {
        case 0: return make_ray(from, a, facing, length);
        case 1: return make_ray(from, {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2}, facing, length);
        case 2: return make_ray({a[0], a[1], 3.0 * scale}, {a[0], a[1], -scale}, facing, length);
        case 3: return make_ray({-3.0 * scale, a[1], b[2]}, {scale, a[1], b[2]}, facing, length);
        default:
            return make_ray(from, {random.around(scale), random.around(scale), random.around(scale)}, facing, length);
    }
}

TEST(Trace, HitsWhatEveryTriangleTestedByItselfSays) {
    on_every_target([] {
        for (unsigned seed = 0; seed < 24; ++seed) {
            const MeshPart part = mixed_triangles(seed, seed % 6 == 0 ? 3 : 300);
            const auto triangles = plain_triangles(part);
            const auto tree = BoxTree::build(Triangles({&part}), {});
            ASSERT_TRUE(tree);
            double scale = 1e-30;
            for (const Float3& p : part.positions) scale = std::max(scale, static_cast<double>(std::abs(p.x)));
            Randoms random(seed + 100);
            for (int k = 0; k < 800; ++k) {
                SCOPED_TRACE(::testing::Message() << seed << " " << k);
                expect_same_hit(*tree, triangles, aimed_ray(random, triangles, scale));
                if (::testing::Test::HasFatalFailure()) return;
            }
        }
    });
}

// Rays that look nearly the same way go through the tree together; these differ by a little, by much, or in one of
// them.
std::vector<Ray> neighbours_of(const Ray& ray, Randoms& random, double scale) {
    const double sizes[] = {0.0, 1e-9, 1e-4, 0.01, 0.3}, place = scale * sizes[random.below(5)],
                 turn = 0.1 * sizes[random.below(5)];
    const bool is_odd = random.below(3) == 0;
    std::vector<Ray> rays;
    for (int k = 0; k < 19; ++k) {
        Point from{}, to{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            from[axis] = ray.origin[axis] + random.around(place);
            to[axis] = from[axis] + (is_odd && k == 5 ? -1.0 : 1.0) * ray.direction[axis] + random.around(turn);
        }
        const Facing facing = random.below(4) == 0 ? kFacings[random.below(3)] : ray.facing;
        rays.push_back(make_ray(from, to, facing, random.below(8) == 0 ? scale * random.unit() : ray.length));
    }
    return rays;
}

TEST(Trace, NeighboursHitWhatTheyHitAlone) {
    on_every_target([] {
        for (unsigned seed = 0; seed < 12; ++seed) {
            const MeshPart part = seed % 3 == 0 ? wavy_part(60) : mixed_triangles(seed, seed == 4 ? 3 : 2000);
            const auto triangles = plain_triangles(part);
            const auto tree = BoxTree::build(Triangles({&part}), {});
            ASSERT_TRUE(tree);
            double scale = 1e-30;
            for (const Float3& p : part.positions) scale = std::max(scale, static_cast<double>(std::abs(p.x)));
            Randoms random(seed + 200);
            for (int k = 0; k < 150; ++k) {
                const std::vector<Ray> rays = neighbours_of(aimed_ray(random, triangles, scale), random, scale);
                std::vector<RayHit> hits(rays.size());
                trace_rays(tree->view(), rays.data(), rays.size(), hits.data());
                for (std::size_t r = 0; r < rays.size(); ++r) {
                    const RayHit alone = one_hit(*tree, rays[r]);
                    ASSERT_EQ(hits[r].triangle, alone.triangle) << seed << " " << k << " " << r;
                    ASSERT_EQ(hits[r].t, alone.t);
                    for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(hits[r].weights[c], alone.weights[c]);
                }
            }
        }
    });
}

// The reference above uses the same formulas. This one does not.
TEST(Trace, AgreesWithVolumesInLongDouble) {
    const MeshPart part = mixed_triangles(4, 400, true);
    const auto triangles = plain_triangles(part);
    const auto tree = BoxTree::build(Triangles({&part}), {});
    ASSERT_TRUE(tree);
    double scale = 0.0;
    for (const Float3& p : part.positions) scale = std::max(scale, static_cast<double>(std::abs(p.x)));
    Randoms random(7);
    int clear = 0;
    for (int k = 0; k < 4000; ++k) {
        const Ray ray = aimed_ray(random, triangles, scale);
        const Point origin{ray.origin[0], ray.origin[1], ray.origin[2]},
            direction{ray.direction[0], ray.direction[1], ray.direction[2]};
        const auto wanted = reference::clear_hit(triangles, origin, direction, ray.length, sign_of(ray.facing), 1e-6);
        const auto around = reference::clear_hit(triangles, origin, direction, ray.length, sign_of(ray.facing), -1e-6);
        if (wanted.found != around.found || (wanted.found && wanted.triangle != around.triangle)) continue;
        const RayHit hit = one_hit(*tree, ray);
        ASSERT_EQ(hit.triangle != kNoHit, wanted.found) << k;
        if (!wanted.found) continue;
        ++clear;
        EXPECT_NEAR(hit.t, wanted.t, 1e-7 * scale);
    }
    EXPECT_GT(clear, 500);
}

// A closed surface, seen from inside: every ray hits it, also through its vertices and along its edges.
TEST(Trace, LosesNoRayInAClosedMesh) {
    const MeshPart part = torus().part;
    const Solid cube = smooth_cube();
    for (const MeshPart* closed : {&cube.part, &part}) {
        MeshPart welded = *closed;  // the torus's seams and the cube's edges have equal positions only nearly
        for (Float3& p : welded.positions)
            p = {std::round(p.x * 1024.0f) / 1024.0f, std::round(p.y * 1024.0f) / 1024.0f,
                 std::round(p.z * 1024.0f) / 1024.0f};
        const auto tree = BoxTree::build(Triangles({&welded}), {});
        ASSERT_TRUE(tree);
        const Point inside = closed == &part ? Point{1.0, 0.01, 0.02} : Point{0.01, 0.02, -0.03};
        Randoms random(3);
        int rays = 0;
        for (std::size_t t = 0; t < welded.triangles(); ++t) {
            const PlainTriangle triangle = plain_triangles(welded)[t];
            for (int k = 0; k < 40; ++k) {
                const double v = k < 12 ? k / 12.0 : random.unit(), w = k < 12 ? 0.0 : random.unit() * (1.0 - v);
                Point to{};
                for (std::size_t axis = 0; axis < 3; ++axis)
                    to[axis] = (1.0 - v - w) * triangle[0][axis] + v * triangle[1][axis] + w * triangle[2][axis];
                ASSERT_NE(one_hit(*tree, make_ray(inside, to, Facing::back)).triangle, kNoHit) << t << " " << k;
                ++rays;
            }
        }
        EXPECT_GT(rays, 400);
    }
}

TEST(Trace, KnowsTheFrontOfATriangle) {
    MeshPart part;
    part.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    part.indices = {0, 1, 2};
    const auto tree = BoxTree::build(Triangles({&part}), {});
    ASSERT_TRUE(tree);
    const Ray down = make_ray({0.25, 0.25, 1.0}, {0.25, 0.25, 0.0}, Facing::front);
    EXPECT_EQ(one_hit(*tree, down).triangle, 0u);
    EXPECT_EQ(one_hit(*tree, down).t, 1.0);
    EXPECT_EQ(one_hit(*tree, down).weights[0], 0.5);
    Ray up = make_ray({0.25, 0.25, -1.0}, {0.25, 0.25, 0.0}, Facing::front);
    EXPECT_EQ(one_hit(*tree, up).triangle, kNoHit);
    up.facing = Facing::back;
    EXPECT_EQ(one_hit(*tree, up).triangle, 0u);
    up.length = 0.99;
    EXPECT_EQ(one_hit(*tree, up).triangle, kNoHit);
    up.length = 1.0;
    EXPECT_EQ(one_hit(*tree, up).triangle, 0u);
    const Ray on = make_ray({0.25, 0.25, 0.0}, {0.25, 0.25, -1.0}, Facing::front);  // starts on it
    EXPECT_EQ(one_hit(*tree, on).triangle, 0u);
    EXPECT_EQ(one_hit(*tree, on).t, 0.0);
}

TEST(Trace, FirstOfEqualTrianglesWins) {
    MeshPart part;
    part.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (int k = 0; k < 1000; ++k) part.indices.insert(part.indices.end(), {0, 1, 2});
    const auto tree = BoxTree::build(Triangles({&part}), {});
    ASSERT_TRUE(tree);
    EXPECT_EQ(one_hit(*tree, make_ray({0.25, 0.25, 1.0}, {0.25, 0.25, 0.0}, Facing::front)).triangle, 0u);
}

TEST(BoxTree, IsTheSameForEveryNumberOfThreads) {
    const MeshPart part = wavy_part(150);
    const Triangles triangles({&part});
    const auto one = BoxTree::build(triangles, {1, {}}), three = BoxTree::build(triangles, {3, {}});
    ASSERT_TRUE(one && three);
    Randoms random(5);
    for (int k = 0; k < 1000; ++k) {
        const Ray ray =
            make_ray({random.unit(), random.unit(), 2.0}, {random.unit(), random.unit(), 0.0}, Facing::both);
        const RayHit a = one_hit(*one, ray), b = one_hit(*three, ray);
        EXPECT_EQ(a.triangle, b.triangle);
        EXPECT_EQ(a.t, b.t);
    }
    EXPECT_EQ(std::memcmp(one->view().boxes, three->view().boxes, 100 * sizeof(Boxes)), 0);
}

TEST(BoxTree, FindsTheNearestPoint) {
    for (unsigned seed = 0; seed < 8; seed += 4) {
        const MeshPart part = mixed_triangles(seed, 200);
        const auto triangles = plain_triangles(part);
        const auto tree = BoxTree::build(Triangles({&part}), {});
        ASSERT_TRUE(tree);
        Randoms random(seed);
        for (int k = 0; k < 60; ++k) {
            const Point p{random.around(2.0), random.around(2.0), random.around(2.0)};
            const double wanted = reference::nearest_squared(triangles, p);
            const NearestPoint found = tree->nearest({p[0], p[1], p[2]});
            EXPECT_NEAR(std::sqrt(found.squared), std::sqrt(wanted), 1e-6);
            EXPECT_NE(tree->any_within({p[0], p[1], p[2]}, found.squared).triangle, kNoHit);
            EXPECT_EQ(tree->any_within({p[0], p[1], p[2]}, 0.999 * found.squared).triangle, kNoHit);
            EXPECT_EQ(tree->nearest({p[0], p[1], p[2]}, 0.99 * found.squared).triangle, kNoHit);
        }
    }
}

}  // namespace
}  // namespace tex
