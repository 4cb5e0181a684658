// SPDX-License-Identifier: Apache-2.0

#include <tex/mesh.h>

#include <limits>

#include <gtest/gtest.h>

#include "unit/meshes.h"

namespace tex {
namespace {

void expect_bad(const MeshPart& part, const std::string& reason) {
    const auto checked = check_part(part);
    ASSERT_FALSE(checked);
    EXPECT_EQ(checked.error().code, ErrorCode::bad_data);
    EXPECT_EQ(checked.error().reason, reason);
}

TEST(Mesh, ChecksPartsWithOneSentence) {
    const MeshPart good = wavy_part(2);
    EXPECT_TRUE(check_part(good));
    expect_bad({}, "has no triangles");
    MeshPart part = good;
    part.indices.pop_back();
    expect_bad(part, "has 23 corners, which are not whole triangles");
    part = good;
    part.indices[11] = 9;
    expect_bad(part, "index 9 of triangle 3 is out of range: there are 9 vertices");
    part = good;
    part.positions[4].y = std::numeric_limits<float>::quiet_NaN();
    expect_bad(part, "position 4 is not a finite number");
    part = good;
    part.normals[8].z = -std::numeric_limits<float>::infinity();
    expect_bad(part, "normal 8 is not a finite number");
    part = good;
    part.uvs[0].pop_back();
    expect_bad(part, "UVs: 8 for 9 vertices");
    part = good;
    part.uvs.emplace_back();
    expect_bad(part, "a set of UVs is empty");
    part = good;
    part.tangents.resize(3);
    expect_bad(part, "tangents: 3 for 9 vertices");
}

TEST(Mesh, MovesPartsIntoTheScene) {
    MeshPart part = wavy_part(4);
    part.tangents.assign(part.positions.size(), {0.6f, 0.8f, 0.0f, 1.0f});
    MeshNode node;
    node.to_scene = {0, -2, 0, 1, 2, 0, 0, 2, 0, 0, 2, 3};  // a quarter turn to the left, twice as large, moved
    const auto moved = in_scene(part, node);
    ASSERT_TRUE(moved);
    for (std::size_t v = 0; v < part.positions.size(); ++v) {
        const Float3 &p = part.positions[v], &q = moved->positions[v], &n = part.normals[v], &m = moved->normals[v];
        EXPECT_FLOAT_EQ(q.x, 1.0f - 2.0f * p.y);
        EXPECT_FLOAT_EQ(q.y, 2.0f + 2.0f * p.x);
        EXPECT_FLOAT_EQ(q.z, 3.0f + 2.0f * p.z);
        EXPECT_NEAR(m.x, -n.y, 1e-6f);
        EXPECT_NEAR(m.y, n.x, 1e-6f);
        EXPECT_NEAR(m.z, n.z, 1e-6f);
        EXPECT_NEAR(moved->tangents[v].x, -0.8f, 1e-6f);
        EXPECT_NEAR(moved->tangents[v].y, 0.6f, 1e-6f);
        EXPECT_EQ(moved->tangents[v].w, 1.0f);
    }
    EXPECT_EQ(moved->indices, part.indices);
}

// A mirror image has mirrored tangents, whether they are made before the transform or after it.
TEST(Mesh, MirroredPartsKeepTheirTangentSpace) {
    MeshPart part = wavy_part(6);
    MeshNode mirror;
    mirror.to_scene = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    const auto before = make_tangents(part);
    ASSERT_TRUE(before);
    // Every corner becomes a vertex, so that tangents can be an attribute.
    MeshPart corners = part;
    corners.indices.clear();
    corners.positions.clear();
    corners.normals.clear();
    corners.uvs[0].clear();
    for (std::size_t c = 0; c < part.indices.size(); ++c) {
        corners.indices.push_back(static_cast<std::uint32_t>(c));
        corners.positions.push_back(part.positions[part.indices[c]]);
        corners.normals.push_back(part.normals[part.indices[c]]);
        corners.uvs[0].push_back(part.uvs[0][part.indices[c]]);
    }
    corners.tangents = *before;
    const auto moved = in_scene(corners, mirror);
    ASSERT_TRUE(moved);
    EXPECT_EQ(moved->indices[1], 2u);
    const auto after = make_tangents(*moved);
    ASSERT_TRUE(after);
    for (std::size_t c = 0; c < after->size(); ++c) {
        const Float4 &t = moved->tangents[moved->indices[c]], &made = (*after)[c];
        EXPECT_NEAR(t.x, made.x, 1e-6f);
        EXPECT_NEAR(t.y, made.y, 1e-6f);
        EXPECT_NEAR(t.z, made.z, 1e-6f);
        EXPECT_EQ(t.w, -1.0f);
        EXPECT_EQ(made.w, -1.0f);
    }
}

TEST(Mesh, NormalsFollowTheInverseTranspose) {
    MeshPart part;
    part.positions = {{0, 0, 0}, {1, 0, -1}, {0, 1, 0}};
    part.normals.assign(3, unit_vector({1, 0, 1}));  // perpendicular to the triangle
    part.indices = {0, 1, 2};
    MeshNode node;
    node.to_scene = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 4, 0};
    const auto moved = in_scene(part, node);
    ASSERT_TRUE(moved);
    const Float3 n = moved->normals[0], edge = moved->positions[1];
    EXPECT_NEAR(n.x * edge.x + n.y * edge.y + n.z * edge.z, 0.0f, 1e-6f);
}

TEST(Mesh, RefusesMatricesThatCannotBeInverted) {
    MeshNode node;
    node.name = "flat";
    node.to_scene = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0};
    const auto flat = in_scene(wavy_part(1), node);
    ASSERT_FALSE(flat);
    EXPECT_EQ(flat.error().reason, "node \"flat\": its matrix is not invertible");
    node.to_scene = {1, 0, 0, 1e300, 0, 1, 0, 0, 0, 0, 1, 0};
    const auto far = in_scene(wavy_part(1), node);
    ASSERT_FALSE(far);
    EXPECT_EQ(far.error().code, ErrorCode::bad_data);
}

}  // namespace
}  // namespace tex
