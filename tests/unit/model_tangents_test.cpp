// SPDX-License-Identifier: Apache-2.0
// write_model() with tangents, and with maps for materials that had none.

#include <tex/pipeline.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/mesh.h>
#include <nlohmann/json.hpp>

#include "scratch.h"
#include "unit/gltf_files.h"

namespace tex {
namespace {

using nlohmann::json;

constexpr const char* kMap = R"("materials":[{"name":"a","normalTexture":{"index":0,"scale":0.5,"texCoord":0,)"
                             R"("extensions":{"KHR_texture_transform":{"scale":[2,2]}}}},{"name":"b"}],)"
                             R"("textures":[{"source":0,"sampler":0}],"images":[{"bufferView":0,"mimeType":)"
                             R"("image/png"}],"samplers":[{}],"extensionsUsed":["KHR_texture_transform"])";

class ModelTangentsTest : public testing::Test, protected Scratch {
protected:
    // A strip of quads along x, with a picture in the first view. Neighbours share their corners.
    static GltfMaker strip(int quads) {
        GltfMaker maker;
        maker.add_view(std::vector<char>{'p', 'i', 'c', 't', 'u', 'r', 'e', 's'});
        std::vector<float> positions, normals, uvs;
        std::vector<std::uint16_t> indices;
        for (int k = 0; k <= quads; ++k) {
            for (int j = 0; j < 2; ++j) {
                positions.insert(positions.end(), {static_cast<float>(k), static_cast<float>(j), 0.0f});
                normals.insert(normals.end(), {0.0f, 0.0f, 1.0f});
                uvs.insert(uvs.end(),
                           {static_cast<float>(k % 2), static_cast<float>(1 - j)});  // every other one mirrored
            }
        }
        for (int k = 0; k < quads; ++k) {
            const auto a = static_cast<std::uint16_t>(2 * k);
            for (const int add : {0, 2, 3, 0, 3, 1}) indices.push_back(static_cast<std::uint16_t>(a + add));
        }
        maker.add(positions, "VEC3", 5126, R"(,"min":[0,0,0],"max":[)" + std::to_string(quads) + ",1,0]");
        maker.add(normals, "VEC3", 5126);
        maker.add(uvs, "VEC2", 5126);
        maker.add(indices, "SCALAR", 5123);
        return maker;
    }
    static std::string rest(const std::string& more) { return ",\"nodes\":[{\"mesh\":0}]," + more; }
    Mesh mesh(const std::string& name) const {
        auto read = read_mesh(path(name));
        EXPECT_TRUE(read) << read.error().message();
        return read ? std::move(*read) : Mesh{};
    }
    // The tangents of all parts, as MikkTSpace makes them.
    ModelChanges made(const std::string& name) const {
        ModelChanges changes;
        for (const MeshPart& part : mesh(name).parts)
            changes.tangents.push_back({part.mesh, part.primitive, *make_tangents(part)});
        return changes;
    }
    json document(const std::string& name) const {
        const std::string file = read(name);
        std::uint32_t size = 0;
        std::memcpy(&size, file.data() + 12, 4);
        return json::parse(file.substr(20, size));
    }
    // Every corner of `after` is that of `before`, with these tangents.
    static void same_corners(const MeshPart& before, const MeshPart& after, const std::vector<Float4>& tangents) {
        ASSERT_EQ(after.indices.size(), before.indices.size());
        ASSERT_EQ(after.tangents.size(), after.positions.size());
        for (std::size_t c = 0; c < before.indices.size(); ++c) {
            const std::size_t b = before.indices[c], a = after.indices[c];
            EXPECT_EQ(std::memcmp(&before.positions[b], &after.positions[a], sizeof(Float3)), 0) << c;
            EXPECT_EQ(std::memcmp(&before.normals[b], &after.normals[a], sizeof(Float3)), 0) << c;
            EXPECT_EQ(std::memcmp(&before.uvs[0][b], &after.uvs[0][a], sizeof(Float2)), 0) << c;
            EXPECT_EQ(std::memcmp(&tangents[c], &after.tangents[a], sizeof(Float4)), 0) << c;
        }
    }
};

TEST_F(ModelTangentsTest, PartsGetTangentsAndKeepTheirVertices) {
    write("m.glb", strip(1).glb(R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3})", rest(kMap)));
    const ModelChanges changes = made("m.glb");
    const auto written = write_model(path("m.glb"), path("out.glb"), changes);
    ASSERT_TRUE(written) << written.error().message();
    const MeshPart before = mesh("m.glb").parts.at(0), after = mesh("out.glb").parts.at(0);
    same_corners(before, after, changes.tangents[0].tangents);
    EXPECT_EQ(after.positions.size(), before.positions.size());
    EXPECT_EQ(document("out.glb")["bufferViews"].size(), document("m.glb")["bufferViews"].size() + 1);
    // A second time, the new tangents take the place of the old ones.
    ModelChanges turned = changes;
    for (Float4& t : turned.tangents[0].tangents) t = {0.0f, 1.0f, 0.0f, -1.0f};
    ASSERT_TRUE(write_model(path("out.glb"), path("again.glb"), turned));
    same_corners(before, mesh("again.glb").parts.at(0), turned.tangents[0].tangents);
    EXPECT_EQ(document("again.glb")["accessors"].size(), document("out.glb")["accessors"].size());
    EXPECT_EQ(read("again.glb").size(), read("out.glb").size());
}

// At a mirrored seam, both sides have other tangents, and so their common vertices become two.
TEST_F(ModelTangentsTest, VerticesWithSeveralTangentsAreCopied) {
    GltfMaker maker = strip(3);
    const int moved = maker.add(std::vector<float>(24, 0.25f), "VEC3", 5126);
    const std::string attributes = R"("attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2})";
    const int strips = maker.add(std::vector<std::uint16_t>{0, 2, 1, 3}, "SCALAR", 5123);
    write("m.glb", maker.glb("{" + attributes + R"(,"indices":3,"targets":[{"POSITION":)" + std::to_string(moved) +
                                 "}]},{" + attributes + R"(,"mode":5,"indices":)" + std::to_string(strips) + "}",
                             rest(kMap)));
    const ModelChanges changes = made("m.glb");
    const auto written = write_model(path("m.glb"), path("out.glb"), changes);
    ASSERT_TRUE(written) << written.error().message();
    const Mesh before = mesh("m.glb"), after = mesh("out.glb");
    for (std::size_t k = 0; k < 2; ++k) same_corners(before.parts[k], after.parts.at(k), changes.tangents[k].tangents);
    EXPECT_EQ(after.parts[0].positions.size(), 12u) << "four were shared by two sides";
    const json now = document("out.glb"), primitive = now["meshes"][0]["primitives"][0];
    for (const int accessor :
         {primitive["attributes"]["POSITION"].get<int>(), primitive["attributes"]["TANGENT"].get<int>(),
          primitive["targets"][0]["POSITION"].get<int>()})
        EXPECT_EQ(now["accessors"][static_cast<std::size_t>(accessor)]["count"], 12) << accessor;
    EXPECT_EQ(now["accessors"][0]["max"], document("m.glb")["accessors"][0]["max"]);
}

// What the scene shows, corner by corner, with tangents that MikkTSpace makes there or, `stored`, those of the file.
std::vector<std::vector<float>> scene_of(const Mesh& mesh, bool stored) {
    std::vector<std::vector<float>> corners;
    for (const MeshNode& node : mesh.nodes) {
        for (const MeshPart& part : mesh.parts) {
            if (part.mesh != node.mesh) continue;
            const auto placed = in_scene(part, node);
            EXPECT_TRUE(placed) << placed.error().message();
            const auto made = make_tangents(*placed);
            EXPECT_TRUE(made) << made.error().message();
            for (std::size_t c = 0; placed && made && c < placed->indices.size(); ++c) {
                const std::size_t v = placed->indices[c];
                const Float3 p = placed->positions[v], n = placed->normals[v];
                const Float2 uv = placed->uvs[0][v];
                const Float4 t = stored ? placed->tangents.at(v) : (*made)[c];
                std::vector<float> corner = {p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y, t.x, t.y, t.z, t.w};
                for (float& value : corner) value = std::round(value * 1e4f) / 1e4f + 0.0f;  // and no -0
                corners.push_back(std::move(corner));
            }
        }
    }
    std::sort(corners.begin(), corners.end());
    return corners;
}

// Whether a node of the file, with all that it is in, mirrors what it shows.
bool has_mirror(const Mesh& mesh) {
    return std::any_of(mesh.nodes.begin(), mesh.nodes.end(), [](const MeshNode& node) {
        const auto& m = node.to_scene;
        return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
                   m[2] * (m[4] * m[9] - m[5] * m[8]) <
               0.0;
    });
}

// Engines disagree about tangents below nodes that mirror; so the meshes are mirrored instead.
TEST_F(ModelTangentsTest, NodesNoLongerMirror) {
    const std::string attributes = R"("attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2})";
    const std::string matrix = R"({"mesh":0,"matrix":[0,2,0,0, 1,0,0,0, 0,0,1,0, 5,6,7,1]})";
    const std::string parent = R"({"scale":[1,-2,1],"translation":[1,2,3],"children":[2]})";
    struct Case {
        std::string nodes;
        int mirrors;
        std::size_t meshes, accessors;  // more of them
    };
    for (const Case& one : {
             Case{R"([{"mesh":0,"scale":[-1,1,1]}])", 1, 0, 1},
             Case{R"([{"mesh":0,"scale":[1,1,-3],"rotation":[0,0.6,0,0.8]},{"mesh":0}])", 1, 1, 5},
             Case{"[" + matrix + R"(,{"mesh":0,"scale":[-2,-1,1]}])", 1, 1, 5},
             Case{"[{\"name\":\"other\"}," + parent + R"(,{"mesh":0,"children":[3]},{"mesh":0,"scale":[2,2,2]}])", 2, 0,
                  1},
             Case{R"([{"mesh":0,"scale":[-1,-1,1]}])", 0, 0, 1},
         }) {
        for (const std::string mode : {"", R"("mode":5,)"}) {
            write("m.glb",
                  strip(1).glb("{" + mode + attributes + R"(,"indices":3})", ",\"nodes\":" + one.nodes + "," + kMap));
            const auto done = write_model(path("m.glb"), path("out.glb"), made("m.glb"));
            ASSERT_TRUE(done) << done.error().message();
            EXPECT_EQ(done->mirrors, one.mirrors) << one.nodes;
            EXPECT_EQ(done->left_mirrors, 0);
            EXPECT_FALSE(has_mirror(mesh("out.glb"))) << one.nodes;
            EXPECT_EQ(scene_of(mesh("out.glb"), true), scene_of(mesh("m.glb"), false)) << one.nodes;
            const json before = document("m.glb"), after = document("out.glb");
            EXPECT_EQ(after["meshes"].size(), before["meshes"].size() + one.meshes) << one.nodes;
            const std::size_t more = after["accessors"].size() - before["accessors"].size();
            EXPECT_TRUE(more == one.accessors || !mode.empty())
                << one.nodes << more;  // the strip gets further vertices
        }
    }
}

TEST_F(ModelTangentsTest, MirrorsTakeMorphsWeightsAndAnimationsAlong) {
    GltfMaker maker = strip(1);
    const int moved = maker.add(std::vector<float>{1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3}, "VEC3", 5126);
    maker.add(std::vector<float>{0.0f, 1.0f}, "SCALAR", 5126, R"(,"min":[0],"max":[1])");
    const std::string primitive = R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,"targets":)"
                                  R"([{"POSITION":)" +
                                  std::to_string(moved) + "}]}";
    const auto nodes = [&](const std::string& channels) {
        return R"(,"nodes":[{"mesh":0,"scale":[-1,1,1],"weights":[0.5]}],"animations":[{"samplers":[{"input":5,)"
               R"("output":5}],"channels":[)" +
               channels + "]}]," + kMap;
    };
    // The scale is animated, and so a child shows the mesh, with its weights.
    write("m.glb", maker.glb(primitive, nodes(R"({"sampler":0,"target":{"node":0,"path":"scale"}},{"sampler":0,)"
                                              R"("target":{"node":0,"path":"weights"}})")));
    ASSERT_TRUE(write_model(path("m.glb"), path("out.glb"), made("m.glb")));
    json now = document("out.glb");
    EXPECT_EQ(now["nodes"], json::parse(R"([{"scale":[-1,1,1],"children":[1]},{"mesh":0,"scale":[-1,1,1],)"
                                        R"("weights":[0.5]}])"));
    EXPECT_EQ(now["animations"][0]["channels"][1]["target"]["node"], 1);
    EXPECT_EQ(now["animations"][0]["channels"][0]["target"]["node"], 0);
    const std::size_t target = now["meshes"][0]["primitives"][0]["targets"][0]["POSITION"];
    EXPECT_EQ(now["accessors"][target]["min"], json::parse("[-1,2,3]"));
    // A pointer says what the node has, and so it stays.
    write("m.glb", maker.glb(primitive, nodes(R"({"sampler":0,"target":{"path":"pointer","extensions":)"
                                              R"({"KHR_animation_pointer":{"pointer":"/nodes/0/scale"}}}})")));
    const auto left = write_model(path("m.glb"), path("out.glb"), made("m.glb"));
    ASSERT_TRUE(left) << left.error().message();
    EXPECT_EQ(left->mirrors, 0);
    EXPECT_EQ(left->left_mirrors, 1);
    EXPECT_TRUE(has_mirror(mesh("out.glb")));
}

// Numbers of a file beside the model change there, in a file of the output.
TEST_F(ModelTangentsTest, MirrorsChangeBuffersBesideTheModel) {
    GltfMaker maker = strip(1);
    maker.uri = R"("uri":"m.bin",)";
    write("m.bin", maker.binary);
    write("m.gltf", maker.json(R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3})",
                               R"(,"nodes":[{"mesh":0,"scale":[-1,1,1]}])"));
    const ModelChanges changes = made("m.gltf");
    std::filesystem::create_directory(path("out"));
    for (const std::string name : {"out/m.gltf", "b.gltf"}) {
        const auto done = write_model(path("m.gltf"), path(name), changes);
        ASSERT_TRUE(done) << done.error().message();
    }
    EXPECT_EQ(read("m.bin"), maker.binary);
    for (const std::string name : {"out/m.gltf", "b.gltf"}) {
        EXPECT_FALSE(has_mirror(mesh(name)));
        EXPECT_EQ(scene_of(mesh(name), true), scene_of(mesh("m.gltf"), false)) << name;
    }
}

TEST_F(ModelTangentsTest, TangentsOfOtherTrianglesAreRefused) {
    write("m.glb", strip(2).glb(R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3})", rest(kMap)));
    ModelChanges changes = made("m.glb");
    changes.tangents[0].tangents.resize(6);
    EXPECT_EQ(write_model(path("m.glb"), path("out.glb"), changes).error().code, ErrorCode::bad_option);
    changes.tangents[0].tangents.clear();
    EXPECT_TRUE(model_files(path("m.glb"), path("out.glb"), changes));
    EXPECT_EQ(write_model(path("m.glb"), path("out.glb"), changes).error().code, ErrorCode::bad_option);
    EXPECT_FALSE(has("out.glb"));
}

class ModelSlots : public ModelTangentsTest {
protected:
    json written(ModelChanges changes) {
        const auto done = write_model(path("m.glb"), path("out.glb"), changes);
        EXPECT_TRUE(done) << done.error().message();
        return document("out.glb");
    }
    static ModelPicture picture(ModelMap map, Container container = Container::png) {
        return {{map}, container, std::vector<std::byte>(5, std::byte{'x'}), true};
    }
    void SetUp() override {
        write("m.glb",
              strip(1).glb(R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3})", rest(kMap)));
    }
};

TEST_F(ModelSlots, MapsThatAreMadeForAModelReplaceScaleAndTransform) {
    ModelMap map = read_model_maps(path("m.glb"))->maps.at(0);
    map.scale = 1.0;
    map.uv_transform = {};
    const json now = written({{picture(map)}});
    EXPECT_EQ(now["materials"][0]["normalTexture"], json::parse(R"({"index":0})"));
    EXPECT_FALSE(now.contains("extensionsUsed")) << "nothing has a transform any more";
}

TEST_F(ModelSlots, AMaterialWithoutAMapGetsOne) {
    ModelMap map;
    map.material = 1;
    map.uv_transform.scale_x = 15.5;
    const json now = written({{picture(map)}});
    const json slot = now["materials"][1]["normalTexture"];
    EXPECT_EQ(slot["extensions"]["KHR_texture_transform"]["scale"], json::parse("[15.5,1]"));
    EXPECT_EQ(now["textures"][slot["index"].get<std::size_t>()]["source"], 1);
    EXPECT_EQ(now["images"][1]["mimeType"], "image/png");
    EXPECT_EQ(now["materials"][0], document("m.glb")["materials"][0]);
    // Only if it asks for that.
    ModelPicture plain = picture(map);
    plain.sets_slots = false;
    EXPECT_EQ(write_model(path("m.glb"), path("no.glb"), {{plain}}).error().code, ErrorCode::bad_option);
}

TEST_F(ModelSlots, TwoMapsOfOneImageLeaveNoImageWithoutUse) {
    json model = document("m.glb");
    model["materials"][1] = model["materials"][0];
    const std::string file = read("m.glb");
    write("m.glb", GltfMaker::glb_of(model.dump(), file.substr(file.find("BIN") + 4)));
    const std::vector<ModelMap> maps = read_model_maps(path("m.glb"))->maps;
    const json now = written({{picture(maps.at(0)), picture(maps.at(1))}});
    EXPECT_EQ(now["images"].size(), 2u);
    EXPECT_EQ(now["textures"].size(), 2u);
    EXPECT_NE(now["materials"][0]["normalTexture"]["index"], now["materials"][1]["normalTexture"]["index"]);
    EXPECT_EQ(now["textures"][1]["sampler"], 0);
}

// A texture of roughness that something else uses, too, is split; other slots keep theirs.
TEST_F(ModelSlots, OcclusionGoesIntoTheTextureOfRoughness) {
    json model = document("m.glb");
    model["materials"][0]["pbrMetallicRoughness"] =
        json::parse(R"({"metallicRoughnessTexture":{"index":1},"baseColorTexture":{"index":1},"roughnessFactor":0.5})");
    model["textures"].push_back({{"source", 1}});
    model["images"].push_back({{"bufferView", 0}, {"mimeType", "image/jpeg"}, {"name", "orm"}});
    const std::string file = read("m.glb");
    write("m.glb", GltfMaker::glb_of(model.dump(), file.substr(file.find("BIN") + 4)));
    ModelPicture orm = picture(ModelMap{});
    orm.use = PictureUse::orm;
    const json now = written({{orm}});
    const json roughness = now["materials"][0]["pbrMetallicRoughness"];
    EXPECT_EQ(roughness, json::parse(R"({"metallicRoughnessTexture":{"index":2},"baseColorTexture":{"index":1},)"
                                     R"("roughnessFactor":0.5})"));
    EXPECT_EQ(now["materials"][0]["occlusionTexture"], json::parse(R"({"index":2})"));
    EXPECT_EQ(now["textures"][2], json::parse(R"({"source":2})"));
    EXPECT_EQ(now["images"][2]["mimeType"], "image/png");
    EXPECT_EQ(now["materials"][0]["normalTexture"], model["materials"][0]["normalTexture"]);
    // Nobody else: the picture takes the place of the old one.
    model["materials"][0]["pbrMetallicRoughness"].erase("baseColorTexture");
    write("m.glb", GltfMaker::glb_of(model.dump(), file.substr(file.find("BIN") + 4)));
    const json own = written({{orm}});
    EXPECT_EQ(own["textures"].size(), 2u);
    EXPECT_EQ(own["images"].size(), 2u);
    EXPECT_EQ(own["materials"][0]["occlusionTexture"], json::parse(R"({"index":1})"));
}

TEST_F(ModelSlots, OcclusionGetsAPictureOfItsOwn) {
    ModelMap map;
    map.material = 1;
    map.uv_transform.scale_x = 0.5;
    ModelPicture occlusion = picture(map);
    occlusion.use = PictureUse::occlusion;
    json now = written({{occlusion}});
    EXPECT_EQ(now["materials"][1]["occlusionTexture"],
              json::parse(R"({"index":1,"extensions":{"KHR_texture_transform":{"offset":[0,0],"scale":[0.5,1]}}})"));
    EXPECT_EQ(now["materials"][0], document("m.glb")["materials"][0]);
    // In place of another one, whose strength was for that.
    json model = document("m.glb");
    model["materials"][1]["occlusionTexture"] = json::parse(R"({"index":0,"strength":0.25})");
    const std::string file = read("m.glb");
    write("m.glb", GltfMaker::glb_of(model.dump(), file.substr(file.find("BIN") + 4)));
    now = written({{occlusion}});
    EXPECT_EQ(now["materials"][1]["occlusionTexture"]["index"], 1);
    EXPECT_FALSE(now["materials"][1]["occlusionTexture"].contains("strength"));
    // A material has no texture of roughness, no image of the map is asked for, and there are two materials.
    occlusion.use = PictureUse::orm;
    EXPECT_EQ(write_model(path("m.glb"), path("no.glb"), {{occlusion}}).error().reason, "material 1 has no such map");
    occlusion.use = PictureUse::occlusion;
    occlusion.maps[0].material = 2;
    EXPECT_EQ(write_model(path("m.glb"), path("no.glb"), {{occlusion}}).error().code, ErrorCode::bad_option);
}

TEST_F(ModelSlots, WebpIsNamedByItsExtension) {
    const ModelMap map = read_model_maps(path("m.glb"))->maps.at(0);
    const json now = written({{picture(map, Container::webp)}});
    EXPECT_EQ(now["textures"][0], json::parse(R"({"sampler":0,"extensions":{"EXT_texture_webp":{"source":0}}})"));
    EXPECT_EQ(now["extensionsRequired"], json::parse(R"(["EXT_texture_webp"])"));
    EXPECT_EQ(now["extensionsUsed"], json::parse(R"(["KHR_texture_transform","EXT_texture_webp"])"));
    EXPECT_EQ(now["images"][0]["mimeType"], "image/webp");
    // A PNG in its place needs no extension.
    ASSERT_TRUE(write_model(path("out.glb"), path("png.glb"), {{picture(map)}}));
    EXPECT_FALSE(document("png.glb").contains("extensionsRequired"));
}

}  // namespace
}  // namespace tex
