// SPDX-License-Identifier: Apache-2.0
// What transfer() may be given beside the meshes: cages, skew, offsets, groups of parts.

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/transfer.h>

#include "rays/ray_groups.h"
#include "unit/transfers.h"

namespace tex {
namespace {

// A sphere whose cage is a larger one: its rays are those along normals.
TEST(TransferInputs, ACageAlongTheNormalsIsAConstantFront) {
    const Solid ball = sphere();
    const auto grown = [&](float r) {
        return grid_part(
            16, 8,
            [&](float u, float v) {
                return Float3{r * ball.normal(u, v).x, r * ball.normal(u, v).y, r * ball.normal(u, v).z};
            },
            ball.normal);
    };
    const MeshPart cage = grown(1.25f);
    const auto high = only(grid_part(60, 30, ball.normal, ball.normal));
    TransferInputs inputs;
    inputs.cage = &cage;
    TransferOptions options = all_maps();
    options.back = length(0.1);
    const auto caged = guided(ball.part, high, {96, 64}, inputs, options);
    ASSERT_TRUE(caged) << caged.error().message();
    EXPECT_NEAR(caged->front, 0.25, 1e-6);
    EXPECT_EQ(caged->missed, 0);
    for_hits(*caged, [&](int i, int j) {  // rays run through the centre
        const Float3 n = unit_vector(position_at(*caged, i, j));
        ASSERT_LT(degrees_between(n, vector_at(caged->object, i, j)), 1e-3);
        const Float3 p = position_at(*caged, i, j);
        ASSERT_NEAR(std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z), 1.0f, 0.01f);
    });
}

// A part of the low mesh gets what the whole gets there: its rays turn at its border as if the rest were there.
TEST(TransferInputs, ThePartsOfAMeshMakeTheMapOfTheWhole) {
    const Solid ball = sphere();
    const auto high = only(grid_part(60, 30, ball.normal, ball.normal));
    for (const RayMode rays : {RayMode::smooth, RayMode::straight}) {
        TransferOptions options = all_maps();
        options.rays = rays;
        options.straight_angle = 5.0;  // most edges are hard
        const auto whole = guided(ball.part, high, {96, 64}, {}, options);
        ASSERT_TRUE(whole) << whole.error().message();
        std::int64_t hits = 0;
        const std::size_t half = ball.part.indices.size() / 6 * 3;
        for (const bool is_first : {true, false}) {
            MeshPart own = ball.part, rest = ball.part;
            MeshPart &head = is_first ? own : rest, &tail = is_first ? rest : own;
            own.quads.clear();
            rest.quads.clear();
            head.indices.resize(half);
            tail.indices.erase(tail.indices.begin(), tail.indices.begin() + static_cast<std::ptrdiff_t>(half));
            rest.uvs.clear();
            TransferInputs inputs;
            inputs.around = &rest;
            const auto part = guided(own, high, {96, 64}, inputs, options);
            ASSERT_TRUE(part) << part.error().message();
            EXPECT_NEAR(part->front, whole->front, 1e-9);
            EXPECT_NEAR(part->back, whole->back, 1e-9);
            EXPECT_EQ(part->diagonal, whole->diagonal);
            hits += for_hits(*part, [&](int i, int j) {
                ASSERT_LT(degrees_between(vector_at(part->object, i, j), vector_at(whole->object, i, j)), 1e-4);
                ASSERT_NEAR(part->heights.at(i, j), whole->heights.at(i, j), 1e-6f);
            });
            inputs.around = nullptr;
            const auto alone = guided(own, high, {96, 64}, inputs, options);
            ASSERT_TRUE(alone);
            double most = 0.0;
            for_hits(*alone, [&](int i, int j) {
                const double height = static_cast<double>(alone->heights.at(i, j));
                most = std::max(most, std::abs(height - static_cast<double>(whole->heights.at(i, j))));
            });
            EXPECT_GT(most, 1e-4) << "without the rest, rays lean at the border";
        }
        EXPECT_EQ(hits, whole->covered);
    }
    MeshPart broken = ball.part;
    broken.indices[0] = 1u << 20;
    TransferInputs inputs;
    inputs.around = &broken;
    EXPECT_EQ(guided(ball.part, high, {96, 64}, inputs).error().code, ErrorCode::bad_data);
}

TEST(TransferInputs, RaysRunFromTheCageToTheLowMesh) {
    const Extent extent{16, 16};
    const MeshPart low = flat_square(extent);
    MeshPart cage = lifted(low, 2.0f);
    for (Float3& p : cage.positions) p = {p.x + 1.0f, p.y, p.z};
    std::vector<MeshPart> high = only(lifted(low, 1.0f, 4.0f));
    for (Float3& p : high[0].positions) p = {p.x - 16.0f, p.y - 16.0f, p.z};
    TransferInputs inputs;
    inputs.cage = &cage;
    const auto maps = guided(low, high, extent, inputs);
    ASSERT_TRUE(maps) << maps.error().message();
    EXPECT_NEAR(maps->front, std::sqrt(5.0), 1e-6);
    EXPECT_EQ(maps->missed, 0);
    for_hits(*maps, [&](int i, int j) {
        const Float3 p = position_at(*maps, i, j);
        ASSERT_NEAR(p.x, static_cast<float>(i) + 1.0f, 1e-5f);  // half a texel, and half of the way aside
        ASSERT_NEAR(p.y, 15.5f - static_cast<float>(j), 1e-5f);
        ASSERT_NEAR(p.z, 1.0f, 1e-6f);
        ASSERT_NEAR(maps->heights.at(i, j), 0.5f * std::sqrt(5.0f), 1e-5f);
    });
    // What lies beyond the cage is not seen.
    high[0] = lifted(high[0], 1.5f);
    const auto beyond = guided(low, high, extent, inputs);
    EXPECT_FALSE(beyond);
    // A cage that touches the low mesh has the rays of `rays`.
    inputs.cage = &low;
    TransferOptions options = all_maps();
    options.back = length(1.0);
    const auto touching = guided(low, only(lifted(low, -0.5f)), extent, inputs, options);
    ASSERT_TRUE(touching) << touching.error().message();
    EXPECT_EQ(touching->front, 0.0);
    EXPECT_EQ(touching->missed, 0);
}

TEST(TransferInputs, SkewMixesSmoothAndStraightRays) {
    const MeshPart low = hard_cube(1.0f);
    const auto high = only(hard_cube(1.1f));
    const Extent extent{96, 64};
    TransferOptions options = all_maps();
    options.front = options.back = length(0.3);
    const auto smooth = guided(low, high, extent, {}, options);
    options.rays = RayMode::straight;
    options.straight_width = length(0.0);
    const auto straight = guided(low, high, extent, {}, options);
    ASSERT_TRUE(smooth && straight);
    for (const float value : {0.0f, 1.0f}) {
        const Plane<float> skew({7, 3}, value);
        TransferInputs inputs;
        inputs.skew = &skew;
        const auto maps = guided(low, high, extent, inputs, options);
        ASSERT_TRUE(maps);
        EXPECT_TRUE(same_maps(*maps, value == 0.0f ? *smooth : *straight));
    }
    // From left to right; texels of the map are eight times as fine.
    Plane<float> skew({12, 8});
    for (int j = 0; j < 8; ++j) {
        for (int i = 0; i < 12; ++i) skew.at(i, j) = static_cast<float>(i) / 11.0f;
    }
    TransferInputs inputs;
    inputs.skew = &skew;
    const auto starts = guided(low, only(low), extent, {}, options);
    const auto maps = guided(low, high, extent, inputs, options);
    ASSERT_TRUE(maps && starts);
    const auto way = [&](const TransferredMaps& to, int i, int j) {
        const Float3 p = position_at(to, i, j), q = position_at(*starts, i, j);
        return unit_vector({p.x - q.x, p.y - q.y, p.z - q.z});
    };
    const auto hits = for_hits(*maps, [&](int i, int j) {
        if (smooth->origin.at(i, j) != TexelOrigin::hit || straight->origin.at(i, j) != TexelOrigin::hit) return;
        const double at = std::min(11.0, std::max(0.0, (i + 0.5) / 8.0 - 0.5));
        const auto k = static_cast<float>(at / 11.0);
        const Float3 a = way(*smooth, i, j), b = way(*straight, i, j);
        const Float3 truth = unit_vector({(1 - k) * a.x + k * b.x, (1 - k) * a.y + k * b.y, (1 - k) * a.z + k * b.z});
        ASSERT_LT(degrees_between(way(*maps, i, j), truth), 1e-3) << i << " " << j;
    });
    EXPECT_GT(hits, 4000);
}

TEST(TransferInputs, OffsetsScaleTheFront) {
    const Extent extent{32, 16};
    const MeshPart low = flat_square(extent);
    std::vector<MeshPart> high = only(lifted(low, 1.0f));
    high.push_back(lifted(low, -0.5f));
    Plane<float> offset({2, 1}, 0.5f);
    offset.at(1, 0) = 1.5f;
    TransferInputs inputs;
    inputs.offset = &offset;
    TransferOptions options = all_maps();
    options.front = options.back = length(1.0);
    const auto maps = guided(low, high, extent, inputs, options);
    ASSERT_TRUE(maps);
    EXPECT_EQ(maps->missed, 0);
    // The factor is 0.5 up to a quarter of the map, and 1 in its middle.
    for_hits(*maps, [&](int i, int j) { ASSERT_EQ(maps->heights.at(i, j), i < 16 ? -0.5f : 1.0f) << i; });
}

TEST(TransferInputs, GroupsMeetTheirOwnPartsAlone) {
    const Extent extent{32, 16};
    const MeshPart low = flat_square(extent);  // two triangles
    const auto upper = [&](float height) { return lifted(low, height); };
    std::vector<MeshPart> high = {upper(0.25f), upper(0.75f), upper(0.5f)};
    TransferInputs inputs;
    inputs.low_groups = {7, 3};
    inputs.high_groups = {3, 7, 7};
    TransferOptions options = all_maps();
    options.front = options.back = length(1.0);
    options.occlusion = true;
    options.rays_per_hit = 8;
    const auto maps = guided(low, high, extent, inputs, options);
    ASSERT_TRUE(maps) << maps.error().message();
    int triangles[2] = {};
    for_hits(*maps, [&](int i, int j) {
        const bool first = maps->heights.at(i, j) == 0.75f;
        ++triangles[first ? 0 : 1];
        ASSERT_TRUE(first || maps->heights.at(i, j) == 0.25f);
        if (first) {
            ASSERT_EQ(maps->occlusion.at(i, j), 1.0f);
        }
        // Second rays meet all parts.
        if (!first && i > 8 && i < 24 && j > 4 && j < 12) {
            ASSERT_EQ(maps->occlusion.at(i, j), 0.0f);
        }
    });
    EXPECT_EQ(triangles[0] + triangles[1], 512);
    EXPECT_NEAR(triangles[0], 256, 32);
    // The reach follows from each group alone.
    options.front = options.back = {};
    const auto found = guided(low, high, extent, inputs, options);
    ASSERT_TRUE(found);
    EXPECT_GT(found->front, 0.75);
    inputs.high_groups = {3, 3, 3};
    const auto half = guided(low, high, extent, inputs, options);
    ASSERT_TRUE(half);
    EXPECT_EQ(half->missed, triangles[0]);
    EXPECT_EQ(half->hopeless, half->missed);
    inputs.high_groups = {1, 1, 1};
    const auto none = guided(low, high, extent, inputs, options);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().reason, "no part of the high mesh belongs to one of the low mesh");
}

TEST(TransferInputs, AreRefusedIfTheyDoNotFit) {
    const Extent extent{8, 8};
    const MeshPart low = flat_square(extent), cage = wavy_part(3);
    const auto high = only(low);
    const Plane<float> good({2, 2}, 0.5f), empty, large({2, 2}, 1.5f), negative({1, 1}, -1.0f);
    const auto reason = [&](const TransferInputs& inputs, RayMode rays = RayMode::straight) {
        TransferOptions options;
        options.rays = rays;
        const auto maps = guided(low, high, extent, inputs, options);
        return maps ? std::string() : maps.error().reason;
    };
    TransferInputs inputs;
    inputs.cage = &cage;
    EXPECT_EQ(reason(inputs), "cage: must have the triangles of the low mesh, 2, but has 18");
    inputs.cage = &low;
    inputs.offset = &good;
    EXPECT_EQ(reason(inputs), "cage: decides where rays start, so skew and offset mean nothing");
    inputs = {};
    inputs.skew = &good;
    EXPECT_EQ(reason(inputs, RayMode::smooth), "skew: needs RayMode::straight");
    EXPECT_EQ(reason(inputs), "");
    inputs.skew = &large;
    EXPECT_EQ(reason(inputs), "skew: a value at column 0 of row 0 is not between 0 and 1");
    inputs.skew = &empty;
    EXPECT_EQ(reason(inputs), "skew: the picture is empty");
    inputs.skew = nullptr;
    inputs.offset = &large;
    EXPECT_EQ(reason(inputs), "");
    inputs.offset = &negative;
    EXPECT_EQ(reason(inputs), "offset: a value at column 0 of row 0 is negative or not finite");
    inputs = {};
    inputs.low_groups = {1};
    inputs.high_groups = {1};
    EXPECT_EQ(reason(inputs), "low_groups: must have a number for each triangle of the low mesh");
    inputs.low_groups = {1, 1};
    inputs.high_groups = {};
    EXPECT_EQ(reason(inputs), "high_groups: must have a number for each part of the high mesh");
    inputs = {};
    inputs.high_ids = {1, 2};
    EXPECT_EQ(reason(inputs), "high_ids: must have a number for each part of the high mesh");
    inputs.high_ids = {-1};
    EXPECT_EQ(reason(inputs), "high_ids: must be 0 or more");
    inputs = {};
    inputs.high_details.resize(2);
    EXPECT_EQ(reason(inputs), "high_details: must have one for each part of the high mesh");
    const NormalMap map = bumpy_map({4, 4});
    inputs.high_details.resize(1);
    inputs.high_details[0].normals = &map;
    EXPECT_EQ(reason(inputs), "high_details: part 0: has a normal map, but no tangents");
    inputs.high_details[0].uv_set = 1;
    EXPECT_EQ(reason(inputs), "high_details: part 0: has no such set of UVs");
}

// Trees that are kept change no map, whatever was asked for before; the same parts get the same tree.
TEST(TransferInputs, SharedTreesChangeNothing) {
    const MeshPart low = flat_square({16, 16});
    std::vector<MeshPart> high = {lifted(low, 1.0f), lifted(low, 2.0f)};
    TransferInputs plain, shared;
    const auto same = [&](const std::vector<int>& low_groups, const std::vector<int>& high_groups) {
        plain.low_groups = shared.low_groups = low_groups;
        plain.high_groups = shared.high_groups = high_groups;
        const auto a = guided(low, high, {16, 16}, plain), b = guided(low, high, {16, 16}, shared);
        ASSERT_TRUE(a && b);
        EXPECT_TRUE(same_maps(*a, *b));
        EXPECT_EQ(a->rays, b->rays);
    };
    shared.trees = share_trees();
    for (int k = 0; k < 2; ++k) {
        same({}, {});
        same({0, 0}, {0, 1});
        same({0, 1}, {0, 1});
    }
    high = {lifted(low, 1.5f)};  // another mesh, perhaps at the same place
    same({}, {});
    plain.high_places = shared.high_places = {{0, "a"}, {0, "b", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.5}}};
    same({}, {});

    const auto first = RayGroups::make(low, high, shared, false, {}, {});
    ASSERT_TRUE(first);
    const auto meanwhile = RayGroups::make(low, high, shared, false, {}, {});
    ASSERT_TRUE(meanwhile);
    EXPECT_NE(first->whole().target, meanwhile->whole().target) << "somebody uses it";
}

TEST(TransferInputs, SharedTreesAreMadeOnce) {
    const MeshPart low = flat_square({16, 16});
    const std::vector<MeshPart> high = {lifted(low, 1.0f), lifted(low, 2.0f)};
    TransferInputs inputs;
    inputs.trees = share_trees();
    std::vector<std::shared_ptr<const RayTarget>> targets;
    for (int k = 0; k < 2; ++k) {
        const auto groups = RayGroups::make(low, high, inputs, false, {}, {});
        ASSERT_TRUE(groups);
        targets.push_back(groups->whole().target);
    }
    EXPECT_EQ(targets[0], targets[1]);
}

}  // namespace
}  // namespace tex
