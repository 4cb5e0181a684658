// SPDX-License-Identifier: Apache-2.0
// Meshes that would make rays cost too much: copies cost nothing, others are refused. Costs are counted, not timed.

#include "rays/ray_work.h"

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/mesh.h>

#include "rays/box_tree.h"
#include "unit/solids.h"
#include "unit/transfers.h"

namespace tex {
namespace {

constexpr int kThousands = 80000;

void add_triangle(MeshPart& part, Float3 a, Float3 b, Float3 c) {
    for (const Float3& p : {a, b, c}) {
        part.indices.push_back(static_cast<std::uint32_t>(part.positions.size()));
        part.positions.push_back(p);
    }
}

Float3 on_circle(int k, float radius, float z) {
    const double angle = 6.283185307179586 * k / kThousands;
    return {radius * static_cast<float>(std::cos(angle)), radius * static_cast<float>(std::sin(angle)), z};
}

// A disc of triangles that meet in its middle.
MeshPart fan() {
    MeshPart part;
    for (int k = 0; k < kThousands; ++k)
        add_triangle(part, {0.0f, 0.0f, 0.0f}, on_circle(k, 3.0f, 0.0f), on_circle(k + 1, 3.0f, 0.0f));
    return part;
}

// Triangles in one plane, none of which is the copy of another one.
MeshPart overlapping() {
    std::minstd_rand random(1);
    const auto some = [&] { return static_cast<float>(random() >> 8) / static_cast<float>(1 << 23); };
    MeshPart part;
    for (int k = 0; k < kThousands; ++k) {
        const float x = some(), y = some();
        add_triangle(part, {x - 2.0f, y - 2.0f, 0.0f}, {x + 4.0f, y - 2.0f, 0.0f}, {x - 2.0f, y + 4.0f, 0.0f});
    }
    return part;
}

// Thin triangles at all angles, each as long as all of them together.
MeshPart slivers() {
    MeshPart part;
    for (int k = 0; k < kThousands; ++k) {
        const Float3 to = on_circle(k, 4.0f, 0.0f);
        const float x = static_cast<float>(k) / kThousands, y = 0.5f;
        add_triangle(part, {x - to.x, y - to.y, 0.0f}, {x + to.x, y + to.y, 0.0f}, {x - to.x, y - to.y + 1e-4f, 0.0f});
    }
    return part;
}

// Triangles around one edge, each with its own place in the map.
MeshPart book() {
    MeshPart part;
    part.uvs.resize(1);
    const int side = 200;
    for (int k = 0; k < side * side; ++k) {
        add_triangle(part, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, on_circle(k, 1.0f, 0.5f));
        const Float3 out = on_circle(k, 1.0f, 0.0f);
        const float step = 1.0f / static_cast<float>(side), u = step * static_cast<float>(k % side),
                    v = step * static_cast<float>(k / side);
        for (const Float2& uv : {Float2{u, v}, Float2{u + step, v}, Float2{u, v + step}}) {
            part.uvs[0].push_back(uv);
            part.normals.push_back({-out.y, out.x, 0.0f});
        }
    }
    return part;
}

std::string refusal_of(const Result<TransferredMaps>& maps) {
    EXPECT_FALSE(maps);
    if (maps) return {};
    EXPECT_EQ(maps.error().code, ErrorCode::unsupported);
    return maps.error().reason;
}

// The steps of rays from above to places of the square from 0 to 1.
std::int64_t steps_from_above(const MeshPart& part) {
    const auto tree = BoxTree::build(Triangles({&part}), {});
    EXPECT_TRUE(tree);
    std::vector<Ray> rays;
    for (int k = 0; k < 1024; ++k)
        rays.push_back({{(k % 32 + 0.25) / 32.0, (k / 32 + 0.75) / 32.0, 5.0}, {0.0, 0.0, -1.0}, 10.0, Facing::both});
    std::vector<RayHit> hits(rays.size());
    const std::int64_t steps = trace_rays(tree->view(), rays.data(), rays.size(), hits.data());
    for (const RayHit& hit : hits) EXPECT_NE(hit.triangle, kNoHit);
    return steps;
}

TEST(RayWork, CopiesOfTrianglesCostNothing) {
    const MeshPart one = square(0.0f, 1.0f);
    for (const int copies : {1, 3, 100, 30000}) {
        MeshPart many = square(0.0f, 1.0f, copies);
        EXPECT_LE(steps_from_above(many), 2 * 1024) << copies;
        add_triangle(many, {0.25f, 0.25f, 1.0f}, {0.75f, 0.25f, 1.0f}, {0.25f, 0.75f, 1.0f});
        EXPECT_LE(steps_from_above(many), 4 * 1024) << copies;
        const Extent extent{24, 24};
        const auto maps = transferred(one, only(square(0.0f, 1.0f, copies)), extent),
                   wanted = transferred(one, only(one), extent);
        ASSERT_TRUE(maps && wanted);
        EXPECT_TRUE(same_maps(*maps, *wanted)) << copies;
    }
}

TEST(RayWork, OfHonestMeshesIsFarBelowTheLimit) {
    const MeshPart hill = wavy_part(300);
    EXPECT_LE(steps_from_above(hill), 30 * 1024);
}

// Boxes with a common centre are not copies.
TEST(RayWork, StaysLowIfTrianglesHaveACommonCentre) {
    MeshPart nested;
    for (int k = 1; k <= kThousands; ++k) {
        const float r = 2.0f + static_cast<float>(k);
        add_triangle(nested, {-r, -r, -r}, {r, -r, 0.0f}, {r, r, r});
    }
    const auto tree = BoxTree::build(Triangles({&nested}), {});
    ASSERT_TRUE(tree);
    std::vector<Ray> rays(64, Ray{{0.9, 0.1, 1e6}, {0.0, 0.0, -1.0}, 1e7, Facing::both});
    std::vector<RayHit> hits(64);
    trace_rays(tree->view(), rays.data(), rays.size(), hits.data());
    for (const RayHit& hit : hits) EXPECT_NE(hit.triangle, kNoHit);
}

constexpr Extent kWide{512, 4};  // the rays of a row are counted together

TEST(RayWork, TooManyHighTrianglesOverEachOtherAreRefused) {
    const MeshPart low = square(0.0f, 1.0f);
    for (const MeshPart& high : {fan(), overlapping(), slivers()}) {
        TransferOptions options;
        const std::string by_itself = refusal_of(transferred(low, only(high), kWide, options));
        EXPECT_EQ(by_itself,
                  "too many triangles of the high mesh lie over each other, or are long and thin: each ray would be "
                  "tested against thousands. Remove those that lie over others, and divide long ones");
        options.front = options.back = length(1.0);
        for (const HitChoice hit : {HitChoice::outermost, HitChoice::nearest}) {
            options.hit = hit;
            EXPECT_EQ(refusal_of(transferred(low, only(high), kWide, options)), by_itself);
        }
    }
}

// Rays of the map meet a flat mesh; those that start there meet the others.
TEST(RayWork, SecondRaysCountToo) {
    const MeshPart low = square(0.0f, 1.0f);
    std::vector<MeshPart> high = only(low);
    high.push_back(lifted(overlapping(), 0.5f));
    TransferOptions options;
    options.front = options.back = length(0.25);
    EXPECT_TRUE(transferred(low, high, kWide, options));
    options.thickness = true;
    EXPECT_TRUE(transferred(low, high, kWide, options));
    options.thickness = false;
    options.occlusion = true;
    EXPECT_TRUE(transferred(low, high, kWide, options));  // any triangle closes a ray
    options.occlusion = false;
    options.thickness = true;
    high[1] = lifted(high[1], -1.0f);
    EXPECT_NE(refusal_of(transferred(low, high, kWide, options)).find("of the high mesh"), std::string::npos);
    high[1] = lifted(slivers(), 0.5f);
    options.thickness = false;
    options.occlusion = true;
    EXPECT_NE(refusal_of(transferred(low, high, kWide, options)).find("of the high mesh"), std::string::npos);
}

TEST(RayWork, HardEdgesCountForTheLowMesh) {
    const MeshPart low = book();
    const auto high = only(sphere().part);
    TransferOptions options;
    options.front = options.back = length(2.0);
    options.rays = RayMode::straight;
    EXPECT_EQ(refusal_of(transferred(low, high, {256, 256}, options)).substr(0, 39),
              "too many of its triangles lie over each");
    options.front = options.back = {};
    EXPECT_EQ(refusal_of(transferred(low, high, {256, 256}, options)).substr(0, 39),
              "too many of its triangles lie over each");
}

// What the map alone says is said before the high mesh is looked at.
TEST(RayWork, CoverageIsRefusedFirst) {
    const MeshPart low = square(0.0f, 1.0f, kThousands);
    EXPECT_EQ(refusal_of(transferred(low, only(overlapping()), {256, 256})),
              "its triangles cover the map more than a thousand times");
}

TEST(RayWork, EndsInTheSamePlaceForEveryNumberOfThreads) {
    CostlyPiece pieces;
    EXPECT_TRUE(pieces.check());
    EXPECT_FALSE(pieces.is_before(1000));
    pieces.see(7, RaySide::low);
    EXPECT_TRUE(pieces.is_before(8));
    EXPECT_FALSE(pieces.is_before(7));
    pieces.see(5, RaySide::high);
    pieces.see(6, RaySide::low);
    EXPECT_TRUE(pieces.is_before(6));
    EXPECT_NE(pieces.check().error().reason.find("of the high mesh"), std::string::npos);
    RayWork work;
    work.add(0, RayWork::kMostSteps * RayWork::kReserve);
    EXPECT_TRUE(work.is_fair());
    work.add(1, RayWork::kMostSteps + 1);
    EXPECT_FALSE(work.is_fair());
    work.add(1, 0);
    EXPECT_TRUE(work.is_fair());
}

}  // namespace
}  // namespace tex
