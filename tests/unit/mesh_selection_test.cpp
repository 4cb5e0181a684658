// SPDX-License-Identifier: Apache-2.0

#include <tex/mesh.h>

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "unit/meshes.h"

namespace tex {
namespace {

// Two meshes: the first has a primitive of each material, the second has one more of the first material.
Mesh two_meshes() {
    Mesh mesh;
    mesh.materials = {{"stone", "stone_n.png", 0}, {"wood", "", 0}, {"", "", 1}};
    for (int k = 0; k < 3; ++k) {
        MeshPart part = wavy_part(2 + k);
        part.name = k < 2 ? "wall" : "floor";
        part.mesh = k < 2 ? 0 : 1;
        part.primitive = k % 2;
        part.material = k % 2;
        mesh.parts.push_back(part);
    }
    mesh.nodes = {{"north", 0, {1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0}},
                  {"south", 0, {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}},
                  {"twin", 1, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}},
                  {"twin", 1, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}}};
    return mesh;
}

MeshSelection of(const std::string& material, const std::string& node = {}) {
    MeshSelection selection;
    selection.material = material;
    selection.node = node;
    return selection;
}

std::string refusal(const Mesh& mesh, const MeshSelection& selection) {
    const auto selected = select_part(mesh, selection);
    EXPECT_FALSE(selected);
    if (selected) return {};
    EXPECT_EQ(selected.error().code, ErrorCode::bad_option);
    return selected.error().reason;
}

TEST(MeshSelection, JoinsThePartsOfAMaterial) {
    const Mesh mesh = two_meshes();
    const auto stone = select_part(mesh, of("stone"));
    ASSERT_TRUE(stone);
    EXPECT_TRUE(check_part(stone->part));
    EXPECT_EQ(stone->part.triangles(), 8u + 32u);
    EXPECT_EQ(stone->tangents.size(), stone->part.indices.size());
    EXPECT_EQ(stone->source, TangentSource::mikktspace);
    const auto wood = select_part(mesh, of("1"));
    ASSERT_TRUE(wood);
    EXPECT_EQ(wood->part.triangles(), 18u);
    const auto floor = make_tangents(mesh.parts[2]);
    ASSERT_TRUE(floor);
    const Float4 &last = stone->tangents.back(), &same = floor->back();
    EXPECT_EQ(last.x, same.x);
    EXPECT_EQ(last.w, same.w);
}

// KHR_materials_variants: a part is chosen by each material that it can have, and is on that one's UVs.
TEST(MeshSelection, ChoosesPartsByTheMaterialsOfTheirVariants) {
    Mesh mesh = two_meshes();
    mesh.materials.push_back({"snow", "snow_n.png", 0});
    mesh.materials[3].has_normal_map = true;
    mesh.materials[3].uv_transform.scale_x = 2.0;
    mesh.parts[1].variants = {0, 3};
    const auto snow = select_part(mesh, of("snow"));
    ASSERT_TRUE(snow) << snow.error().reason;
    EXPECT_EQ(snow->part.triangles(), 18u);
    EXPECT_TRUE(snow->has_normal_map && snow->has_transform);
    EXPECT_EQ(snow->pieces.at(0).material, "snow");
    EXPECT_EQ(snow->part.uvs[0][1].x, 2.0f * mesh.parts[1].uvs[0][1].x);
    const auto stone = select_part(mesh, of("stone"));
    ASSERT_TRUE(stone) << stone.error().reason;
    EXPECT_EQ(stone->part.triangles(), 8u + 18u + 32u);
    const auto wood = select_part(mesh, of("wood"));
    ASSERT_TRUE(wood) << wood.error().reason;
    EXPECT_EQ(wood->part.triangles(), 18u);
}

TEST(MeshSelection, ChoosesByPrimitiveNodeAndUvSet) {
    Mesh mesh = two_meshes();
    MeshSelection selection;
    selection.primitive = 1;
    const auto second = select_part(mesh, selection);
    ASSERT_TRUE(second);
    EXPECT_EQ(second->part.triangles(), 18u);
    const auto north = select_part(mesh, of("stone", "north"));
    ASSERT_TRUE(north);
    EXPECT_EQ(north->part.triangles(), 8u);
    EXPECT_FLOAT_EQ(north->part.positions[0].x, 5.0f + mesh.parts[0].positions[0].x);
    mesh.parts[1].uvs.push_back(mesh.parts[1].uvs[0]);
    for (Float2& uv : mesh.parts[1].uvs[1]) uv = {uv.y, uv.x};
    mesh.parts[1].material = 2;  // whose map uses set 1
    const auto other = select_part(mesh, of("2"));
    ASSERT_TRUE(other);
    EXPECT_EQ(other->part.uvs[0][1].y, mesh.parts[1].uvs[0][1].x);
    selection = of("2");
    selection.uv_set = 0;
    const auto first = select_part(mesh, selection);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->part.uvs[0][1].y, mesh.parts[1].uvs[0][1].y);
}

// The tangents are those of the mesh itself, mirrored by the node.
TEST(MeshSelection, MirrorsTangentsWithTheNode) {
    const Mesh mesh = two_meshes();
    const auto plain = select_part(mesh, of("stone", "north")), mirrored = select_part(mesh, of("stone", "south"));
    ASSERT_TRUE(plain && mirrored);
    ASSERT_EQ(plain->tangents.size(), mirrored->tangents.size());
    for (std::size_t t = 0; t < plain->tangents.size(); t += 3) {
        const Float4 &a = plain->tangents[t + 1], &b = mirrored->tangents[t + 2];
        EXPECT_FLOAT_EQ(a.x, -b.x);
        EXPECT_FLOAT_EQ(a.y, b.y);
        EXPECT_EQ(a.w, -b.w);
    }
}

// `north` moves the first mesh by 5; `south`, which comes later, would mirror it.
TEST(MeshSelection, PlacesPartsWhereTheirFirstNodeDoes) {
    const Mesh mesh = two_meshes();
    MeshSelection selection = of("stone");
    selection.in_scene = true;
    const auto placed = select_part(mesh, selection);
    ASSERT_TRUE(placed);
    EXPECT_EQ(placed->part.triangles(), 8u + 32u);
    ASSERT_EQ(placed->pieces.size(), 2u);
    EXPECT_EQ(placed->pieces[0].name, "north");
    EXPECT_EQ(placed->pieces[0].material, "stone");
    EXPECT_EQ(placed->pieces[1].triangle, 8u);
    EXPECT_EQ(placed->part.positions.front().x, mesh.parts[0].positions.front().x + 5.0f);
    EXPECT_EQ(placed->part.positions.back().x, mesh.parts[2].positions[mesh.parts[2].indices.back()].x);
    selection.node = "south";
    EXPECT_EQ(select_part(mesh, selection)->part.triangles(), 8u);
}

TEST(MeshSelection, PlacesAllPartsOnceForEachNode) {
    Mesh mesh = two_meshes();
    const auto parts = parts_in_scene(mesh);
    ASSERT_TRUE(parts);
    ASSERT_EQ(parts->size(), 6u);  // two parts and one, by two nodes each
    EXPECT_EQ((*parts)[0].positions.front().x, mesh.parts[0].positions.front().x + 5.0f);
    EXPECT_EQ((*parts)[1].positions[1].x, -mesh.parts[0].positions[1].x);
    EXPECT_NE((*parts)[1].indices[1], mesh.parts[0].indices[1]);  // mirrored
    for (const MeshPart& part : *parts) EXPECT_TRUE(check_part(part));
    EXPECT_EQ((*parts)[0].name, "north");
    EXPECT_EQ((*parts)[1].name, "south");
    mesh.nodes.resize(1);
    EXPECT_EQ(parts_in_scene(mesh)->size(), 2u);
    mesh.nodes[0].mesh = 7;
    EXPECT_EQ(parts_in_scene(mesh).error().reason, "its scene shows no mesh");
    mesh.nodes.clear();
    EXPECT_EQ(parts_in_scene(mesh)->size(), 3u);
}

TEST(MeshSelection, CountsCopiesBeforeItMakesThem) {
    Mesh mesh = two_meshes();
    EXPECT_EQ(parts_in_scene(mesh, 132)->size(), 6u);
    EXPECT_EQ(parts_in_scene(mesh, 131).error().code, ErrorCode::unsupported);
    const MeshNode node = mesh.nodes[0];
    mesh.nodes.assign(600000, node);
    const auto many = parts_in_scene(mesh);
    ASSERT_FALSE(many);
    EXPECT_EQ(many.error().reason, "its 600000 nodes make 15600000 triangles of 58: too many copies");
    mesh.parts[0].indices.resize(3);  // a copy counts as 16 triangles
    mesh.parts.resize(1);
    mesh.nodes.resize(11);
    EXPECT_EQ(parts_in_scene(mesh, 176)->size(), 11u);
    EXPECT_FALSE(parts_in_scene(mesh, 175));
    mesh.nodes.resize(1);  // what is shown once has no limit
    EXPECT_EQ(parts_in_scene(mesh, 0)->size(), 1u);
}

TEST(MeshSelection, MatchesNamesByTheirStems) {
    const auto number = [](const std::string& low, const std::string& high) {
        const MatchedNames matched = match_names({low}, {high});
        EXPECT_EQ(matched.lone_low.empty(), matched.low == matched.high);
        EXPECT_EQ(matched.lone_high.empty(), matched.low == matched.high);
        return matched.low == matched.high;
    };
    EXPECT_TRUE(number("rock_low", "rock_high"));
    EXPECT_TRUE(number("Rock_Low", "rock_HIGH_bolts"));
    EXPECT_TRUE(number("rock.lp", "rock.hp.001"));
    EXPECT_TRUE(number("rock-lowpoly", "rock highpoly"));
    EXPECT_TRUE(number("rock_low_poly", "rock_high_poly"));
    EXPECT_TRUE(number("rock", "rock"));
    EXPECT_TRUE(number("rock", "rock_high"));
    EXPECT_TRUE(number("low_wall_low", "low_wall_high"));
    EXPECT_TRUE(number("", ""));
    EXPECT_FALSE(number("rock_low", "rocks_high"));
    EXPECT_FALSE(number("rock_lower", "rock_higher"));
    EXPECT_FALSE(number("low", "high"));
    EXPECT_FALSE(number("rock_high", "rock_low"));
    const MatchedNames many =
        match_names({"a_low", "b_low", "c_low", "c_low"}, {"b_high", "a_high_1", "a_high_2", "d"});
    EXPECT_EQ(many.low, (std::vector<int>{0, 1, 2, 2}));
    EXPECT_EQ(many.high, (std::vector<int>{1, 0, 0, 3}));
    EXPECT_EQ(many.lone_low, std::vector<std::string>{"c_low"});
    EXPECT_EQ(many.lone_high, std::vector<std::string>{"d"});
}

TEST(MeshSelection, TakesTangentsOfTheFileIfAllPartsHaveThem) {
    Mesh mesh = two_meshes();
    mesh.parts[0].tangents.assign(mesh.parts[0].positions.size(), {0.0f, 1.0f, 0.0f, -1.0f});
    MeshSelection selection = of("stone");
    EXPECT_EQ(select_part(mesh, selection)->source, TangentSource::mikktspace);
    selection.tangents = TangentSource::file;
    EXPECT_EQ(refusal(mesh, selection), "\"floor\" has no tangents; make them");
    mesh.parts[2].tangents.assign(mesh.parts[2].positions.size(), {0.0f, 1.0f, 0.0f, -1.0f});
    selection.tangents.reset();
    const auto stored = select_part(mesh, selection);
    ASSERT_TRUE(stored);
    EXPECT_EQ(stored->source, TangentSource::file);
    EXPECT_EQ(stored->tangents[7].y, 1.0f);
    selection.tangents = TangentSource::meshopt;
    EXPECT_NE(select_part(mesh, selection)->tangents[7].y, 1.0f);
    selection.tangents.reset();
    selection.uv_set = 0;  // the file does not say which set its tangents belong to
    EXPECT_EQ(select_part(mesh, selection)->source, TangentSource::mikktspace);
}

TEST(MeshSelection, ExplainsWhatIsMissing) {
    Mesh mesh = two_meshes();
    EXPECT_EQ(refusal(mesh, {}), "has 2 materials: \"stone\", \"wood\"");
    EXPECT_EQ(refusal(mesh, of("glass")), "has no material \"glass\"; it has \"stone\", \"wood\", 2");
    EXPECT_EQ(refusal(mesh, of("3")), "has no material \"3\"; it has \"stone\", \"wood\", 2");
    EXPECT_EQ(refusal(mesh, of("2")), "has no triangles with the material 2");
    EXPECT_EQ(refusal(mesh, of("stone", "west")),
              "has no node \"west\" with a mesh; it has \"north\", \"south\", \"twin\", \"twin\"");
    EXPECT_EQ(refusal(mesh, of("stone", "twin")), "has several nodes called \"twin\"");
    MeshSelection selection = of("stone");
    selection.uv_set = 1;
    EXPECT_EQ(refusal(mesh, selection), "\"wall\" has no UV set 1; the last one is 0");
    mesh.parts[0].normals.clear();
    EXPECT_EQ(refusal(mesh, of("stone")), "\"wall\" has no normals, which tangent space needs");
    Mesh bare = mesh;
    for (MeshPart& part : bare.parts) part.uvs.clear();
    EXPECT_EQ(refusal(bare, of("stone")), "\"wall\" has no UVs, which say where the map is");
    MeshNode flat{"flat", 1, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0}};
    mesh.nodes.push_back(flat);
    EXPECT_EQ(select_part(mesh, of("stone", "flat")).error().code, ErrorCode::bad_data);
}

TEST(MeshSelection, CutsOutUdimTiles) {
    Mesh mesh = two_meshes();
    mesh.parts.resize(1);
    mesh.parts[0].quads = {0, 2, 4, 6};
    for (std::size_t k = 0; k < mesh.parts[0].uvs[0].size(); ++k) {
        Float2& uv = mesh.parts[0].uvs[0][k];
        uv = {2.0f * uv.x + 3.0f, uv.y + 2.0f};  // over tiles 1024 and 1025, if v points up
    }
    const auto whole = select_part(mesh, {});
    ASSERT_TRUE(whole);
    for (const YAxis v_axis : {YAxis::up, YAxis::down}) {
        SelectedPart selected = *whole;
        selected.part.v_axis = v_axis;
        if (v_axis == YAxis::down) {
            for (Float2& uv : selected.part.uvs[0]) uv.y = 1.0f - uv.y;
        }
        const auto tile = in_tile(selected, 1025);
        ASSERT_TRUE(tile);
        EXPECT_TRUE(check_part(tile->part));
        ASSERT_EQ(tile->part.triangles(), 4u);
        ASSERT_EQ(tile->tangents.size(), 12u);
        EXPECT_EQ(tile->part.quads, (std::vector<std::uint32_t>{0, 2}));
        EXPECT_EQ(tile->rest.triangles(), selected.part.triangles() - 4);
        EXPECT_TRUE(check_part(tile->rest));
        EXPECT_EQ(tile->rest.normals.size(), selected.part.normals.size());
        ASSERT_EQ(tile->pieces.size(), selected.pieces.size());
        EXPECT_EQ(tile->pieces.front().triangle, 0u);
        EXPECT_LE(tile->pieces.back().triangle, 4u);
        for (std::size_t c = 0; c < 12; ++c) EXPECT_GE(tile->part.uvs[0][tile->part.indices[c]].x, 4.0f);
        EXPECT_TRUE(in_tile(selected, 1024));
        auto tiles = tiles_of(selected);
        ASSERT_TRUE(tiles);
        EXPECT_EQ(tiles->tiles, (std::vector<int>{1024, 1025}));
        EXPECT_EQ(tiles->outside, 0u);
        SelectedPart moved = selected;  // to the borders of the tiles and their middles
        for (Float2& uv : moved.part.uvs[0]) uv = {std::round(2.0f * uv.x) / 2.0f, std::round(2.0f * uv.y) / 2.0f};
        tiles = tiles_of(moved);
        EXPECT_EQ(tiles->outside + tiles->crossing, 0u);
        for (Float2& uv : moved.part.uvs[0]) uv.x -= 0.3f;
        tiles = tiles_of(moved);
        EXPECT_GT(tiles->crossing, 0u);
        for (Float2& uv : moved.part.uvs[0]) uv.x -= 10.0f;
        tiles = tiles_of(moved);
        EXPECT_TRUE(tiles->tiles.empty());
        EXPECT_EQ(tiles->outside, moved.part.triangles());
        const auto empty = in_tile(selected, 1001);
        ASSERT_FALSE(empty);
        EXPECT_EQ(empty.error().code, ErrorCode::bad_option);
        EXPECT_EQ(empty.error().reason, "has no triangle in UDIM tile 1001");
    }
}

}  // namespace
}  // namespace tex
