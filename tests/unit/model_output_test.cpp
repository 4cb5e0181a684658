// SPDX-License-Identifier: Apache-2.0

#include <tex/pipeline.h>

#include <algorithm>
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

std::vector<std::byte> bytes_of(const std::string& text) {
    const auto* const begin = reinterpret_cast<const std::byte*>(text.data());
    return {begin, begin + text.size()};
}

// The chunks of a GLB file.
struct Chunks {
    explicit Chunks(const std::string& file) {
        std::uint32_t size = 0;
        EXPECT_EQ(file.substr(0, 4), "glTF");
        std::memcpy(&size, file.data() + 8, 4);
        EXPECT_EQ(size, file.size());
        for (std::size_t at = 12; at + 8 <= file.size();) {
            std::memcpy(&size, file.data() + at, 4);
            EXPECT_EQ(size % 4, 0u);
            parts.push_back(file.substr(at + 8, size));
            at += 8 + size;
        }
        text = parts.at(0);
        document = json::parse(text);
        if (parts.size() > 1) binary = parts[1];
    }
    [[nodiscard]] std::string view(int index) const {
        const json& view = document["bufferViews"][static_cast<std::size_t>(index)];
        return binary.substr(view.value("byteOffset", std::size_t{0}), view["byteLength"].get<std::size_t>());
    }
    [[nodiscard]] std::string image(int index) const {
        return view(document["images"][static_cast<std::size_t>(index)]["bufferView"].get<int>());
    }
    [[nodiscard]] int source_of_slot(const json& slot) const {
        return document["textures"][slot["index"].get<std::size_t>()]["source"].get<int>();
    }

    std::vector<std::string> parts;
    std::string text, binary;
    json document;
};

class ModelOutput : public testing::Test, protected Scratch {
protected:
    // Gives each map of the material, or of all, the bytes `picture`: one picture for each image.
    Result<ModelFiles> change(const std::string& from, const std::string& to, const std::string& material,
                              const std::string& picture, Container container = Container::png,
                              const WriteOptions& writing = {}) {
        const auto model = read_model_maps(path(from));
        if (!model) return model.error();
        const auto maps = maps_of(*model, material);
        if (!maps) return maps.error();
        std::vector<ModelPicture> pictures;
        for (const ModelMap& map : *maps) {
            const auto same = std::find_if(pictures.begin(), pictures.end(), [&](const ModelPicture& known) {
                return known.maps.front().image == map.image;
            });
            if (same != pictures.end())
                same->maps.push_back(map);
            else
                pictures.push_back({{map}, container, bytes_of(picture)});
        }
        return write_model(path(from), path(to), {pictures}, {}, writing);
    }
    void changes(const std::string& from, const std::string& to, const std::string& material,
                 const std::string& picture, Container container = Container::png) {
        const auto written = change(from, to, material, picture, container);
        ASSERT_TRUE(written) << written.error().message();
    }
    void refuses(const std::string& from, const std::string& to, const std::string& reason) {
        const auto written = change(from, to, "", "new");
        ASSERT_FALSE(written) << reason;
        EXPECT_NE(written.error().message().find(reason), std::string::npos) << written.error().message();
        EXPECT_FALSE(has(to));
    }
    // A GLB file of three views, which hold an image, numbers and another image.
    void write_glb(const std::string& materials, const std::string& textures = R"([{"source":0},{"source":1}])",
                   const std::string& more = "") {
        const std::string text =
            R"({ "asset":{"version":"2.0"}, "buffers":[{"byteLength":28}],
            "bufferViews":[{"buffer":0,"byteLength":9},{"buffer":0,"byteOffset":12,"byteLength":8},
                           {"byteOffset":20,"buffer":0,"byteLength":5}],
            "accessors":[{"bufferView":1,"componentType":5126,"count":2,"type":"SCALAR","max":[1.50e+0],"min":[-0.0]}],
            "images":[{"bufferView":0,"mimeType":"image/jpeg","name":"n"},{"bufferView":2,"mimeType":"image/png"}],
            "textures":)" +
            textures + R"(,"materials":)" + materials + more + R"(,"extras":{"z":1,"a":[1E5]}})";
        write("m.glb", GltfMaker::glb_of(text, std::string("oldimage!\0\0\0numbers.color\0\0\0", 28)));
    }
    [[nodiscard]] Chunks chunks(const std::string& name) const { return Chunks(read(name)); }
};

constexpr const char* kOneMaterial = R"([{"name":"a","normalTexture":{"index":0,"scale":0.50},)"
                                     R"("pbrMetallicRoughness":{"baseColorTexture":{"index":1}}}])";

TEST_F(ModelOutput, AllElseKeepsItsBytes) {
    write_glb(kOneMaterial);
    for (const std::string picture : {"x", "exactly 9", "a picture that is longer than the old one"}) {
        changes("m.glb", "out.glb", "", picture);
        const Chunks before = chunks("m.glb"), after = chunks("out.glb");
        EXPECT_EQ(after.image(0), picture);
        EXPECT_EQ(after.view(1), "numbers.");
        EXPECT_EQ(after.image(1), "color");
        EXPECT_EQ(after.document["bufferViews"][1]["byteOffset"].get<int>() % 8, 12 % 8) << "as it was";
        EXPECT_EQ(after.document["images"][0]["mimeType"], "image/png");
        // What changed is a number or a word; all text between stays.
        std::string text = after.text;
        for (const auto& [now, was] : std::vector<std::pair<std::string, std::string>>{
                 {"\"byteLength\":" + std::to_string(picture.size()), "\"byteLength\":9"},
                 {"\"byteOffset\":" + after.document["bufferViews"][1]["byteOffset"].dump() + ",",
                  "\"byteOffset\":12,"},
                 {"{\"byteOffset\":" + after.document["bufferViews"][2]["byteOffset"].dump() + ",\"buffer\"",
                  "{\"byteOffset\":20,\"buffer\""},
                 {"\"byteLength\":" + after.document["buffers"][0]["byteLength"].dump(), "\"byteLength\":28"},
                 {"\"mimeType\":\"image/png\",\"name\"", "\"mimeType\":\"image/jpeg\",\"name\""}}) {
            const std::size_t at = text.find(now);
            ASSERT_NE(at, std::string::npos) << now;
            text.replace(at, now.size(), was);
        }
        text.resize(text.find_last_not_of(' ') + 1);
        EXPECT_EQ(text, before.text.substr(0, before.text.find_last_not_of(' ') + 1));
    }
}

TEST_F(ModelOutput, WhatFollowsTheChunksStays) {
    write_glb(kOneMaterial);
    std::string file = read("m.glb");
    const std::string chunk = std::string("\4\0\0\0ABCDdata", 12);
    const auto size = static_cast<std::uint32_t>(file.size() + chunk.size());
    std::memcpy(file.data() + 8, &size, 4);
    write("m.glb", file + chunk);
    changes("m.glb", "out.glb", "", "another picture");
    ASSERT_EQ(chunks("out.glb").parts.size(), 3u);
    EXPECT_EQ(chunks("out.glb").parts[2], "data");
}

TEST_F(ModelOutput, ATextureOfAColourIsSplit) {
    write_glb(R"([{"normalTexture":{"index":0,"texCoord":1},"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])",
              R"([{"source":0,"sampler":0},{"source":1}])", R"(,"samplers":[{}])");
    changes("m.glb", "out.glb", "", "normals");
    const Chunks after = chunks("out.glb");
    const json& material = after.document["materials"][0];
    EXPECT_EQ(after.image(after.source_of_slot(material["normalTexture"])), "normals");
    EXPECT_EQ(after.image(after.source_of_slot(material["pbrMetallicRoughness"]["baseColorTexture"])), "oldimage!");
    EXPECT_EQ(material["normalTexture"]["texCoord"], 1);
    EXPECT_EQ(after.document["textures"][2]["sampler"], 0);
    EXPECT_EQ(after.document["images"][2]["name"], "n");
    EXPECT_EQ(after.document["images"][0]["mimeType"], "image/jpeg");
    EXPECT_EQ(after.document["bufferViews"][3]["byteOffset"].get<int>() % 8, 0);
    EXPECT_EQ(after.binary.substr(0, 28), chunks("m.glb").binary);
}

TEST_F(ModelOutput, OnlyTheMaterialGetsThePicture) {
    const std::string materials = R"([{"name":"a","normalTexture":{"index":0}},{"name":"b","normalTexture":{"index":0}},
        {"name":"c","extensions":{"KHR_materials_clearcoat":{"clearcoatNormalTexture":{"index":2}}}}])";
    write_glb(materials, R"([{"source":0},{"source":1},{"source":0}])");
    changes("m.glb", "out.glb", "b", "for b");
    Chunks after = chunks("out.glb");
    const auto image_of = [&](const json& slot) { return after.image(after.source_of_slot(slot)); };
    EXPECT_EQ(image_of(after.document["materials"][0]["normalTexture"]), "oldimage!");
    EXPECT_EQ(image_of(after.document["materials"][1]["normalTexture"]), "for b");
    changes("m.glb", "out.glb", "c", "for c");  // it shares no texture, but its image
    after = chunks("out.glb");
    EXPECT_EQ(image_of(after.document["materials"][1]["normalTexture"]), "oldimage!");
    EXPECT_EQ(
        image_of(after.document["materials"][2]["extensions"]["KHR_materials_clearcoat"]["clearcoatNormalTexture"]),
        "for c");
    EXPECT_EQ(after.document["textures"].size(), 3u);
    changes("m.glb", "out.glb", "", "for all");
    after = chunks("out.glb");
    EXPECT_EQ(after.document["images"].size(), 2u);
    EXPECT_EQ(after.document["textures"].size(), 3u);
    EXPECT_EQ(image_of(after.document["materials"][1]["normalTexture"]), "for all");
}

TEST_F(ModelOutput, BytesThatAnotherImageUsesStay) {
    write_glb(kOneMaterial);
    std::string file = read("m.glb");
    file.replace(file.find("\"bufferView\":2"), 14, "\"bufferView\":0");
    write("m.glb", file);
    changes("m.glb", "out.glb", "", "new");
    const Chunks after = chunks("out.glb");
    EXPECT_EQ(after.image(0), "new");
    EXPECT_EQ(after.image(1), "oldimage!");
}

TEST_F(ModelOutput, ExtensionsThatNameTheImageGo) {
    write_glb(kOneMaterial, R"([{"extensions":{"EXT_texture_webp":{"source":0}}},{"source":1}])",
              R"(,"extensionsUsed":["EXT_texture_webp","KHR_x"],"extensionsRequired":["EXT_texture_webp"])");
    changes("m.glb", "out.glb", "", "png");
    const Chunks after = chunks("out.glb");
    EXPECT_EQ(after.document["textures"][0], json::parse(R"({"source":0})"));
    EXPECT_EQ(after.document["extensionsUsed"], json::parse(R"(["KHR_x"])"));
    EXPECT_FALSE(after.document.contains("extensionsRequired"));
    EXPECT_EQ(after.image(0), "png");
}

TEST_F(ModelOutput, CompressedBytesMoveWithTheirOffsets) {
    write_glb(kOneMaterial);
    std::string file = read("m.glb");
    Chunks before(file);
    before.document["bufferViews"][1] = json::parse(
        R"({"buffer":1,"byteLength":8,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteOffset":12,
        "byteLength":8,"mode":"ATTRIBUTES","byteStride":4,"count":2}}})");
    before.document["buffers"].push_back(
        json::parse(R"({"byteLength":8,"extensions":{"EXT_meshopt_compression":{"fallback":true}}})"));
    write("m.glb", GltfMaker::glb_of(before.document.dump(), before.binary));
    changes("m.glb", "out.glb", "", "0123456789012345678");
    const Chunks after = chunks("out.glb");
    const json& view = after.document["bufferViews"][1]["extensions"]["EXT_meshopt_compression"];
    EXPECT_EQ(after.binary.substr(view["byteOffset"].get<std::size_t>(), 8), "numbers.");
    EXPECT_FALSE(after.document["bufferViews"][1].contains("byteOffset"));
}

TEST_F(ModelOutput, InGlbASplitPictureNeedsNoFile) {
    write_glb(R"([{"normalTexture":{"index":0},"emissiveTexture":{"index":0}}])");
    Chunks before = chunks("m.glb");
    before.document["images"][0] = json::parse(R"({"uri":"n.png"})");
    write("m.glb", GltfMaker::glb_of(before.document.dump(), before.binary));
    write("n.png", std::string("old"));
    changes("m.glb", "out.glb", "", "new");
    const Chunks after = chunks("out.glb");
    EXPECT_EQ(after.image(after.source_of_slot(after.document["materials"][0]["normalTexture"])), "new");
    EXPECT_EQ(after.document["images"][0]["uri"], "n.png");
}

class ModelOutputFiles : public ModelOutput {
protected:
    ModelOutputFiles() {
        write("in/m.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"uri":"m.bin","byteLength":4}],
"images":[{"uri":"maps/n%20a.jpg"},{"uri":"maps/color.png"},{"uri":"gone.png"}],
"textures":[{"source":0},{"source":1},{"source":2}],
"materials":[{"normalTexture":{"index":0},"pbrMetallicRoughness":{"baseColorTexture":{"index":1}}}]})");
        write("in/m.bin", std::string("bin!"));
        write("in/maps/n a.jpg", std::string("old"));
        write("in/maps/color.png", std::string("color"));
        std::filesystem::create_directory(path("out"));
    }
};

TEST_F(ModelOutputFiles, InAnotherFolderEverythingIsCopied) {
    const auto written = change("in/m.gltf", "out/m.gltf", "", "new");
    ASSERT_TRUE(written) << written.error().message();
    EXPECT_EQ(read("out/maps/n a.png"), "new");
    EXPECT_EQ(read("out/maps/color.png"), "color");
    EXPECT_EQ(read("out/m.bin"), "bin!");
    EXPECT_FALSE(has("out/maps/n a.jpg"));
    EXPECT_EQ(written->missing, std::vector<std::string>{"gone.png"});
    EXPECT_EQ(written->files.back().path, path("out/m.gltf"));
    EXPECT_EQ(json::parse(read("out/m.gltf"))["images"][0]["uri"], "maps/n%20a.png");
    std::string text = read("out/m.gltf");
    text.replace(text.find("a.png"), 5, "a.jpg");
    EXPECT_EQ(text, read("in/m.gltf"));
    EXPECT_EQ(read("in/maps/n a.jpg"), "old");
    // Again, over itself.
    changes("in/m.gltf", "out/m.gltf", "", "newer");
    EXPECT_EQ(read("out/maps/n a.png"), "newer");
    // The name of a file is the model's, so that a link there is no wish of the user.
    write("victim", std::string("mine"));
    std::filesystem::remove(path("out/m.bin"));
    std::filesystem::create_symlink(path("victim"), path("out/m.bin"));
    changes("in/m.gltf", "out/m.gltf", "", "newest");
    EXPECT_EQ(read("victim"), "mine");
    EXPECT_EQ(read("out/m.bin"), "bin!");
}

TEST_F(ModelOutputFiles, InTheSameFolderOnlyNewNamesAreWritten) {
    const auto before = list();
    const auto written = change("in/m.gltf", "in/fixed.gltf", "", "new", Container::jpeg);
    ASSERT_TRUE(written) << written.error().message();
    EXPECT_EQ(read("in/maps/fixed_n a.jpg"), "new");
    EXPECT_EQ(list().size(), before.size() + 2);
    EXPECT_EQ(read("in/maps/n a.jpg"), "old");
    EXPECT_EQ(json::parse(read("in/fixed.gltf"))["images"][0]["uri"], "maps/fixed_n%20a.jpg");
    EXPECT_TRUE(written->missing.empty());
}

TEST_F(ModelOutputFiles, AFileThatAColourUsesStays) {
    std::string text = read("in/m.gltf");
    text.replace(text.find("color.png"), 9, "n%20a.jpg");
    write("in/m.gltf", text);
    changes("in/m.gltf", "out/m.gltf", "", "new", Container::jpeg);
    EXPECT_EQ(read("out/maps/n a.jpg"), "old");
    EXPECT_EQ(read("out/maps/m_n a.jpg"), "new");
}

TEST_F(ModelOutputFiles, PicturesInABufferFileMakeAnotherOne) {
    write("in/m.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"uri":"m.bin","byteLength":4}],
"bufferViews":[{"buffer":0,"byteLength":3}],"images":[{"bufferView":0,"mimeType":"image/png"}],
"textures":[{"source":0}],"materials":[{"normalTexture":{"index":0}}]})");
    changes("in/m.gltf", "in/b.gltf", "", "abcde");
    EXPECT_EQ(read("in/b_m.bin").substr(0, 5), "abcde");
    EXPECT_EQ(read("in/m.bin"), "bin!");
    changes("in/m.gltf", "out/m.gltf", "", "abcde");
    EXPECT_EQ(read("out/m.bin"), read("in/b_m.bin"));
}

TEST_F(ModelOutputFiles, DataUrisStayDataUris) {
    write("in/m.gltf", R"({"asset":{"version":"2.0"},"images":[{"uri":"data:image/jpeg;base64,b2xk"}],
"textures":[{"source":0}],"materials":[{"normalTexture":{"index":0}}]})");
    for (const std::string picture : {"a", "ab", "abc", "abcd"}) {
        changes("in/m.gltf", "in/out.gltf", "", picture);
        const auto model = read_model_maps(path("in/out.gltf"));
        ASSERT_TRUE(model);
        EXPECT_EQ(model->images[0].bytes, bytes_of(picture));
        EXPECT_NE(read("in/out.gltf").find("\"data:image/png;base64,Y"), std::string::npos);
    }
    // And buffers in them.
    write("in/b.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"uri":"data:application/octet-stream;base64,b2xkIQ==",
"byteLength":4}],"bufferViews":[{"buffer":0,"byteLength":3}],"images":[{"bufferView":0,"mimeType":"image/png"}],
"textures":[{"source":0}],"materials":[{"normalTexture":{"index":0}}]})");
    changes("in/b.gltf", "in/out.gltf", "", "longer than that");
    const auto model = read_model_maps(path("in/out.gltf"));
    ASSERT_TRUE(model);
    EXPECT_EQ(model->images[0].bytes, bytes_of("longer than that"));
    EXPECT_NE(read("in/out.gltf").find("data:application/octet-stream;base64,"), std::string::npos);
}

TEST_F(ModelOutputFiles, NothingIsReplacedIfItMustNot) {
    WriteOptions careful;
    careful.no_clobber = true;
    ASSERT_TRUE(change("in/m.gltf", "out/m.gltf", "", "new", Container::png, careful));
    std::filesystem::remove(path("out/m.gltf"));
    ASSERT_TRUE(change("in/m.gltf", "out/m.gltf", "", "new", Container::png, careful)) << "the same bytes beside it";
    std::filesystem::remove(path("out/m.gltf"));
    const auto refused = change("in/m.gltf", "out/m.gltf", "", "other", Container::png, careful);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().file, path("out/maps/n a.png"));
    EXPECT_EQ(read("out/maps/n a.png"), "new");
    EXPECT_FALSE(has("out/m.gltf"));
}

TEST_F(ModelOutputFiles, WhatCannotBeIsSaid) {
    refuses("in/m.gltf", "out/m.png", "a model must be called .glb or .gltf");
    write_glb(kOneMaterial);
    std::string text = read("in/m.gltf");
    text.replace(text.find("color.png"), 9, "color.sh?");
    text.replace(text.find("color.sh?"), 9, "crontab.d");
    write("in/m.gltf", text);
    write("in/maps/crontab.d", std::string("x"));
    refuses("in/m.gltf", "out/m.gltf", "models use no such files");
    write_glb(R"([{"normalTexture":{"index":7}}])");
    refuses("m.glb", "out.glb", "has no image");
    const auto model = read_model_maps(path("m.glb"));
    ASSERT_TRUE(model);
    EXPECT_EQ(write_model(path("m.glb"), path("o.glb"), {{{{}, Container::png, bytes_of("x")}}}).error().code,
              ErrorCode::bad_option);
    ModelMap other = model->maps[0];
    other.material = 3;
    EXPECT_EQ(write_model(path("m.glb"), path("o.glb"), {{{{other}, Container::png, bytes_of("x")}}}).error().code,
              ErrorCode::bad_option);
    write_glb(kOneMaterial);
    const ModelMap map = read_model_maps(path("m.glb"))->maps[0];
    for (const std::vector<ModelPicture>& pictures :
         {std::vector<ModelPicture>{{{map}, Container::dds, bytes_of("x")}},
          {{{map}, Container::png, {}}},
          {{{map}, Container::png, bytes_of("x")}, {{map}, Container::png, bytes_of("y")}}})
        EXPECT_EQ(write_model(path("m.glb"), path("o.glb"), {pictures}).error().code, ErrorCode::bad_option);
    EXPECT_FALSE(has("o.glb"));
    EXPECT_EQ(write_model(path("m.glb"), path("none/o.glb"), {{{{map}, Container::png, bytes_of("x")}}}).error().code,
              ErrorCode::io);
    EXPECT_EQ(change("in/m.gltf", "none/m.gltf", "", "new").error().code, ErrorCode::unsupported);
    std::filesystem::remove(path("in/maps/crontab.d"));
    EXPECT_EQ(change("in/m.gltf", "none/m.gltf", "", "new").error().code, ErrorCode::io);
    EXPECT_FALSE(has("none"));
}

TEST_F(ModelOutputFiles, FilesAreKnownBeforehand) {
    const auto model = read_model_maps(path("in/m.gltf"));
    ASSERT_TRUE(model);
    const auto files = model_files(path("in/m.gltf"), path("out/m.gltf"), {{{model->maps, Container::png, {}}}});
    ASSERT_TRUE(files) << files.error().message();
    std::vector<std::string> names;
    for (const ModelFile& file : files->files) names.push_back(file.path + (file.is_changed ? " changed" : ""));
    EXPECT_EQ(names,
              (std::vector<std::string>{path("out/m.bin"), path("out/maps/color.png"),
                                        path("out/maps/n a.png") + " changed", path("out/m.gltf") + " changed"}));
    EXPECT_TRUE(std::filesystem::is_empty(path("out")));
}

}  // namespace
}  // namespace tex
