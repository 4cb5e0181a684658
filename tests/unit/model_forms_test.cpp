// SPDX-License-Identifier: Apache-2.0
// Models that change their form: text with files beside it becomes GLB, and GLB becomes text.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/mesh.h>
#include <tex/pipeline.h>
#include <nlohmann/json.hpp>

#include "scratch.h"
#include "unit/gltf_files.h"

namespace tex {
namespace {

using nlohmann::json;

std::string text_of(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

class ModelForms : public testing::Test, protected Scratch {
protected:
    // A triangle with positions in one buffer, and all else in another; an image in a file, one in a data URI.
    ModelForms() {
        GltfMaker maker;
        maker.add(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0}, "VEC3", 5126);
        maker.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
        maker.add(std::vector<float>{0, 1, 1, 1, 1, 0}, "VEC2", 5126);
        maker.add(std::vector<std::uint16_t>{0, 1, 2}, "SCALAR", 5123);
        json model = json::parse(
            maker.json(R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,"material":0})",
                       R"(,"images":[{"uri":"maps/n%20a.png","name":"n"},{"uri":"data:image/png;base64,Y29sb3I="},
                          {"uri":"maps/n%20a.png"}],
                "textures":[{"source":0},{"source":1},{"source":2}],
                "materials":[{"normalTexture":{"index":0},"pbrMetallicRoughness":{"baseColorTexture":{"index":1}},
                              "emissiveTexture":{"index":2}}],"extras":{"kept":[1.50]})"));
        // One odd byte before the second part, so that places must move.
        const std::string first = maker.binary.substr(0, 36), second = maker.binary.substr(36);
        model["buffers"] = {{{"uri", "a.bin"}, {"byteLength", first.size()}, {"name", "first"}},
                            {{"uri", "maps/b.bin"}, {"byteLength", second.size()}}};
        for (json& view : model["bufferViews"]) {
            const auto offset = view["byteOffset"].get<std::size_t>();
            if (offset < 36) continue;
            view["buffer"] = 1;
            view["byteOffset"] = offset - 36;
        }
        write("in/m.gltf", "\xef\xbb\xbf" + model.dump());
        write("in/a.bin", first);
        write("in/maps/b.bin", second);
        write("in/maps/n a.png", std::string("\x89PNG old"));
    }
    ModelFiles writes(const std::string& from, const std::string& to, const ModelChanges& changes = {}) {
        std::filesystem::create_directories(std::filesystem::path(path(to)).parent_path());
        auto written = write_model(path(from), path(to), changes);
        EXPECT_TRUE(written) << written.error().message();
        return written ? *written : ModelFiles{};
    }
    // What a model says: triangles, materials, and the bytes of its images.
    std::string contents(const std::string& name) {
        MeshReadOptions all;
        all.images = true;
        const auto model = read_model(path(name), all);
        EXPECT_TRUE(model) << model.error().message();
        if (!model) return "";
        std::string text;
        for (const MeshPart& part : model->mesh.parts) {
            for (const Float3& p : part.positions) text += std::to_string(p.x) + " " + std::to_string(p.y) + ",";
            for (const Float2& uv : part.uvs.at(0)) text += std::to_string(uv.x) + " " + std::to_string(uv.y) + ",";
            for (const std::uint32_t v : part.indices) text += std::to_string(v) + ",";
        }
        for (const ModelImage& image : model->images) {
            EXPECT_FALSE(image.error);
            const bool is_inside = image.file.empty();
            const auto beside = std::filesystem::relative(image.file, path("")).string();
            text += "[" + (is_inside ? text_of(image.bytes) : read(beside)) + "]";
        }
        return text;
    }
};

TEST_F(ModelForms, TextBecomesOneFile) {
    const ModelFiles files = writes("in/m.gltf", "out/m.glb");
    ASSERT_EQ(files.files.size(), 1u);
    EXPECT_EQ(files.joined.size(), 3u) << "two buffers and the image";
    for (const char* const file : {"in/a.bin", "in/maps/b.bin", "in/maps/n a.png"})
        EXPECT_EQ(std::count(files.joined.begin(), files.joined.end(), path(file)), 1) << file;
    EXPECT_EQ(contents("out/m.glb"), contents("in/m.gltf"));
    const std::string glb = read("out/m.glb");
    const json now = json::parse(glb.substr(20, glb.find("BIN\0", 0, 4) - 24));
    EXPECT_EQ(now["buffers"].size(), 1u);
    EXPECT_EQ(now["buffers"][0]["name"], "first");
    EXPECT_FALSE(now["buffers"][0].contains("uri"));
    EXPECT_EQ(now["images"][0]["mimeType"], "image/png");
    EXPECT_EQ(now["images"][0]["bufferView"], now["images"][2]["bufferView"]) << "a file is there once";
    EXPECT_EQ(now["extras"]["kept"][0].dump(), "1.5");
    EXPECT_NE(glb.find("\"kept\":[1.5"), std::string::npos);
    std::filesystem::remove_all(path("in"));
    EXPECT_NE(contents("out/m.glb"), "");
}

TEST_F(ModelForms, OneFileBecomesTextAndComesBack) {
    writes("in/m.gltf", "out/m.glb");
    const ModelFiles files = writes("out/m.glb", "text/n.gltf");
    ASSERT_EQ(files.files.size(), 2u);
    EXPECT_EQ(files.files[0].path, path("text/n.bin"));
    EXPECT_EQ(contents("text/n.gltf"), contents("in/m.gltf"));
    writes("text/n.gltf", "again/m.glb");
    EXPECT_EQ(contents("again/m.glb"), contents("in/m.gltf"));
}

// What has no place of bytes in it stays as somebody wrote it: white space, numbers, escapes, the order of the keys.
TEST_F(ModelForms, TheTextThatStaysIsTheSame) {
    const std::string odd = std::string(R"("EXT_nobody" : {"b":1.50e+00 ,)") + "\n\t" +
                            R"("a":"\u0041\/", "a":-0 , "big":123456789012345678901234567890},)";
    std::string text = read("in/m.gltf");
    text.insert(text.find('{') + 1, odd);
    write("in/odd.gltf", text);
    writes("in/odd.gltf", "glb/odd.glb");
    writes("glb/odd.glb", "back/odd.gltf");
    const json model = json::parse(text.substr(3));
    for (const char* name : {"glb/odd.glb", "back/odd.gltf"}) {
        const std::string made = read(name);
        EXPECT_NE(made.find("{" + odd), std::string::npos) << name;
        for (const char* key : {"accessors", "materials", "meshes", "nodes", "scenes", "textures", "extras"}) {
            if (!model.contains(key)) continue;
            const std::string member = "\"" + std::string(key) + "\":" + model[key].dump();
            ASSERT_NE(text.find(member), std::string::npos) << key;
            EXPECT_NE(made.find(member), std::string::npos) << name << key;
        }
    }
}

// MikkTSpace makes none for triangles without an area in UV, and Khronos' validator calls their length an error.
TEST_F(ModelForms, TangentsWithoutALengthGetOne) {
    ModelChanges changes;
    changes.tangents.push_back({0, 0, {{0, 0, 0, -1}, {0, 1, 0, 1}, {0, 0, 0, 0}}});
    writes("in/m.gltf", "out/t.glb", changes);
    const auto model = read_model(path("out/t.glb"));
    ASSERT_TRUE(model) << model.error().message();
    ASSERT_EQ(model->mesh.parts.at(0).tangents.size(), 3u);
    for (const Float4& t : model->mesh.parts[0].tangents) {
        EXPECT_EQ(t.x * t.x + t.y * t.y + t.z * t.z, 1.0f);
        EXPECT_EQ(t.w * t.w, 1.0f);
    }
}

TEST_F(ModelForms, PicturesChangeOnTheWay) {
    const auto model = read_model_maps(path("in/m.gltf"));
    ASSERT_TRUE(model);
    ModelChanges changes;
    const std::string made = "\x89PNG made anew";
    const auto* const bytes = reinterpret_cast<const std::byte*>(made.data());
    changes.pictures.push_back({{model->maps.front()}, Container::png, {bytes, bytes + made.size()}});
    writes("in/m.gltf", "out/m.glb", changes);
    EXPECT_NE(contents("out/m.glb").find("[" + made + "][color][\x89PNG old]"), std::string::npos)
        << "the emissive texture had the same file";
    writes("out/m.glb", "text/m.gltf", changes);
    EXPECT_NE(contents("text/m.gltf").find("[" + made + "][color][\x89PNG old]"), std::string::npos);
}

TEST_F(ModelForms, WhatIsNotThereStaysNamed) {
    std::filesystem::remove(path("in/maps/n a.png"));
    const ModelFiles files = writes("in/m.gltf", "out/m.glb");
    EXPECT_EQ(files.missing, std::vector<std::string>{"maps/n a.png"});
    EXPECT_NE(read("out/m.glb").find("n%20a.png"), std::string::npos);
    std::filesystem::remove(path("in/a.bin"));
    const auto refused = write_model(path("in/m.gltf"), path("out/x.glb"), {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::io);
    EXPECT_FALSE(has("out/x.glb"));
}

TEST_F(ModelForms, NothingElseIsReplaced) {
    writes("in/m.gltf", "m.glb");
    write("text/m.bin", std::string("somebody's"));
    const auto refused = write_model(path("m.glb"), path("text/m.gltf"), {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().file, path("text/m.bin"));
    EXPECT_EQ(read("text/m.bin"), "somebody's");
    EXPECT_FALSE(has("text/m.gltf"));
    writes("m.glb", "other/m.gltf");
    writes("m.glb", "other/m.gltf");  // the old model names it
}

// Buffers that meshoptimizer fills have no bytes, and may come first.
TEST_F(ModelForms, BuffersWithoutBytesStay) {
    json model = json::parse(read("in/m.gltf").substr(3));
    json& buffers = model["buffers"];
    const json fallback = {{"byteLength", 64}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}};
    buffers.insert(buffers.begin(), fallback);
    for (json& view : model["bufferViews"]) view["buffer"] = view["buffer"].get<int>() + 1;
    write("in/f.gltf", model.dump());
    writes("in/f.gltf", "out/f.glb");
    EXPECT_EQ(contents("out/f.glb"), contents("in/m.gltf"));
    const std::string glb = read("out/f.glb");
    const json now = json::parse(glb.substr(20, glb.find("BIN\0", 0, 4) - 24));
    ASSERT_EQ(now["buffers"].size(), 2u);
    EXPECT_TRUE(now["buffers"][1].contains("extensions"));
}

TEST_F(ModelForms, ChunksThatTextCannotHoldAreRefused) {
    writes("in/m.gltf", "m.glb");
    std::string file = read("m.glb");
    file += std::string("\4\0\0\0ABCDdata", 12);
    const auto size = static_cast<std::uint32_t>(file.size());
    std::memcpy(file.data() + 8, &size, 4);
    write("m.glb", file);
    const auto refused = write_model(path("m.glb"), path("out.gltf"), {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::unsupported);
}

// A material for triangles that have none.
TEST_F(ModelForms, AMaterialIsAdded) {
    json model = json::parse(read("in/m.gltf").substr(3));
    model["meshes"][0]["primitives"][0].erase("material");
    for (const char* const key : {"materials", "textures", "images"}) model.erase(key);
    write("in/plain.gltf", model.dump());
    ModelMap map;
    map.image = -1;
    const std::string made = "\x89PNG made anew";
    const auto* const bytes = reinterpret_cast<const std::byte*>(made.data());
    ModelChanges changes;
    changes.pictures.push_back({{map}, Container::png, {bytes, bytes + made.size()}, true});
    EXPECT_FALSE(write_model(path("in/plain.gltf"), path("out/p.glb"), changes)) << "there is no material 0";
    changes.adds_material = true;
    for (const char* const name : {"out/p.glb", "out/p.gltf"}) {
        writes("in/plain.gltf", name, changes);
        const auto read = read_model(path(name));
        ASSERT_TRUE(read) << read.error().message();
        EXPECT_EQ(read->mesh.parts.front().material, 0);
        ASSERT_EQ(read->maps.size(), 1u);
        EXPECT_EQ(read->maps.front().material, 0);
        EXPECT_NE(contents(name).find(made), std::string::npos);
    }
}

}  // namespace
}  // namespace tex
