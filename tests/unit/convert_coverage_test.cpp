// SPDX-License-Identifier: Apache-2.0
// Which triangle decides about a texel, and what the texels get that none covers.

#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <tex/mesh.h>

#include "mesh/coverage.h"
#include "unit/convert_maps.h"

namespace tex {
namespace {

TEST(ConvertCoverage, CoversEveryTexelOnce) {
    MeshPart part = wavy_part(13);
    for (Float2& uv : part.uvs[0]) uv.y -= 0.125f * uv.x;  // the sheet's UVs are a whole square again
    const auto tangents = make_tangents(part);
    ASSERT_TRUE(tangents);
    for (const float moved : {0.0f, 0.3f, -7.77f}) {  // the map repeats
        for (Float2& uv : part.uvs[0]) uv = {uv.x + moved, uv.y - moved};
        for (const Extent extent : {Extent{1, 1}, Extent{13, 13}, Extent{64, 64}, Extent{100, 37}}) {
            const auto converted = to_object_space(bumpy_map(extent), {part, *tangents});
            ASSERT_TRUE(converted);
            EXPECT_LE(converted->overlaps, moved == 0.0f ? 0 : extent.height);
            EXPECT_GE(converted->covered, extent.texels() - (moved == 0.0f ? 0 : extent.height));
        }
    }
}

// Inside the square, many triangles of random shapes meet in each vertex. No texel between them is missed or counted
// twice.
TEST(ConvertCoverage, LeavesNoCracksBetweenOddTriangles) {
    MeshPart part = wavy_part(24);
    for (std::size_t k = 0; k < part.uvs[0].size(); ++k) {
        Float2& uv = part.uvs[0][k];
        uv.y -= 0.125f * uv.x;
        const bool border = uv.x < 0.01f || uv.x > 0.99f || uv.y < 0.01f || uv.y > 0.99f;
        const float shift = 0.012f * static_cast<float>(static_cast<int>(k * 2654435761u % 1000u) - 500) / 500.0f;
        if (!border) uv = {uv.x + shift, uv.y + 0.7f * shift};
    }
    const auto tangents = make_tangents(part);
    ASSERT_TRUE(tangents);
    const auto converted = to_object_space(bumpy_map({257, 311}), {part, *tangents});
    ASSERT_TRUE(converted);
    EXPECT_EQ(converted->overlaps, 0);
    EXPECT_EQ(converted->covered, 257 * 311);
}

// Which of two triangles gets a texel whose centre is on their edge: the top-left rule of Direct3D 11 and Vulkan.
TEST(ConvertCoverage, CentresOnABorderBelongToTheTopAndTheLeft) {
    MeshPart part = square(2.5f / 16.0f, 6.5f / 16.0f);
    part.v_axis = YAxis::down;
    const std::vector<Float4> tangents(6, {1.0f, 0.0f, 0.0f, 1.0f});
    for (const bool mirrored : {false, true}) {
        if (mirrored) std::reverse(part.indices.begin(), part.indices.end());
        const auto converted = to_object_space(constant_map({16, 16}, {0.0f, 0.0f, 1.0f}), {part, tangents}, {0});
        ASSERT_TRUE(converted);
        for (int j = 0; j < 16; ++j) {
            for (int i = 0; i < 16; ++i) {
                const bool is_covered = i >= 2 && i < 6 && j >= 2 && j < 6;
                EXPECT_EQ(converted->coverage.at(i, j) == Coverage::triangle, is_covered) << i << ' ' << j;
            }
        }
    }
}

// The first square lies one unit beside the map, as bakers move mirrored halves out of the way, and the second in it.
TEST(ConvertCoverage, ShellsMovedByWholeUnitsDecideNothing) {
    MeshPart part = square(0.25f, 0.75f);
    const std::size_t vertices = part.positions.size();
    for (std::size_t v = 0; v < vertices; ++v) {
        part.positions.push_back(part.positions[v]);
        part.normals.push_back(part.normals[v]);
        part.uvs[0].push_back(part.uvs[0][v]);
        part.uvs[0][v].x += 1.0f;
    }
    for (std::size_t c = 0; c < 6; ++c) part.indices.push_back(part.indices[c] + static_cast<std::uint32_t>(vertices));
    std::vector<Float4> tangents(6, {1.0f, 0.0f, 0.0f, 1.0f});
    tangents.resize(12, {0.0f, 1.0f, 0.0f, 1.0f});
    const auto converted = to_object_space(constant_map({16, 16}, {0.6f, 0.0f, 0.8f}), {part, tangents});
    ASSERT_TRUE(converted);
    EXPECT_EQ(converted->covered, 64);
    EXPECT_EQ(converted->overlaps, 0);
    EXPECT_EQ(converted->moved, 64);
    EXPECT_FLOAT_EQ(converted->map.y.at(8, 8), 0.6f);
    EXPECT_FLOAT_EQ(converted->map.y.at(1, 8), 0.6f) << "nor about the padding";
    // Where nothing lies inside, the first one decides, and the others are counted.
    for (Float2& uv : part.uvs[0]) uv.y += 2.0f;
    const auto outside = to_object_space(constant_map({16, 16}, {0.6f, 0.0f, 0.8f}), {part, tangents});
    ASSERT_TRUE(outside);
    EXPECT_EQ(outside->overlaps, 64);
    EXPECT_EQ(outside->moved, 0);
    EXPECT_FLOAT_EQ(outside->map.x.at(8, 8), 0.6f);
}

TEST(ConvertCoverage, LetsTheFirstOfSeveralTrianglesDecide) {
    MeshPart part = square(0.25f, 0.75f, 3);
    std::vector<Float4> tangents(6, {1.0f, 0.0f, 0.0f, 1.0f});
    tangents.resize(part.indices.size(), {0.0f, 1.0f, 0.0f, 1.0f});
    const auto converted = to_object_space(constant_map({16, 16}, {0.6f, 0.0f, 0.8f}), {part, tangents});
    ASSERT_TRUE(converted);
    EXPECT_EQ(converted->covered, 64);
    EXPECT_EQ(converted->overlaps, 128);
    EXPECT_FLOAT_EQ(converted->map.x.at(8, 8), 0.6f);
    EXPECT_FLOAT_EQ(converted->map.y.at(8, 8), 0.0f);
}

TEST(ConvertCoverage, PadsAsFarAsItIsAsked) {
    const MeshPart part = square(0.25f, 0.75f);
    const auto tangents = make_tangents(part);
    ASSERT_TRUE(tangents);
    const NormalMap map = constant_map({32, 32}, {0.6f, 0.0f, 0.8f});
    const auto grown = [](int by) { return (16 + 2 * by) * (16 + 2 * by); };
    for (const int padding : {0, 1, 2, 3, kPadAll}) {
        const auto object = to_object_space(map, {part, *tangents}, {padding});
        const auto tangent = to_tangent_space(map, {part, *tangents}, {padding});
        ASSERT_TRUE(object && tangent);
        EXPECT_EQ(count(*object, Coverage::triangle), 256);
        EXPECT_EQ(count(*object, Coverage::none) == 0, padding == kPadAll);
        EXPECT_EQ(count(*tangent, Coverage::none) == 0, padding == kPadAll);
        EXPECT_EQ(count(*tangent, Coverage::gutter), 0);
        const int filled = 1024 - count(*object, Coverage::none);
        if (padding <= 3) {
            EXPECT_LE(filled, grown(padding)) << padding;
            EXPECT_GE(filled, grown(padding) - 4 * padding * padding) << padding;  // corners are round
        }
        EXPECT_EQ(object->map.x.at(0, 0), padding == kPadAll ? object->map.x.at(8, 8) : 0.0f);
        EXPECT_EQ(object->map.z.at(0, 0), padding == kPadAll ? object->map.z.at(8, 8) : 1.0f);
    }
}

// Beyond its edge, a curved sheet goes on bending for two texels, and then stays as it is.
TEST(ConvertCoverage, ContinuesTrianglesInTheGutter) {
    MeshPart part = wavy_part(2);
    for (Float2& uv : part.uvs[0]) uv = {0.25f + 0.5f * uv.x, 0.25f + 0.5f * uv.y};
    const auto tangents = make_tangents(part);
    ASSERT_TRUE(tangents);
    const auto object = to_object_space(constant_map({64, 64}, {0.0f, 0.0f, 1.0f}), {part, *tangents});
    ASSERT_TRUE(object);
    const int j = 30;
    int left = 0;
    while (object->coverage.at(left, j) != Coverage::triangle) ++left;
    ASSERT_EQ(object->coverage.at(left - 1, j), Coverage::gutter);
    ASSERT_EQ(object->coverage.at(left - 2, j), Coverage::gutter);
    ASSERT_EQ(object->coverage.at(left - 3, j), Coverage::padding);
    const auto x = [&](int i) { return object->map.x.at(left + i, j); };
    EXPECT_NEAR(x(-1) - x(0), x(0) - x(1), 3e-3f);
    EXPECT_NEAR(x(-2) - x(-1), x(0) - x(1), 3e-3f);
    EXPECT_LT(std::abs(x(-3) - x(-2)), 0.5f * std::abs(x(0) - x(1)));
}

// The map repeats, so the gutter of a chart at its border goes on at the opposite border.
TEST(ConvertCoverage, GuttersGoOnAtTheOppositeBorder) {
    MeshPart part = square(0.0f, 0.5f);
    part.v_axis = YAxis::down;
    const std::vector<Float4> tangents(6, {1.0f, 0.0f, 0.0f, 1.0f});
    const auto converted = to_object_space(constant_map({16, 16}, {0.0f, 0.0f, 1.0f}), {part, tangents}, {2});
    ASSERT_TRUE(converted);
    for (int k = 0; k < 16; ++k) {
        const Coverage expected = k < 8 ? Coverage::triangle : k < 10 || k > 13 ? Coverage::gutter : Coverage::none;
        EXPECT_EQ(converted->coverage.at(k, 3), expected) << k;
        EXPECT_EQ(converted->coverage.at(3, k), expected) << k;
    }
}

// A quarter of a texel high: its plane would give weights of 8 two texels away.
TEST(ConvertCoverage, NoWeightGoesBeyondMinusOne) {
    MeshPart part = square(0.0f, 1.0f);
    part.v_axis = YAxis::down;
    part.uvs[0] = {{0.25f, 0.25f}, {0.75f, 0.25f}, {0.5f, 0.2578125f}, {0.25f, 0.25f}};
    const auto coverage = CoverageMap::make(part, 0, {32, 32}, 2);
    ASSERT_TRUE(coverage);
    std::vector<Covered> texels;
    coverage->cover(0, texels);
    int gutter = 0, limited = 0;
    for (const Covered& texel : texels) {
        if (texel.triangle == kNoTriangle) continue;
        ++gutter;
        const auto& w = texel.weights;
        const double least = std::min({w[0], w[1], w[2]});
        EXPECT_NEAR(w[0] + w[1] + w[2], 1.0, 1e-9);
        EXPECT_GE(least, -1.0 - 1e-9);
        limited += least < -1.0 + 1e-9 ? 1 : 0;
    }
    EXPECT_GT(gutter, 60);
    EXPECT_GT(limited, 20);
}

// Each sliver is in a list for each strip of rows. Such lists are limited as the work is.
TEST(ConvertCoverage, RefusesSliversThatTakeTooMuchMemory) {
    constexpr std::uint32_t kCount = 2500;
    MeshPart part;
    part.uvs.resize(1);
    for (std::uint32_t k = 0; k < 3 * kCount; ++k) {
        const float left = static_cast<float>(k / 3) / static_cast<float>(kCount);
        part.uvs[0].push_back({k % 3 == 2 ? left + 1e-5f : left, k % 3 == 1 ? 1.0f : 0.0f});
        part.indices.push_back(k);
    }
    part.positions.resize(part.uvs[0].size());
    const auto coverage = CoverageMap::make(part, 0, {65536, 16384}, 0);
    ASSERT_FALSE(coverage);
    EXPECT_EQ(coverage.error().code, ErrorCode::unsupported);
    EXPECT_EQ(coverage.error().reason, "its triangles are too many and too long for a map of this size");
    EXPECT_TRUE(CoverageMap::make(part, 0, {65536, 1024}, 0));
}

// The mesh bends within the texels of the coarse map.
TEST(ConvertSubsamples, AverageTheVectorsOfATexel) {
    MeshPart part = wavy_part(3);
    for (Float2& uv : part.uvs[0]) uv.y -= 0.125f * uv.x;
    const auto tangents = make_tangents(part);
    ASSERT_TRUE(tangents);
    const TangentSpace space{part, *tangents};
    const NormalMap coarse = constant_map({4, 4}, {0.6f, 0.0f, 0.8f});
    const NormalMap fine = constant_map({16, 16}, {0.6f, 0.0f, 0.8f});
    const auto averaged = to_object_space(coarse, space, {0, 4});
    const auto single = to_object_space(fine, space, {0});
    ASSERT_TRUE(averaged && single);
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
            Float3 sum;
            for (int k = 0; k < 16; ++k) {
                const Float3 n = vector_at(single->map, 4 * i + k % 4, 4 * j + k / 4);
                sum = {sum.x + n.x, sum.y + n.y, sum.z + n.z};
            }
            EXPECT_LT(degrees_between(unit_vector(sum), vector_at(averaged->map, i, j)), 1e-4) << i << ' ' << j;
        }
    }
    EXPECT_EQ(averaged->covered, 16);
}

// At the border of a chart, only the subsamples that triangles cover count, also if the gutter covers the others.
TEST(ConvertSubsamples, LeaveOutTheGutterWhereATriangleCoversAny) {
    MeshPart part = wavy_part(2);
    for (Float2& uv : part.uvs[0]) uv = {0.28f + 0.5f * uv.x, 0.28f + 0.5f * (uv.y - 0.125f * uv.x)};
    const auto tangents = make_tangents(part);
    ASSERT_TRUE(tangents);
    const TangentSpace space{part, *tangents};
    const auto averaged = to_object_space(constant_map({8, 8}, {0.0f, 0.0f, 1.0f}), space, {2, 4});
    const auto single = to_object_space(constant_map({32, 32}, {0.0f, 0.0f, 1.0f}), space, {0});
    ASSERT_TRUE(averaged && single);
    int partly = 0;
    for (int j = 0; j < 8; ++j) {
        for (int i = 0; i < 8; ++i) {
            Float3 sum;
            int covered = 0;
            for (int k = 0; k < 16; ++k) {
                if (single->coverage.at(4 * i + k % 4, 4 * j + k / 4) != Coverage::triangle) continue;
                const Float3 n = vector_at(single->map, 4 * i + k % 4, 4 * j + k / 4);
                sum = {sum.x + n.x, sum.y + n.y, sum.z + n.z};
                ++covered;
            }
            EXPECT_EQ(averaged->coverage.at(i, j) == Coverage::triangle, covered > 0) << i << ' ' << j;
            if (covered == 0) continue;
            EXPECT_LT(degrees_between(unit_vector(sum), vector_at(averaged->map, i, j)), 1e-4) << i << ' ' << j;
            partly += covered < 16 ? 1 : 0;
        }
    }
    EXPECT_GT(partly, 8);
}

// Half of the texel looks up, half of it down: there is no mean.
TEST(ConvertSubsamples, ThatCancelEachOtherMakeAFlatTexel) {
    MeshPart part = square(0.0f, 0.5f);
    part.uvs[0] = {{0.0f, 0.0f}, {0.5f, 0.0f}, {0.5f, 1.0f}, {0.0f, 1.0f}};
    for (const std::size_t v : {0u, 1u, 2u, 3u}) {
        const Float3 p = part.positions[v];
        const Float2 uv = part.uvs[0][v];
        part.positions.push_back({p.x + 1.0f, p.y, p.z});
        part.normals.push_back({0.0f, 0.0f, -1.0f});
        part.uvs[0].push_back({uv.x + 0.5f, uv.y});
    }
    for (std::size_t k = 0; k < 6; ++k) part.indices.push_back(part.indices[k] + 4);
    const std::vector<Float4> tangents(12, {1.0f, 0.0f, 0.0f, 1.0f});
    const auto converted = to_object_space(constant_map({1, 1}, {0.0f, 0.0f, 1.0f}), {part, tangents}, {0, 2});
    ASSERT_TRUE(converted);
    EXPECT_EQ(converted->singular, 1);
    EXPECT_EQ(converted->map.x.at(0, 0), 0.0f);
    EXPECT_EQ(converted->map.z.at(0, 0), 1.0f);
}

TEST(ConvertSubsamples, CoverTexelsThatATriangleTouches) {
    MeshPart part = wavy_part(1);
    for (Float2& uv : part.uvs[0]) uv = {0.315f * uv.x, 0.315f * (uv.y - 0.125f * uv.x)};  // 3.15 texels
    const auto tangents = make_tangents(part);
    ASSERT_TRUE(tangents);
    const TangentSpace space{part, *tangents};
    const NormalMap map = constant_map({10, 10}, {0.0f, 0.0f, 1.0f});
    EXPECT_EQ(to_object_space(map, space, {0})->covered, 9);
    EXPECT_EQ(to_object_space(map, space, {0, 8})->covered, 16);
    for (const int threads : {2, 4}) {
        const auto one = to_tangent_space(map, space, {2, 3}, {1, {}});
        const auto more = to_tangent_space(map, space, {2, 3}, {threads, {}});
        ASSERT_TRUE(one && more);
        for (int k = 0; k < 100; ++k) EXPECT_EQ(one->map.x.at(k % 10, k / 10), more->map.x.at(k % 10, k / 10));
    }
}

}  // namespace
}  // namespace tex
