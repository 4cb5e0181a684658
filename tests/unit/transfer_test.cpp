// SPDX-License-Identifier: Apache-2.0

#include <tex/mesh.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/bake.h>

#include "unit/targets.h"
#include "unit/transfers.h"

namespace tex {
namespace {

TEST(Transfer, FromAMeshToItselfIsFlat) {
    std::vector<MeshPart> parts = {wavy_part(20, true)};
    for (const Solid& solid : {sphere(), torus(), smooth_cube()}) parts.push_back(solid.part);
    for (const MeshPart& part : parts) {
        for (const auto& decoder : kDecoderNames) {
            for (const HitChoice hit : {HitChoice::outermost, HitChoice::nearest}) {
                TransferOptions options = all_maps();
                options.hit = hit;
                const auto maps = transferred(part, only(part), {128, 96}, options, decoder.value);
                ASSERT_TRUE(maps) << maps.error().message();
                EXPECT_EQ(maps->missed, 0);
                EXPECT_EQ(maps->backward, 0);
                const auto hits = for_hits(*maps, [&](int i, int j) {
                    ASSERT_LE(std::abs(maps->map.x.at(i, j)), 1e-6f) << decoder.name << i << " " << j;
                    ASSERT_LE(std::abs(maps->map.y.at(i, j)), 1e-6f);
                    ASSERT_NEAR(maps->map.z.at(i, j), 1.0f, 1e-6f);
                    ASSERT_NEAR(maps->heights.at(i, j), 0.0f, 1e-6f);
                });
                EXPECT_EQ(hits, maps->covered);
                EXPECT_GT(hits, 4000);
            }
        }
    }
}

TEST(Transfer, OfAHeightFieldIsWhatBakeMakesOfIt) {
    const Extent extent{48, 32};
    HeightField field{Plane<float>(extent), 3.0f, 3.0f, Wrap::clamp, Wrap::clamp};
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i)
            field.height.at(i, j) =
                0.5f + 0.5f * std::sin(0.3f * static_cast<float>(i)) * std::cos(0.2f * static_cast<float>(j + i));
    }
    const auto baked = bake(field);
    ASSERT_TRUE(baked);
    MeshPart high;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            high.positions.push_back({static_cast<float>(i) + 0.5f, static_cast<float>(extent.height - j) - 0.5f,
                                      3.0f * field.height.at(i, j) - 1.0f});
            high.normals.push_back(vector_at(*baked, i, j));
            if (i == 0 || j == 0) continue;
            const auto c = static_cast<std::uint32_t>(j * extent.width + i), a = c - 1,
                       above = c - static_cast<std::uint32_t>(extent.width);
            for (const std::uint32_t v : {a, c, above, a, above, above - 1}) high.indices.push_back(v);
        }
    }
    const auto maps = transferred(flat_square(extent), only(high), extent);
    ASSERT_TRUE(maps) << maps.error().message();
    EXPECT_EQ(maps->missed, 0);
    const auto hits = for_hits(*maps, [&](int i, int j) {
        ASSERT_LT(degrees_between(vector_at(maps->map, i, j), vector_at(*baked, i, j)), 1e-4) << i << " " << j;
        ASSERT_NEAR(maps->heights.at(i, j), 3.0f * field.height.at(i, j) - 1.0f, 1e-6f);
    });
    EXPECT_EQ(hits, extent.texels());
}

Float3 torus_normal(Float3 p) {
    const float ring = std::sqrt(p.x * p.x + p.z * p.z);
    return unit_vector({p.x - p.x / ring, p.y, p.z - p.z / ring});
}

// The interpolated normals of a sphere are exact wherever it is hit; those of a torus are the better, the finer it is.
TEST(Transfer, HitsSpheresAndToriWhereTheirFormulasSay) {
    const Solid ball = sphere();
    const auto fine_ball = only(grid_part(128, 64, ball.normal, ball.normal));
    const auto on_ball = transferred(ball.part, fine_ball, {160, 120});
    ASSERT_TRUE(on_ball) << on_ball.error().message();
    EXPECT_EQ(on_ball->missed, 0);
    const auto hits = for_hits(*on_ball, [&](int i, int j) {
        const Float3 p = position_at(*on_ball, i, j);
        ASSERT_LT(degrees_between(vector_at(on_ball->object, i, j), unit_vector(p)), 1e-4);
        ASSERT_NEAR(std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z), 1.0f, 1e-3f);
    });
    EXPECT_EQ(hits, 160 * 120);

    const Solid ring = torus();
    const auto at = [&](float u, float v) -> Float3 {
        const Float3 n = ring.normal(u, v);
        const float a = 6.2831853f * u;
        return {std::cos(a) + 0.4f * n.x, 0.4f * n.y, -std::sin(a) + 0.4f * n.z};
    };
    double worst[2] = {};
    for (int fine = 0; fine < 2; ++fine) {
        const auto high = only(grid_part(100 << fine, 50 << fine, at, ring.normal));
        const auto maps = transferred(ring.part, high, {128, 96});
        ASSERT_TRUE(maps) << maps.error().message();
        EXPECT_EQ(maps->missed, 0);
        for_hits(*maps, [&](int i, int j) {
            const double angle = degrees_between(vector_at(maps->object, i, j), torus_normal(position_at(*maps, i, j)));
            worst[fine] = std::max(worst[fine], angle);
        });
    }
    EXPECT_LT(worst[0], 0.15);
    EXPECT_LT(worst[1], 0.3 * worst[0]);
}

// Twelve triangles with smooth normals, and the same without normals: each texel shows the normal of its face.
TEST(Transfer, MakesSmoothCubesFlat) {
    const Solid cube = smooth_cube();
    MeshPart bare = cube.part;
    bare.normals.clear();
    for (const auto& decoder : kDecoderNames) {
        const Extent extent{192, 128};
        const auto maps = transferred(cube.part, only(bare), extent, all_maps(), decoder.value);
        ASSERT_TRUE(maps) << maps.error().message();
        EXPECT_EQ(maps->missed, 0);
        const NormalMap truth = surface_map(cube, extent);
        for_hits(*maps, [&](int i, int j) {
            ASSERT_LT(degrees_between(vector_at(maps->object, i, j), vector_at(truth, i, j)), 1e-4) << i << " " << j;
        });
        const auto tangents = make_tangents(cube.part);
        ASSERT_TRUE(tangents);
        const auto seen = to_object_space(maps->map, {cube.part, *tangents, 0, decoder.value});
        ASSERT_TRUE(seen);
        EXPECT_LT(angles_between(truth, seen->map, seen->coverage).max, 1e-4) << decoder.name;
    }
}

TEST(Transfer, InObjectSpaceAndConvertedIsInTangentSpace) {
    const Solid ring = torus();
    const auto high = only(grid_part(
        60, 40,
        [&](float u, float v) {
            const Float3 n = ring.normal(u, v);
            const float a = 6.2831853f * u, r = 0.4f + 0.02f * std::sin(50.0f * u) * std::sin(40.0f * v);
            return Float3{std::cos(a) + r * n.x, r * n.y, -std::sin(a) + r * n.z};
        },
        ring.normal));
    const auto tangents = make_tangents(ring.part);
    ASSERT_TRUE(tangents);
    const auto maps = transferred(ring.part, high, {200, 100});
    ASSERT_TRUE(maps);
    const auto converted = to_tangent_space(maps->object, {ring.part, *tangents});
    ASSERT_TRUE(converted);
    EXPECT_EQ(converted->covered, maps->covered);
    EXPECT_LT(angles_between(maps->map, converted->map, converted->coverage).max, 1e-4);
}

// Around z, sums of x and y change their order, and nothing else.
MeshPart turned(MeshPart part) {
    const auto turn = [](Float3& v) { v = {-v.y, v.x, v.z}; };
    std::for_each(part.positions.begin(), part.positions.end(), turn);
    std::for_each(part.normals.begin(), part.normals.end(), turn);
    return part;
}

TEST(Transfer, OfTurnedMeshesGivesTheSameBytes) {
    const Solid ball = sphere();
    const MeshPart high = grid_part(
        90, 70,
        [&](float u, float v) {
            const Float3 n = ball.normal(u, v);
            const float r = 1.0f + 0.03f * std::sin(30.0f * u) * std::sin(25.0f * v);
            return Float3{r * n.x, r * n.y, r * n.z};
        },
        ball.normal);
    auto tangents = make_tangents(ball.part);
    ASSERT_TRUE(tangents);
    for (const RayMode rays : {RayMode::smooth, RayMode::straight, RayMode::vertex}) {
        TransferOptions options = all_maps();
        options.rays = rays;
        const auto before = transfer({150, 100}, {ball.part, *tangents}, only(high), options);
        std::vector<Float4> turned_tangents;
        for (const Float4& t : *tangents) turned_tangents.push_back({-t.y, t.x, t.z, t.w});
        const MeshPart low = turned(ball.part);
        const auto after = transfer({150, 100}, {low, turned_tangents}, only(turned(high)), options);
        ASSERT_TRUE(before && after);
        EXPECT_TRUE(same_maps(*before, *after));
    }
}

TEST(Transfer, GivesTheSameBytesForEveryNumberOfThreadsAndInstructionSet) {
    const auto high = only(wavy_part(60));
    const MeshPart low = wavy_part(5);
    const auto tangents = make_tangents(low);
    ASSERT_TRUE(tangents);
    TransferOptions options = all_maps();
    options.subsamples = 2;
    options.rays = RayMode::straight;
    const auto one = transfer({90, 70}, {low, *tangents}, high, options, {1, {}});
    ASSERT_TRUE(one);
    for (const int threads : {2, 8}) {
        const auto many = transfer({90, 70}, {low, *tangents}, high, options, {threads, {}});
        ASSERT_TRUE(many);
        EXPECT_TRUE(same_maps(*one, *many)) << threads;
    }
    on_every_target([&] {
        const auto again = transfer({90, 70}, {low, *tangents}, high, options);
        ASSERT_TRUE(again);
        EXPECT_TRUE(same_maps(*one, *again));
    });
}

// Four rays of a texel are those of four texels of a map of twice the size.
TEST(Transfer, SubsamplesAreTexelsOfALargerMap) {
    const Solid ring = torus();
    TransferOptions options = all_maps();
    const auto fine = transferred(ring.part, only(ring.part), {128, 64}, options);
    options.subsamples = 2;
    const auto coarse = transferred(ring.part, only(ring.part), {64, 32}, options);
    ASSERT_TRUE(fine && coarse);
    for_hits(*coarse, [&](int i, int j) {
        Float3 sum;
        for (int k = 0; k < 4; ++k) {
            const Float3 n = vector_at(fine->object, 2 * i + k % 2, 2 * j + k / 2);
            sum = {sum.x + n.x, sum.y + n.y, sum.z + n.z};
        }
        ASSERT_LT(degrees_between(unit_vector(sum), vector_at(coarse->object, i, j)), 1e-4);
    });
}

TEST(Transfer, FillsThePaddingAndLeavesTheRestFlat) {
    const MeshPart low = square(0.25f, 0.75f);
    TransferOptions options = all_maps();
    options.padding = 2;
    const auto maps = transferred(low, only(low), {32, 32}, options);
    ASSERT_TRUE(maps);
    EXPECT_EQ(maps->covered, 256);
    EXPECT_EQ(maps->origin.at(16, 16), TexelOrigin::hit);
    EXPECT_EQ(maps->origin.at(7, 16), TexelOrigin::padding);
    EXPECT_EQ(maps->origin.at(5, 16), TexelOrigin::none);
    EXPECT_EQ(maps->map.z.at(5, 16), 1.0f);
    EXPECT_EQ(maps->heights.at(5, 16), 0.0f);
}

TEST(Transfer, RefusesWhatDoesNotFit) {
    const MeshPart low = wavy_part(3);
    const auto tangents = make_tangents(low);
    ASSERT_TRUE(tangents);
    const std::vector<Float4> none;
    EXPECT_EQ(transfer({8, 8}, {low, none, 0, Decoder::gltf, "m.obj"}, only(low)).error().file, "m.obj");
    EXPECT_EQ(transfer({8, 8}, {low, *tangents, 1}, only(low)).error().code, ErrorCode::bad_option);
    EXPECT_EQ(transfer({8, 8}, {low, *tangents}, {}).error().reason, "the high mesh is empty");
    const auto away = transfer({8, 8}, {low, *tangents}, only(lifted(low, 1000.0f)));
    ASSERT_FALSE(away);
    EXPECT_NE(away.error().reason.find("no ray hits the high mesh, which is 99"), std::string::npos)
        << away.error().reason;
    EXPECT_NE(away.error().reason.find("both must be in the same place and unit"), std::string::npos);
    const auto behind = transfer({8, 8}, {low, *tangents}, only(inside_out(low)));
    ASSERT_FALSE(behind);
    EXPECT_NE(behind.error().reason.find("face the other way"), std::string::npos) << behind.error().reason;
    EXPECT_EQ(behind.error().reason.find("cage"), std::string::npos) << behind.error().reason;
    MeshPart point = low;
    for (Float2& uv : point.uvs[0]) uv = {0.5f, 0.5f};
    EXPECT_EQ(transfer({8, 8}, {point, *tangents}, only(low)).error().reason,
              "its triangles cover no texel of the map");
    int calls = 0;
    const auto stopped = transfer({64, 64}, {low, *tangents}, only(low), {}, {1, [&](double) { return ++calls < 3; }});
    EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
}

// Triangles that nobody would model never crash, and give unit vectors.
TEST(Transfer, MakesUnitVectorsOfRandomTriangles) {
    for (unsigned seed = 1; seed <= 40; ++seed) {
        MeshPart low = random_part(seed);
        for (Float2& uv : low.uvs[0]) uv = {0.1f * uv.x, 0.1f * uv.y};
        const auto tangents = make_tangents(low);
        ASSERT_TRUE(tangents);
        for (const RayMode rays : {RayMode::smooth, RayMode::straight, RayMode::vertex}) {
            TransferOptions options = all_maps();
            options.rays = rays;
            options.backfaces = seed % 2 == 0;
            const auto maps = transfer({40, 30}, {low, *tangents}, only(random_part(seed + 1)), options, {2, {}});
            if (!maps) continue;
            for_hits(*maps, [&](int i, int j) {
                const Float3 n = vector_at(maps->map, i, j);
                EXPECT_NEAR(n.x * n.x + n.y * n.y + n.z * n.z, 1.0f, 1e-5f) << seed;
            });
        }
    }
}

}  // namespace
}  // namespace tex
