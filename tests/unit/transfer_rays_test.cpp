// SPDX-License-Identifier: Apache-2.0
// The rays of transfer(): where they start, how far they reach, what they hit.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <tex/mesh.h>

#include "mesh/vectors.h"
#include "rays/ray_directions.h"
#include "rays/ray_work.h"
#include "unit/mesh_pictures.h"
#include "unit/solids.h"
#include "unit/transfers.h"

namespace tex {
namespace {

TEST(Transfer, ChoosesTheOutermostOrTheNearestHit) {
    const Extent extent{16, 16};
    const MeshPart low = flat_square(extent);
    std::vector<MeshPart> high;
    for (const float height : {0.5f, 2.0f, -0.25f}) high.push_back(lifted(low, height));
    TransferOptions options = all_maps();
    options.front = {Reach::Unit::absolute, 3.0};
    options.back = {Reach::Unit::absolute, 1.0};
    const auto height = [&] {
        const auto maps = transferred(low, high, extent, options);
        return maps ? maps->heights.at(8, 8) : -100.0f;
    };
    EXPECT_EQ(height(), 2.0f);
    options.hit = HitChoice::nearest;
    EXPECT_EQ(height(), -0.25f);
    options.back = {Reach::Unit::absolute, 0.1};
    EXPECT_EQ(height(), 0.5f);
    high[0] = inside_out(high[0]);  // seen from behind
    EXPECT_EQ(height(), 2.0f);
    options.backfaces = true;
    EXPECT_EQ(height(), 0.5f);
    options.hit = HitChoice::outermost;
    options.front = {Reach::Unit::percent, 5.0};  // of 22.6
    EXPECT_EQ(height(), 0.5f);
}

TEST(Transfer, CountsWhatIsMissedAndSaysWhatWouldHit) {
    const Extent extent{32, 32};
    const MeshPart low = flat_square(extent);
    TransferOptions options = all_maps();
    options.front = options.back = {Reach::Unit::absolute, 0.5};
    std::vector<MeshPart> high = only(lifted(low, 0.25f, 0.5f));  // over the lower left quarter
    const auto quarter = transferred(low, high, extent, options);
    ASSERT_TRUE(quarter);
    EXPECT_EQ(quarter->covered, 1024);
    EXPECT_EQ(quarter->missed, 768);
    EXPECT_EQ(quarter->hopeless, 768);
    EXPECT_EQ(quarter->origin.at(2, 30), TexelOrigin::hit);
    EXPECT_EQ(quarter->origin.at(30, 2), TexelOrigin::missed);
    EXPECT_EQ(quarter->heights.at(30, 2), 0.25f);  // of the nearest hit
    high.push_back(lifted(low, 2.0f));
    const auto farther = transferred(low, high, extent, options);
    ASSERT_TRUE(farther);
    EXPECT_EQ(farther->missed, 768);
    EXPECT_EQ(farther->hopeless, 0);
    EXPECT_NEAR(farther->needed_front, 2.0, 1e-6);
    EXPECT_EQ(farther->needed_back, 0.0);
    options.front = {Reach::Unit::absolute, farther->needed_front};
    EXPECT_EQ(transferred(low, high, extent, options)->missed, 0);
    high[1] = inside_out(lifted(low, 0.4f));
    const auto behind = transferred(low, high, extent, options);
    ASSERT_TRUE(behind);
    EXPECT_EQ(behind->missed, 768);
    EXPECT_EQ(behind->behind, 768);
    options.backfaces = true;
    EXPECT_EQ(transferred(low, high, extent, options)->behind, 1024);
}

// Around the sphere of radius 1 is another one, which is inside out. Of its normals, those stay that point outwards.
TEST(Transfer, BackFacesPointTowardsTheRay) {
    const MeshPart low = sphere().part;
    const MeshPart high = fine_sphere(64).part;
    TransferOptions options = all_maps();
    options.backfaces = true;
    options.front = options.back = {Reach::Unit::absolute, 0.5};
    for (const bool inwards : {false, true}) {
        for (const bool stored : {false, true}) {
            MeshPart turned = inside_out(high);
            if (!stored) turned.normals.clear();
            for (Float3& n : turned.normals) n = inwards ? Float3{-n.x, -n.y, -n.z} : n;
            const auto maps = transferred(low, only(turned), {64, 32}, options);
            ASSERT_TRUE(maps);
            EXPECT_EQ(maps->missed, 0);
            EXPECT_EQ(maps->backward, 0);
            const auto hits = for_hits(*maps, [&](int i, int j) {
                ASSERT_LT(degrees_between(vector_at(maps->object, i, j), unit_vector(position_at(*maps, i, j))), 3.0);
            });
            EXPECT_GT(hits, 1000);
        }
    }
}

float side_of_skew(const TransferredMaps& maps, const TransferredMaps& starts, int i, int j) {
    const Float3 p = position_at(maps, i, j), q = position_at(starts, i, j), n = vector_at(starts.object, i, j);
    const Float3 way{p.x - q.x, p.y - q.y, p.z - q.z};
    const float along = way.x * n.x + way.y * n.y + way.z * n.z;
    return std::sqrt(std::max(0.0f, way.x * way.x + way.y * way.y + way.z * way.z - along * along));
}

// The lean of a ray from the normal of its face, in degrees.
struct Lean {
    double mean = 0.0, most = 0.0, beyond = 0.0;  // beyond the width of hard edges
};

// The table of transfer-normals(1): around a cube with hard edges, 2 wide, lies a larger one. Straight rays meet it
// right above their start, except near edges; smooth rays meet it beside.
TEST(Transfer, StraightRaysDoNotSkewAndLeaveNoGap) {
    const MeshPart low = hard_cube(1.0f);
    const auto high = only(hard_cube(1.1f));
    const Extent extent{192, 128};
    TransferOptions options = all_maps();
    options.straight_width = {Reach::Unit::absolute, 0.2};
    const auto starts = transferred(low, only(low), extent, options);
    ASSERT_TRUE(starts);
    const auto lean_of = [&](RayMode rays) {
        options.rays = rays;
        const auto maps = transferred(low, high, extent, options);
        EXPECT_TRUE(maps);
        EXPECT_EQ(maps->missed, 0);
        Lean lean;
        const auto hits = for_hits(*maps, [&](int i, int j) {
            const auto skew = static_cast<double>(side_of_skew(*maps, *starts, i, j));
            const double degrees = std::atan2(skew, 0.1) * 57.29577951308232;
            const Float3 p = position_at(*starts, i, j);
            float at[3] = {std::abs(p.x), std::abs(p.y), std::abs(p.z)};
            std::sort(at, at + 3);
            lean.mean += degrees;
            lean.most = std::max(lean.most, degrees);
            if (at[1] < 0.8f) lean.beyond = std::max(lean.beyond, degrees);
        });
        lean.mean /= static_cast<double>(hits);
        return lean;
    };
    const Lean smooth = lean_of(RayMode::smooth), straight = lean_of(RayMode::straight);
    EXPECT_NEAR(smooth.mean, 36.4, 0.1);
    EXPECT_NEAR(smooth.beyond, 47.1, 0.1);
    EXPECT_NEAR(smooth.most, 54.6, 0.1);
    EXPECT_NEAR(straight.mean, 10.1, 0.1);
    EXPECT_NEAR(straight.most, 54.6, 0.1);
    EXPECT_LT(straight.beyond, 0.01);
}

// The directions at places of an edge are the same for both of its triangles.
TEST(Transfer, DirectionsOfRaysAreContinuous) {
    for (const MeshPart& part : {hard_cube(1.0f), smooth_cube().part, torus().part, wavy_part(7)}) {
        for (const RayMode mode : {RayMode::smooth, RayMode::straight}) {
            const auto directions = RayDirections::make(part, mode, 0.3, 30.0, {});
            ASSERT_TRUE(directions);
            int edges = 0;
            for (std::size_t a = 0; a < part.indices.size(); ++a) {
                for (std::size_t b = 0; b < part.indices.size(); ++b) {
                    const std::size_t a_next = a % 3 == 2 ? a - 2 : a + 1, b_next = b % 3 == 2 ? b - 2 : b + 1;
                    const auto at = [&](std::size_t corner) { return part.positions[part.indices[corner]]; };
                    if (!same(at(a), at(b_next)) || !same(at(a_next), at(b))) continue;
                    ++edges;
                    for (const double k : {0.0, 0.1, 0.5, 0.8}) {
                        std::array<double, 3> on_a{}, on_b{};
                        on_a[a % 3] = on_b[b_next % 3] = 1.0 - k;
                        on_a[a_next % 3] = on_b[b % 3] = k;
                        const Vector3 p = (1.0 - k) * vector_of(at(a)) + k * vector_of(at(a_next));
                        RayWork work;
                        const Vector3 gap = directions->at(a / 3, on_a, p, work) - directions->at(b / 3, on_b, p, work);
                        ASSERT_LT(dot(gap, gap), 1e-20);
                    }
                }
            }
            EXPECT_GT(edges, 10);
        }
    }
}

TEST(Transfer, FindsHowFarRaysMustReach) {
    const Solid ring = torus();
    for (const float radius : {0.35f, 0.45f}) {  // of the tube; that of the low mesh is 0.4
        const auto at = [&](float u, float v) -> Float3 {
            const Float3 n = ring.normal(u, v);
            const float a = 6.2831853f * u;
            return {std::cos(a) + radius * n.x, radius * n.y, -std::sin(a) + radius * n.z};
        };
        const auto maps = transferred(ring.part, only(grid_part(64, 48, at, ring.normal)), {128, 96});
        ASSERT_TRUE(maps);
        EXPECT_EQ(maps->missed, 0);
        EXPECT_LT(maps->front, 0.2);
        EXPECT_LT(maps->back, 0.2);
        EXPECT_GT(radius > 0.4f ? maps->front : maps->back, 0.05);
    }
}

}  // namespace
}  // namespace tex
