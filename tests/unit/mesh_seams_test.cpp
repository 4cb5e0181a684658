// SPDX-License-Identifier: Apache-2.0
// UV seams of meshes, and how much evidence their edges are.

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/mesh.h>

#include "checks/mesh_seams.h"
#include "unit/solids.h"

namespace tex {
namespace {

TEST(MeshSeams, AreEdgesWithOtherUvsButTheSamePlacesAndNormals) {
    MeshPart part = smooth_cube().part;
    EXPECT_EQ(find_seams(part).size(), 12u);
    part.normals[0] = unit_vector({1.0f, 0.2f, 0.1f});  // a hard edge where the first face meets two others
    EXPECT_EQ(find_seams(part).size(), 10u);
    EXPECT_TRUE(find_seams(wavy_part(6)).empty());
}

// Pairs of triangles that share an edge. The UVs of the second one are moved, at one end of the edge or at both.
MeshPart pairs_with_seams(std::uint32_t count, bool at_both_ends) {
    MeshPart part;
    part.uvs.resize(1);
    for (std::uint32_t k = 0; k < count; ++k) {
        const auto x = static_cast<float>(2 * k);
        const std::uint32_t first = 6 * k;
        for (const Float3& p : {Float3{x, 0, 0}, Float3{x, 1, 0}, Float3{x - 1, 0, 0}, Float3{x, 1, 0}, Float3{x, 0, 0},
                                Float3{x + 1, 0, 0}}) {
            part.indices.push_back(static_cast<std::uint32_t>(part.positions.size()));
            part.positions.push_back(p);
            part.normals.push_back({0.0f, 0.0f, 1.0f});
            part.uvs[0].push_back({0.25f * (p.x - x) + 0.5f, 0.5f * p.y});
        }
        part.uvs[0][first + 3].x += 0.125f;
        if (at_both_ends) part.uvs[0][first + 4].x += 0.125f;
    }
    return part;
}

TEST(MeshSeams, MayPartAtOneEndAlone) {
    EXPECT_EQ(find_seams(pairs_with_seams(3, true)).size(), 3u);
    EXPECT_EQ(find_seams(pairs_with_seams(3, false)).size(), 3u);
}

TEST(MeshSeams, OfManyEdgesAreSpreadOverTheMesh) {
    const std::vector<SeamEdge> seams = find_seams(pairs_with_seams(40000, true));
    ASSERT_EQ(seams.size(), std::size_t{1} << 14);
    EXPECT_LT(seams.front().a.triangle, 10u);
    EXPECT_GT(seams.back().a.triangle, 79990u);
    const std::size_t middle = seams[seams.size() / 2].a.triangle;
    EXPECT_NEAR(static_cast<double>(middle), 40000.0, 10.0);
}

// A larger map has more places on an edge, but no more edges: it is not surer.
TEST(MeshSeams, EachEdgeIsOneWitness) {
    const MeshPart part = smooth_cube().part;
    const std::vector<SeamEdge> edges = find_seams(part);
    const auto verdict = [&](int side) {
        const SeamSamples samples(part, edges, {side, side}, [](double, double) { return Vector3{0.0, 0.0, 1.0}; });
        std::vector<Vector3> a, b;
        for (const SeamSamples::Sample& place : samples.samples()) {
            const double e = static_cast<double>(place.edge);
            a.push_back({0.02 * std::sin(e), 0.01 * std::cos(3.0 * e), 0.0});
            b.push_back({0.02 * std::cos(2.0 * e), 0.01 * std::sin(5.0 * e), 0.0});
        }
        return std::pair(samples.samples().size(), compare_gaps(samples, a, b));
    };
    const auto few = verdict(8), many = verdict(256);
    EXPECT_GT(many.first, 3 * few.first);
    EXPECT_NEAR(many.second.slope, few.second.slope, 1e-9);
    EXPECT_NEAR(many.second.saved, few.second.saved, 1e-9);
    EXPECT_NEAR(many.second.confidence, few.second.confidence, 1e-9);
    EXPECT_GT(many.second.confidence, 0.01);
    EXPECT_LT(many.second.confidence, 0.99);
}

}  // namespace
}  // namespace tex
