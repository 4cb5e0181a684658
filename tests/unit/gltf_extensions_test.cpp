// SPDX-License-Identifier: Apache-2.0
// Extensions of glTF that change meshes: where UVs and instances go, what is refused, what is named.

#include "mesh/gltf_extensions.h"

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/mesh.h>

#include "mesh/gltf.h"
#include "mesh/uv_transform.h"
#include "unit/gltf_files.h"

namespace tex {
namespace {

const std::string kWild = TEX_SOURCE_DIR "/../shared/data/wild/";

Result<Mesh> parsed(const std::string& file) {
    const LoadBeside nothing = [](const std::string& path) -> Result<std::vector<std::byte>> {
        return Error{ErrorCode::io, path, "is missing"};
    };
    return parse_gltf({reinterpret_cast<const std::byte*>(file.data()), file.size()}, nothing);
}

// A square with normals, and two sets of UVs: (0, 1), (1, 1), (1, 0), (0, 0), and their halves.
GltfMaker textured_square() {
    GltfMaker maker;
    maker.add(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 5126);
    maker.add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123);
    maker.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
    maker.add(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 5126);
    maker.add(std::vector<float>{0, 0.5f, 0.5f, 0.5f, 0.5f, 0, 0, 0}, "VEC2", 5126);
    return maker;
}

const std::string kTextured =
    R"({"attributes":{"POSITION":0,"NORMAL":2,"TEXCOORD_0":3,"TEXCOORD_1":4},"indices":1,"material":0})";

Result<Mesh> with_material(const std::string& material) {
    return parsed(textured_square().glb(kTextured, ",\"materials\":[" + material + "],\"textures\":[{}]"));
}

// The matrix of Matrix3.setUvTransform(tx, ty, sx, sy, rotation, 0, 0) of three.js for equal scales, and of
// KHR_texture_transform's example: offset (0, 1), a quarter turn and scale 0.5 show the lower left quarter.
TEST(UvTransforms, FollowTheExampleOfTheSpecification) {
    std::vector<Float2> uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    move_uvs(uvs, {0.0, 1.0, 1.57079632679, 0.5, 0.5}, YAxis::down);
    const Float2 expected[] = {{0, 1}, {0, 0.5f}, {0.5f, 1}, {0.5f, 0.5f}};
    for (std::size_t k = 0; k < uvs.size(); ++k) {
        EXPECT_EQ(uvs[k].x, expected[k].x) << k;
        EXPECT_EQ(uvs[k].y, expected[k].y) << k;
    }
}

TEST(UvTransforms, AreProductsOfTranslationRotationAndScale) {
    for (const double angle : {0.3, -2.0, 3.14159265, 40.0, 1.5707964}) {
        const UvTransform t{0.25, -1.5, angle, 3.0, 0.125};
        std::vector<Float2> uvs = {{0.75f, -0.5f}};
        move_uvs(uvs, t, YAxis::down);
        const double u = 0.75 * 3.0, v = -0.5 * 0.125;
        EXPECT_NEAR(uvs[0].x, std::cos(angle) * u + std::sin(angle) * v + 0.25, 1e-6);
        EXPECT_NEAR(uvs[0].y, -std::sin(angle) * u + std::cos(angle) * v - 1.5, 1e-6);
        std::vector<Float2> up = {{0.75f, 1.5f}};  // the same place
        move_uvs(up, t, YAxis::up);
        EXPECT_NEAR(up[0].x, uvs[0].x, 1e-6);
        EXPECT_NEAR(1.0 - static_cast<double>(up[0].y), static_cast<double>(uvs[0].y), 1e-6);
    }
}

TEST(UvTransforms, AreReadFromTheNormalTexture) {
    const auto mesh = with_material(R"({"normalTexture":{"index":0,"texCoord":0,"extensions":{"KHR_texture_transform":)"
                                    R"({"offset":[0.5,0.25],"rotation":0.5,"scale":[2,3],"texCoord":1}}}})");
    ASSERT_TRUE(mesh) << mesh.error().reason;
    const UvTransform expected{0.5, 0.25, 0.5, 2.0, 3.0};
    EXPECT_EQ(mesh->materials[0].uv_transform, expected);
    EXPECT_EQ(mesh->materials[0].uv_set, 1);
    EXPECT_TRUE(mesh->remarks.empty());
    const auto selected = select_part(*mesh, {});
    ASSERT_TRUE(selected);
    EXPECT_TRUE(selected->has_transform);
    std::vector<Float2> uvs = mesh->parts[0].uvs[1];
    move_uvs(uvs, expected, YAxis::down);
    for (std::size_t k = 0; k < uvs.size(); ++k) EXPECT_EQ(selected->part.uvs[0][k].x, uvs[k].x);
    MeshSelection other;
    other.uv_set = 0;
    const auto plain = select_part(*mesh, other);
    ASSERT_TRUE(plain);
    EXPECT_FALSE(plain->has_transform);
}

// A map is put on a mesh without a normal map as the other textures are.
TEST(UvTransforms, OfOtherTexturesCountIfTheyAgree) {
    const std::string moved = R"({"index":0,"extensions":{"KHR_texture_transform":{"scale":[4,4]}}})";
    const auto one = with_material("{\"occlusionTexture\":" + moved + "}");
    ASSERT_TRUE(one);
    EXPECT_EQ(one->materials[0].uv_transform.scale_x, 4.0);
    const auto two = with_material("{\"occlusionTexture\":" + moved + R"(,"emissiveTexture":{"index":0}})");
    ASSERT_TRUE(two);
    const auto selected = select_part(*two, {});
    ASSERT_TRUE(selected);
    EXPECT_FALSE(selected->has_transform);
    ASSERT_EQ(selected->remarks.size(), 1u);
    EXPECT_EQ(
        selected->remarks[0],
        "material 0 has no normal map, and its textures move UVs in several ways (KHR_texture_transform); the map "
        "is put on the UVs as they are stored");
}

TEST(UvTransforms, ThatAreDamagedAreRefused) {
    for (const char* bad : {R"("offset":[1])", R"("scale":[1,"a"])", R"("rotation":"x")", R"("texCoord":-1)",
                            R"("offset":[1e999,0])", R"("rotation":1e9)"}) {
        const auto mesh = with_material(R"({"normalTexture":{"index":0,"extensions":{"KHR_texture_transform":{)" +
                                        std::string(bad) + "}}}}");
        ASSERT_FALSE(mesh) << bad;
        EXPECT_EQ(mesh.error().code, ErrorCode::bad_data);
    }
    const auto far =
        with_material(R"({"normalTexture":{"index":0,"extensions":{"KHR_texture_transform":{"scale":[1e300,1]}}}})");
    ASSERT_TRUE(far);
    const auto selected = select_part(*far, {});
    ASSERT_FALSE(selected);
    EXPECT_EQ(selected.error().code, ErrorCode::bad_data);
}

// gltfpack quantises UVs and undoes that by a transform: 52,900 texels are covered, as by the sheet that it compressed.
TEST(UvTransforms, PutQuantisedUvsWhereTheyWere) {
    if (!std::filesystem::exists(kWild)) GTEST_SKIP() << "no ../shared/data";
    NormalMap flat({256, 256});
    flat.x = Plane<float>({256, 256}, 0.0f);
    flat.y = Plane<float>({256, 256}, 0.0f);
    flat.z = Plane<float>({256, 256}, 1.0f);
    for (const char* name : {"gltfpack_default_quantized.glb", "draco.glb", "meshopt.glb"}) {
        const auto mesh = read_mesh(kWild + name);
        ASSERT_TRUE(mesh) << mesh.error().message();
        const auto selected = select_part(*mesh, {});
        ASSERT_TRUE(selected) << name;
        const auto object = to_object_space(flat, {selected->part, selected->tangents, 0, Decoder::gltf, name});
        ASSERT_TRUE(object) << name;
        EXPECT_EQ(object->covered, 52900) << name;
    }
}

TEST(Obj, FacesWithoutUvsShowNoMap) {
    if (!std::filesystem::exists(kWild)) GTEST_SKIP() << "no ../shared/data";
    const auto mesh = read_mesh(kWild + "obj_one_face_without_vt.obj");
    ASSERT_TRUE(mesh);
    ASSERT_EQ(mesh->parts.size(), 2u);
    EXPECT_EQ(mesh->parts[0].triangles() + mesh->parts[1].triangles(), 320u);
    const auto selected = select_part(*mesh, {});
    ASSERT_TRUE(selected) << selected.error().reason;
    EXPECT_EQ(selected->part.triangles(), 319u);
    EXPECT_EQ(selected->remarks, std::vector<std::string>{"1 triangle has no UVs and shows no map"});
}

TEST(GltfExtensions, RefusesUnknownRequiredOnesByName) {
    const auto mesh = parsed(textured_square().glb(
        kTextured, R"(,"materials":[{}],"extensionsRequired":["KHR_materials_ior","ACME_twist"])"));
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().code, ErrorCode::unsupported);
    EXPECT_EQ(mesh.error().reason, "requires the extension ACME_twist, which is not supported");
}

TEST(GltfExtensions, NamesThoseThatMayMoveUvs) {
    const auto mesh = with_material(R"({"normalTexture":{"index":0,"extensions":{"ACME_uv_warp":{}}},)"
                                    R"("extensions":{"ACME_paint":{}}})");
    ASSERT_TRUE(mesh);
    ASSERT_EQ(mesh->remarks.size(), 1u);
    EXPECT_NE(mesh->remarks[0].find("uses the extension ACME_uv_warp"), std::string::npos);
    const auto selected = select_part(*mesh, {});
    ASSERT_TRUE(selected);
    EXPECT_EQ(selected->remarks, mesh->remarks);
}

TEST(GltfExtensions, NodesStandWhereTheirInstancesDo) {
    GltfMaker maker = textured_square();
    const int places = maker.add(std::vector<float>{1, 2, 3, 4, 5, 6}, "VEC3", 5126);
    const int sizes = maker.add(std::vector<float>{1, 1, 1, 2, 2, 2}, "VEC3", 5126);
    const std::string nodes =
        R"(,"materials":[{}],"nodes":[{"name":"tree","mesh":0,"translation":[10,0,0],"extensions":)"
        R"({"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":)" +
        std::to_string(places) + ",\"SCALE\":" + std::to_string(sizes) + "}}}}]";
    const auto mesh = parsed(maker.glb(kTextured, nodes));
    ASSERT_TRUE(mesh) << mesh.error().reason;
    ASSERT_EQ(mesh->nodes.size(), 2u);
    EXPECT_EQ(mesh->nodes[1].name, "tree[1]");
    EXPECT_EQ(mesh->nodes[1].to_scene[0], 2.0);
    EXPECT_EQ(mesh->nodes[1].to_scene[3], 14.0);
    EXPECT_EQ(mesh->nodes[1].to_scene[7], 5.0);
    const std::string wrong = R"(,"materials":[{}],"nodes":[{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":)"
                              R"({"attributes":{"ROTATION":)" +
                              std::to_string(places) + "}}}}]";
    EXPECT_FALSE(parsed(maker.glb(kTextured, wrong)));
}

TEST(GltfExtensions, DracoWithoutADecoderIsRefused) {
    GltfMaker maker = textured_square();
    const int view = maker.add_view(std::vector<std::uint8_t>{1, 2, 3, 4});
    const std::string primitive =
        R"({"attributes":{"POSITION":5},"indices":1,"extensions":{"KHR_draco_mesh_compression":)"
        R"({"bufferView":)" +
        std::to_string(view) + R"(,"attributes":{"POSITION":0}}}})";
    maker.add_accessor(4, "VEC3", 5126, "");
    const auto mesh = parsed(maker.glb(primitive));
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().reason, "is compressed by Draco");
}

}  // namespace
}  // namespace tex
