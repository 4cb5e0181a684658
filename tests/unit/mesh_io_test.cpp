// SPDX-License-Identifier: Apache-2.0

#include <tex/mesh.h>

#include <unistd.h>

#include <filesystem>
#include <limits>

#include <gtest/gtest.h>

#include "mesh/gltf_buffers.h"
#include "scratch.h"
#include "unit/gltf_files.h"

namespace tex {
namespace {

namespace fs = std::filesystem;

class MeshIo : public testing::Test, protected Scratch {
protected:
    [[nodiscard]] Result<Mesh> read(const std::string& bytes) const { return read_mesh(write("mesh.bin", bytes)); }
    void expect_refused(const std::string& bytes, ErrorCode code, const std::string& reason) const {
        const auto mesh = read(bytes);
        ASSERT_FALSE(mesh) << reason;
        EXPECT_EQ(mesh.error().code, code) << mesh.error().reason;
        EXPECT_EQ(mesh.error().reason, reason);
        EXPECT_EQ(mesh.error().file, path("mesh.bin"));
    }
};

const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::string kPrimitive = R"({"attributes":{"POSITION":0},"indices":1})";

GltfMaker square() {
    GltfMaker maker;
    maker.add(kSquare, "VEC3", 5126);
    maker.add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123);
    return maker;
}

TEST_F(MeshIo, ReadsGlbWithAllAttributes) {
    GltfMaker maker = square();
    maker.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
    maker.add(std::vector<float>{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1}, "VEC4", 5126);
    maker.add(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 5126);
    const auto mesh = read(maker.glb(
        R"({"attributes":{"POSITION":0,"NORMAL":2,"TANGENT":3,"TEXCOORD_0":4,"TEXCOORD_1":4},"indices":1,)"
        R"("material":1})",
        R"(,"materials":[{},{"name":"stone","normalTexture":{"index":0,"texCoord":1}}],"textures":[{"source":0}],)"
        R"("images":[{"uri":"stone_n.png"}],"nodes":[{"mesh":0,"name":"here","translation":[1,2,3]}],)"
        R"("scenes":[{"nodes":[0]}])"));
    ASSERT_TRUE(mesh) << mesh.error().reason;
    ASSERT_EQ(mesh->parts.size(), 1u);
    const MeshPart& part = mesh->parts[0];
    EXPECT_EQ(part.name, "m");
    EXPECT_EQ(part.material, 1);
    EXPECT_EQ(part.v_axis, YAxis::down);
    EXPECT_EQ(part.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(part.positions[2].y, 1.0f);
    EXPECT_EQ(part.normals[3].z, 1.0f);
    EXPECT_EQ(part.tangents[3].w, -1.0f);
    ASSERT_EQ(part.uvs.size(), 2u);
    EXPECT_EQ(part.uvs[1][1].x, 1.0f);
    EXPECT_EQ(mesh->materials[1].name, "stone");
    EXPECT_EQ(mesh->materials[1].normal_map, "stone_n.png");
    EXPECT_EQ(mesh->materials[1].uv_set, 1);
    ASSERT_EQ(mesh->nodes.size(), 1u);
    EXPECT_EQ(mesh->nodes[0].name, "here");
    EXPECT_EQ(mesh->nodes[0].to_scene[7], 2.0);
}

TEST_F(MeshIo, DropsVerticesThatNoTriangleUses) {
    GltfMaker maker;
    maker.add(kSquare, "VEC3", 5126);
    maker.add(std::vector<std::uint8_t>{3, 1, 2}, "SCALAR", 5121);
    const auto mesh = read(maker.glb(kPrimitive));
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->parts[0].indices, (std::vector<std::uint32_t>{2, 0, 1}));
    EXPECT_EQ(mesh->parts[0].positions.size(), 3u);
    EXPECT_EQ(mesh->parts[0].positions[0].x, 1.0f);
}

TEST_F(MeshIo, ReadsStripsAndFansAndSkipsLines) {
    const GltfMaker maker = square();
    const auto mesh = read(maker.glb(R"({"attributes":{"POSITION":0},"mode":5},{"attributes":{"POSITION":0},"mode":6},)"
                                     R"({"attributes":{"POSITION":0},"mode":1})"));
    ASSERT_TRUE(mesh);
    ASSERT_EQ(mesh->parts.size(), 2u);
    EXPECT_EQ(mesh->parts[0].indices, (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2}));
    EXPECT_EQ(mesh->parts[1].indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
}

TEST_F(MeshIo, ReadsQuantisedAttributes) {
    GltfMaker maker;
    maker.add(std::vector<std::int16_t>{0, 0, 0, 0, 7, 0, 0, 0, 7, -9, 0, 0}, "VEC3", 5122);
    maker.accessors.insert(maker.accessors.rfind("\"componentType\""), "");
    maker.add(std::vector<std::int8_t>{0, 0, 127, 0, -128, 0, 64, 0, 0, 0, 127, 0}, "VEC4", 5120,
              ",\"normalized\":true");
    maker.add(std::vector<std::uint16_t>{0, 65535, 13107, 0, 0, 0}, "VEC2", 5123, ",\"normalized\":true");
    // Positions are 8 bytes apart.
    maker.views.replace(maker.views.find("\"byteLength\":24}"), 16, "\"byteLength\":24,\"byteStride\":8}");
    maker.accessors.replace(maker.accessors.find("\"count\":4"), 9, "\"count\":3");
    const auto mesh = read(maker.glb(R"({"attributes":{"POSITION":0,"TANGENT":1,"TEXCOORD_0":2}})",
                                     R"(,"extensionsRequired":["KHR_mesh_quantization"])"));
    ASSERT_TRUE(mesh) << mesh.error().reason;
    const MeshPart& part = mesh->parts[0];
    EXPECT_EQ(part.positions[1].x, 7.0f);
    EXPECT_EQ(part.positions[2].y, -9.0f);
    EXPECT_EQ(part.tangents[0].z, 1.0f);
    EXPECT_EQ(part.tangents[1].x, -1.0f);  // -128 is -1, too
    EXPECT_EQ(part.tangents[1].z, 64.0f / 127.0f);
    EXPECT_EQ(part.uvs[0][0].y, 1.0f);
    EXPECT_EQ(part.uvs[0][1].x, 0.2f);
}

TEST_F(MeshIo, ReadsSparseAccessors) {
    GltfMaker maker = square();
    const int indices = maker.add_view(std::vector<std::uint8_t>{1, 3});
    const int values = maker.add_view(std::vector<float>{5, 6, 7, 8, 9, 10});
    const std::string sparse = R"(,"sparse":{"count":2,"indices":{"componentType":5121,"bufferView":)" +
                               std::to_string(indices) + R"(},"values":{"bufferView":)" + std::to_string(values) + "}}";
    const std::string primitive = R"({"attributes":{"POSITION":2},"indices":1})";
    GltfMaker with_base = maker;
    with_base.add_accessor(4, "VEC3", 5126, ",\"bufferView\":0" + sparse);
    const auto mesh = read(with_base.glb(primitive));
    ASSERT_TRUE(mesh) << mesh.error().reason;
    EXPECT_EQ(mesh->parts[0].positions[1].z, 7.0f);
    EXPECT_EQ(mesh->parts[0].positions[2].x, 1.0f);
    EXPECT_EQ(mesh->parts[0].positions[3].x, 8.0f);
    maker.add_accessor(4, "VEC3", 5126, sparse);  // of zeros
    const auto zeros = read(maker.glb(primitive));
    ASSERT_TRUE(zeros);
    EXPECT_EQ(zeros->parts[0].positions[1].z, 7.0f);
    EXPECT_EQ(zeros->parts[0].positions[2].x, 0.0f);
}

TEST_F(MeshIo, MultipliesTransformsOfNodes) {
    const auto mesh = read(square().glb(
        kPrimitive,
        R"(,"nodes":[{"children":[1,2],"translation":[10,0,0],"scale":[2,2,2]},)"
        R"({"mesh":0,"name":"turned","rotation":[0,0,0.7071067811865476,0.7071067811865476]},)"
        R"({"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,-1,0, 4,5,6,1]}],"scene":0,"scenes":[{"nodes":[0]}])"));
    ASSERT_TRUE(mesh) << mesh.error().reason;
    ASSERT_EQ(mesh->nodes.size(), 2u);
    const auto& turned = mesh->nodes[0].to_scene;
    const double expected[12] = {0, -2, 0, 10, 2, 0, 0, 0, 0, 0, 2, 0};
    for (std::size_t k = 0; k < 12; ++k) EXPECT_NEAR(turned[k], expected[k], 1e-12);
    EXPECT_EQ(mesh->nodes[1].to_scene, (std::array<double, 12>{2, 0, 0, 18, 0, 2, 0, 10, 0, 0, -2, 12}));
}

TEST_F(MeshIo, ReadsBuffersBesideTheFileAndInUris) {
    GltfMaker maker = square();
    ASSERT_TRUE(fs::exists(write("sub dir/a.bin", maker.binary)));
    for (const std::string uri : {"sub%20dir/a.bin", "./sub dir//a.bin"}) {
        maker.uri = "\"uri\":\"" + uri + "\",";
        const auto mesh = read(maker.json(kPrimitive));
        ASSERT_TRUE(mesh) << mesh.error().reason;
        EXPECT_EQ(mesh->parts[0].triangles(), 2u);
    }
    const auto decoded = decode_data_uri("data:application/octet-stream;base64,AAECAw==");
    ASSERT_TRUE(decoded);
    EXPECT_EQ(*decoded, (std::vector<std::byte>{std::byte{0}, std::byte{1}, std::byte{2}, std::byte{3}}));
    EXPECT_FALSE(decode_data_uri("data:;base64,A"));
    EXPECT_FALSE(decode_data_uri("data:;base64,A?=="));
    EXPECT_FALSE(decode_data_uri("data:text/plain"));
    EXPECT_FALSE(decode_data_uri("data:text/plain,a%4"));
    // RFC 2397 and RFC 3986: what is not base64 has bytes as %00, as base64 may have; the scheme has no case.
    EXPECT_EQ(*decode_data_uri("data:,%00%01%02%03"), *decoded);
    EXPECT_EQ(*decode_data_uri("data:;base64,AAECAw%3D%3d"), *decoded);
    maker.uri = "\"uri\":\"DATA:application/octet-stream,";
    for (const char c : maker.binary) {
        constexpr const char* kDigits = "0123456789abcdef";
        const auto byte = static_cast<unsigned char>(c);
        maker.uri += std::string("%") + kDigits[byte / 16] + kDigits[byte % 16];
    }
    maker.uri += "\",";
    const auto inside = read(maker.json(kPrimitive));
    ASSERT_TRUE(inside) << inside.error().reason;
    EXPECT_EQ(inside->parts[0].triangles(), 2u);
}

TEST_F(MeshIo, ReadsWhatTheValidatorFindsValidOrEnginesRead) {
    const GltfMaker maker = square();
    const auto reads = [&](const std::string& bytes) {
        const auto mesh = read(bytes);
        EXPECT_TRUE(mesh) << mesh.error().reason;
        return mesh && mesh->parts.at(0).triangles() == 2;
    };
    const std::string deep = ",\"extras\":" + std::string(1000, '[') + std::string(1000, ']');
    EXPECT_TRUE(reads(maker.glb(kPrimitive, deep)));
    GltfMaker text = maker;
    text.uri = "\"uri\":\"a.bin\",";
    EXPECT_NE(write("a.bin", maker.binary), "");
    EXPECT_TRUE(reads("\xef\xbb\xbf" + text.json(kPrimitive)));  // with a byte order mark
}

TEST_F(MeshIo, ReadsTheMaterialsOfVariants) {
    const std::string materials = R"(,"materials":[{"name":"a"},{"name":"b"},{"name":"c"}])";
    const auto with = [&](const std::string& mappings) {
        return read(square().glb(kPrimitive.substr(0, kPrimitive.rfind('}')) +
                                     R"(,"material":1,"extensions":{"KHR_materials_variants":{"mappings":[)" +
                                     mappings + "]}}}",
                                 materials));
    };
    const auto mesh = with(R"({"material":2},{"material":0},{"material":2},{"material":1})");
    ASSERT_TRUE(mesh) << mesh.error().reason;
    EXPECT_EQ(mesh->parts[0].material, 1);
    EXPECT_EQ(mesh->parts[0].variants, (std::vector<int>{0, 2}));
    EXPECT_TRUE(mesh->parts[0].can_have(0) && mesh->parts[0].can_have(1) && mesh->parts[0].can_have(2));
    EXPECT_FALSE(mesh->parts[0].can_have(-1));
    const auto none = with(R"({"material":3})");
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().reason, "mesh 0, primitive 0: the material of a variant does not exist");
}

TEST_F(MeshIo, NamesTheFilesThatAMeshConsistsOf) {
    GltfMaker maker = square();
    const std::string bin = write("sub dir/a.bin", maker.binary);
    maker.uri = "\"uri\":\"sub%20dir/a.bin\",";
    const std::string text = write("m.gltf", maker.json(kPrimitive));
    const std::string glb = write("m.glb", GltfMaker::glb_of(maker.json(kPrimitive), ""));
    for (const std::string& mesh : {text, glb}) {
        const auto files = mesh_files(mesh);
        ASSERT_TRUE(files) << files.error().reason;
        EXPECT_EQ(*files, (std::vector<std::string>{mesh, bin}));
    }
    EXPECT_EQ(mesh_files(bin).value(), std::vector<std::string>{bin});
    EXPECT_EQ(mesh_files("-").value(), std::vector<std::string>{"-"});
    fs::remove(bin);
    EXPECT_EQ(mesh_files(text).value(), std::vector<std::string>{text});
    EXPECT_EQ(mesh_files(bin).error().code, ErrorCode::io);
}

TEST_F(MeshIo, OpensNoFileOutsideOfItsFolder) {
    for (const std::string uri : {"../a.bin", "sub/../../a.bin", "/etc/passwd", "file:///etc/passwd", "%2e%2e/a.bin",
                                  "http://example.com/a", "a\\\\b", "%00", "", "."}) {
        GltfMaker maker = square();
        maker.uri = "\"uri\":\"" + uri + "\",";
        const auto mesh = read(maker.json(kPrimitive));
        ASSERT_FALSE(mesh) << uri;
        EXPECT_EQ(mesh.error().code, ErrorCode::unsupported) << mesh.error().reason;
    }
    GltfMaker maker = square();
    maker.uri = "\"uri\":\"missing.bin\",";
    const auto missing = read(maker.json(kPrimitive));
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::io);
    EXPECT_EQ(missing.error().file, path("missing.bin"));
}

TEST_F(MeshIo, RefusesDamagedGlbWithOneSentence) {
    const std::string good = square().glb(kPrimitive);
    ASSERT_TRUE(read(good));
    expect_refused(good.substr(0, good.size() - 4), ErrorCode::bad_data,
                   "truncated: its header claims " + std::to_string(good.size()) + " bytes, there are " +
                       std::to_string(good.size() - 4));
    expect_refused(good.substr(0, 15), ErrorCode::bad_data, "truncated: a GLB file has a header of 20 bytes");
    std::string old = good;
    old[4] = 1;
    expect_refused(old, ErrorCode::unsupported, "its GLB version is 1, only 2 is supported");
    for (std::size_t size = 1; size < good.size(); ++size) EXPECT_FALSE(read(good.substr(0, size)));
}

TEST_F(MeshIo, RefusesNumbersThatLeaveTheirPlaceWithOneSentence) {
    const std::string place = "mesh 0, primitive 0: ";
    GltfMaker maker;
    maker.add(kSquare, "VEC3", 5126);
    maker.add(std::vector<std::uint16_t>{0, 1, 4}, "SCALAR", 5123);
    expect_refused(maker.glb(kPrimitive), ErrorCode::bad_data, place + "index 4 is out of range: there are 4 vertices");
    maker = square();
    maker.accessors.replace(maker.accessors.find("\"count\":4"), 9, "\"count\":9007199254740991");
    expect_refused(maker.glb(kPrimitive), ErrorCode::bad_data,
                   place + "POSITION: accessor 0: leaves its buffer view: 9007199254740991 elements of 12 bytes in 48");
    maker = square();
    maker.views.replace(maker.views.find("\"byteLength\":48"), 15, "\"byteLength\":99");
    expect_refused(maker.glb(kPrimitive), ErrorCode::bad_data,
                   place + "POSITION: accessor 0: buffer view 0 leaves its buffer");
    maker = square();
    maker.add_accessor(1000000000, "VEC3", 5126, "");
    expect_refused(maker.glb(R"({"attributes":{"POSITION":2}})"), ErrorCode::bad_data,
                   place + "POSITION: accessor 2: claims 1000000000 elements without bytes");
    std::vector<float> infinite = kSquare;
    infinite[7] = std::numeric_limits<float>::infinity();
    maker = {};
    maker.add(infinite, "VEC3", 5126);
    maker.add(std::vector<std::uint16_t>{0, 1, 2}, "SCALAR", 5123);
    expect_refused(maker.glb(kPrimitive), ErrorCode::bad_data, place + "position 2 is not a finite number");
    expect_refused(square().glb(R"({"attributes":{"POSITION":1}})"), ErrorCode::bad_data,
                   place + "POSITION has numbers of the wrong type");
    expect_refused(square().glb(R"({"attributes":{"POSITION":7}})"), ErrorCode::bad_data,
                   place + "POSITION: an accessor does not exist");
}

// Khronos' validator judges them so: warnings and valid files are read, errors are refused.
TEST_F(MeshIo, ReadsWhatIsUnusualAndRefusesWhatIsWrong) {
    GltfMaker maker = square();
    const auto skipped = read(maker.glb(R"({"attributes":{"NORMAL":0}},)" + kPrimitive));
    ASSERT_TRUE(skipped) << "a primitive without positions draws nothing: " << skipped.error().reason;
    EXPECT_EQ(skipped->parts.size(), 1u);
    const auto incomplete = read(maker.glb(R"({"attributes":{"POSITION":0}})"));
    ASSERT_TRUE(incomplete) << "four corners are one triangle: " << incomplete.error().reason;
    EXPECT_EQ(incomplete->parts[0].triangles(), 1u);
    const std::string place = "mesh 0, primitive 0: ";
    expect_refused(maker.glb(R"({"indices":1})"), ErrorCode::bad_data, place + "POSITION: an accessor does not exist");
    maker.add(std::vector<std::uint8_t>{0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0}, "VEC4", 5121,
              ",\"normalized\":true");
    expect_refused(maker.glb(R"({"attributes":{"POSITION":0,"TANGENT":2},"indices":1})"), ErrorCode::bad_data,
                   place + "TANGENT has numbers of the wrong type");
    maker = square();
    maker.add_accessor(0, "VEC3", 5126, ",\"bufferView\":0");
    expect_refused(maker.glb(R"({"attributes":{"POSITION":2}})"), ErrorCode::bad_data,
                   place + "POSITION: accessor 2: is damaged");
    const auto turned = [&](const std::string& rotation) {
        return read(square().glb(kPrimitive, ",\"nodes\":[{\"mesh\":0,\"rotation\":[" + rotation + "]}]"));
    };
    EXPECT_TRUE(turned("0,0,0.6,0.8001"));
    EXPECT_FALSE(turned("0,0,0.6,1.8"));
    EXPECT_FALSE(turned("0,0,0,0"));
}

// A few bytes of JSON that name the same indices again and again must not become gigabytes.
TEST_F(MeshIo, RefusesMoreTrianglesThanTheBytesCanHold) {
    GltfMaker maker;
    maker.add(kSquare, "VEC3", 5126);
    maker.add(std::vector<std::uint8_t>(30000, 1), "SCALAR", 5121);
    std::string primitives = kPrimitive;
    for (int k = 0; k < 100; ++k) primitives += "," + kPrimitive;
    const auto mesh = read(maker.glb(primitives));
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().reason, "mesh 0, primitive 1: claims more triangles than the bytes of the file can hold");
}

TEST_F(MeshIo, RefusesDamagedJsonAndNodes) {
    expect_refused("{\"asset\":", ErrorCode::bad_data, "its JSON is damaged or truncated");
    expect_refused("{}", ErrorCode::bad_data, "is JSON, but not glTF: asset.version is missing");
    expect_refused(R"({"asset":{"version":"1.0"}})", ErrorCode::unsupported,
                   "its glTF version is 1.0, only 2.x is supported");
    expect_refused(R"({"asset":{"version":"2.0","minVersion":"2.1"}})", ErrorCode::bad_data,
                   "requires glTF version 2.1, and is of version 2.0");
    expect_refused(R"({"asset":{"version":"2.1","minVersion":"2.1"}})", ErrorCode::bad_data, "has no triangles");
    expect_refused(R"({"asset":{"version":"2.0"}})", ErrorCode::bad_data, "has no triangles");
    expect_refused("{\"a\":" + std::string(100000, '['), ErrorCode::bad_data,
                   "its JSON is nested deeper than 1024 levels");
    expect_refused(R"({"asset":{"version":"2.0"},"extensionsRequired":"KHR_texture_transform"})", ErrorCode::bad_data,
                   "its extensionsRequired is no list");
    expect_refused(R"({"asset":{"version":"2.0"},"extensionsRequired":[5]})", ErrorCode::bad_data,
                   "its extensionsRequired holds what is no name");
    expect_refused(R"({"asset":{"version":"2.0"},"extensionsRequired":["ACME_mesh_compression"]})",
                   ErrorCode::unsupported, "requires the extension ACME_mesh_compression, which is not supported");
    const std::string nodes = ",\"scenes\":[{\"nodes\":[0]}],\"nodes\":";
    expect_refused(square().glb(kPrimitive, nodes + R"([{"children":[1]},{"children":[0]}])"), ErrorCode::bad_data,
                   "node 0 has two parents, or is its own ancestor");
    expect_refused(square().glb(kPrimitive, nodes + R"([{"children":[7]}])"), ErrorCode::bad_data,
                   "a node does not exist");
    expect_refused(square().glb(kPrimitive, nodes + R"([{"mesh":1}])"), ErrorCode::bad_data,
                   "node 0: its mesh does not exist");
    expect_refused(square().glb(kPrimitive, nodes + R"([{"matrix":[1,2]}])"), ErrorCode::bad_data,
                   "node 0: its transform is damaged");
}

TEST_F(MeshIo, RefusesOtherFiles) {
    const std::string reason =
        "is not a mesh that libtex reads: glTF 2.0 (.gltf, .glb), OBJ, FBX, PLY and other types that Assimp knows";
    expect_refused("A text about meshes.\n", ErrorCode::unsupported, reason);
    expect_refused("", ErrorCode::bad_data, "is empty");
    EXPECT_EQ(read_mesh(path("none")).error().code, ErrorCode::io);
    const std::string path = write("mesh.bin", square().glb(kPrimitive));
    MeshReadOptions little;
    little.max_bytes = 100;
    EXPECT_EQ(read_mesh(path, little).error().code, ErrorCode::unsupported);
}

TEST(MeshIoData, RefusesHostileMeshesWithOneSentence) {
    const fs::path folder = TEX_SOURCE_DIR "/../shared/data/bad_mesh";
    if (!fs::exists(folder)) GTEST_SKIP() << "no shared data";
    const std::pair<const char*, const char*> reasons[] = {
        {"IndexOutOfRange.gltf", "mesh 0, primitive 0: index 255 is out of range: there are 24 vertices"},
        {"BoxWithInfinites.glb", "mesh 0, primitive 0: position 0 is not a finite number"},
        {"RecursiveNodes.gltf", "node 0 has two parents, or is its own ancestor"},
        {"texcoord_crash.gltf", "mesh 0, primitive 0: has TEXCOORD_1, but not TEXCOORD_0"},
        {"malformed.obj", "line 23: position 12 is out of range: there are 8"},
        {"empty.obj", "is empty"},
    };
    for (const auto& [name, reason] : reasons) {
        const auto mesh = read_mesh(folder / name);
        ASSERT_FALSE(mesh) << name;
        EXPECT_EQ(mesh.error().code, ErrorCode::bad_data) << name;
        EXPECT_EQ(mesh.error().reason, reason) << name;
    }
    EXPECT_FALSE(read_mesh(folder / "badUint.gltf"));
}

}  // namespace
}  // namespace tex
