// SPDX-License-Identifier: Apache-2.0

#include "mesh/obj.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <tex/mesh.h>

namespace tex {
namespace {

constexpr const char* kQuad =
    "# a quad\r\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv +1 1 0\nv 0 1 1e-50\nvt 0 0\nvt 1 0\nvt 1 1 0\nvt 0 1\nvn 0 0 1\n";

Result<Mesh> parse_with_quad(const char* faces) {
    std::string text = kQuad;
    text.append(faces);
    return parse_obj(text);
}

TEST(Obj, TriangulatesPolygonsAsFans) {
    const auto mesh = parse_with_quad("f 1/1/1 2/2/1 3/3/1 4/4/1\n");
    ASSERT_TRUE(mesh) << mesh.error().reason;
    ASSERT_EQ(mesh->parts.size(), 1u);
    const MeshPart& part = mesh->parts[0];
    EXPECT_EQ(part.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(part.quads, std::vector<std::uint32_t>{0});
    EXPECT_EQ(part.positions[2].x, 1.0f);
    EXPECT_EQ(part.positions[3].z, 0.0f);
    EXPECT_EQ(part.uvs[0][3].y, 1.0f);
    EXPECT_EQ(part.normals[0].z, 1.0f);
    EXPECT_EQ(part.v_axis, YAxis::up);
    EXPECT_EQ(part.material, -1);
    EXPECT_EQ(mesh->nodes.size(), 1u);
}

TEST(Obj, CountsNegativeIndicesFromTheEnd) {
    const auto mesh = parse_with_quad("f -4/-4 -3/-3 -2/-2\nv 9 9 9\nf -1 1 2\n");
    ASSERT_TRUE(mesh) << mesh.error().reason;
    EXPECT_EQ(mesh->parts[0].positions[0].x, 0.0f);
    ASSERT_EQ(mesh->parts.size(), 2u);  // faces without UVs are a part of their own
    EXPECT_FALSE(mesh->parts[0].uvs.empty());
    EXPECT_EQ(mesh->parts[1].positions[0].x, 9.0f);
    EXPECT_TRUE(mesh->parts[1].uvs.empty());
    EXPECT_TRUE(mesh->parts[1].normals.empty());
}

TEST(Obj, MakesPartsOfObjectsAndMaterials) {
    const auto mesh = parse_with_quad(
        "o a\nusemtl red brick\nf 1 2 3\nusemtl blue\nf 1 2 4\nusemtl red brick\nf 2 3 4\n"
        "o b\nf 1 \\\n2 3\n");
    ASSERT_TRUE(mesh) << mesh.error().reason;
    ASSERT_EQ(mesh->parts.size(), 3u);
    EXPECT_EQ(mesh->parts[0].triangles(), 2u);
    EXPECT_EQ(mesh->parts[0].name, "a");
    EXPECT_EQ(mesh->parts[1].material, 1);
    EXPECT_EQ(mesh->parts[1].primitive, 1);
    EXPECT_EQ(mesh->parts[2].name, "b");
    EXPECT_EQ(mesh->parts[2].mesh, 1);
    EXPECT_EQ(mesh->materials[0].name, "red brick");
    EXPECT_EQ(mesh->nodes.size(), 2u);
}

TEST(Obj, FacesWithoutNormalsAreAPartOfTheirOwn) {
    const auto mesh = parse_with_quad("f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4\n");
    ASSERT_TRUE(mesh) << mesh.error().reason;
    ASSERT_EQ(mesh->parts.size(), 2u);
    EXPECT_EQ(mesh->parts[0].normals.size(), 3u);
    EXPECT_TRUE(mesh->parts[1].normals.empty());
    EXPECT_EQ(mesh->parts[1].primitive, 1);
    const auto selected = select_part(*mesh, {});
    ASSERT_FALSE(selected);
    EXPECT_EQ(selected.error().reason,
              "has 1 of 2 triangles with corners that have no normal, which tangent space needs");
}

TEST(Obj, ReadsLinesOfOldMacs) {
    std::string text = "# CR alone\rv 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 \\\r3\r";
    EXPECT_TRUE(is_obj(text));
    const auto mesh = parse_obj(text);
    ASSERT_TRUE(mesh) << mesh.error().reason;
    EXPECT_EQ(mesh->parts.at(0).triangles(), 1u);
    EXPECT_EQ(parse_obj("v 0 0 0\rv 1\r").error().reason, "line 2: \"\" is not a finite number");
}

TEST(Obj, RefusesDamageWithTheLine) {
    const std::pair<const char*, const char*> cases[] = {
        {"v 1 2\n", "line 1: \"\" is not a finite number"},
        {"v 1 2 nan\n", "line 1: \"nan\" is not a finite number"},
        {"v 1 2 1e60\n", "line 1: \"1e60\" is not a finite number"},
        {"v 1 2 3x\n", "line 1: \"3x\" is not a finite number"},
        {"v 0 0 0\nf 1 1\n", "line 2: a face needs at least 3 corners"},
        {"v 0 0 0\nf 1 1 0\n", "line 2: position 0 is out of range: there are 1"},
        {"v 0 0 0\nf 1 1 -2\n", "line 2: position -2 is out of range: there are 1"},
        {"v 0 0 0\nf 1/1 1 1\n", "line 2: UV 1 is out of range: there are 0"},
        {"v 0 0 0\nf 1//5 1 1\n", "line 2: normal 5 is out of range: there are 0"},
        {"v 0 0 0\nf 1 1 99999999999999999999\n", "line 2: \"99999999999999999999\" is not a corner of a face"},
        {"v 0 0 0\n", "has no faces"},
        {"v 0 0 0\nf 1 1 \\", "line 2: the file ends within a line"},
    };
    for (const auto& [text, reason] : cases) {
        const auto mesh = parse_obj(text);
        ASSERT_FALSE(mesh) << text;
        EXPECT_EQ(mesh.error().code, ErrorCode::bad_data);
        EXPECT_EQ(mesh.error().reason, reason);
    }
}

TEST(Obj, MayBeginWithAByteOrderMark) {
    const auto mesh = parse_obj("\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->parts.at(0).positions.size(), 3u);
}

TEST(Obj, IsKnownByItsFirstKeyword) {
    for (const char* text :
         {"v 1 2 3", "# comment", "\n\n  # comment\nvt 0 0", "mtllib a.mtl\n", "o thing", "\xEF\xBB\xBFv 1 2 3"})
        EXPECT_TRUE(is_obj(text)) << text;
    for (const char* text : {"", "solid cube", "# comment\nply\n", "very", "{"}) EXPECT_FALSE(is_obj(text)) << text;
}

}  // namespace
}  // namespace tex
