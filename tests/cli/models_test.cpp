// SPDX-License-Identifier: Apache-2.0
// pack-normals, convert-normals and preview-normals with glTF models among their inputs. What they make of a map in a
// model is what they make of the same map in a file.

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {
namespace {

const std::filesystem::path kHelmet = TEX_SOURCE_DIR "/../shared/data/mesh/FlightHelmet";

}  // namespace

class ModelInputs : public testing::Test {
protected:
    ModelInputs() { EXPECT_EQ(shell(scratch_, "cp " TEX_SOURCE_DIR "/samples/broken/N80*.glb .").code, 0); }

    Ran go(const std::string& script) { return shell(scratch_, script); }
    void does(const std::string& script) {
        const Ran ran = go(script);
        EXPECT_EQ(ran.code, 0) << script << ": " << ran.err;
    }
    // A command that is refused, and a part of what it says.
    void refuses(const std::string& script, int code, const std::string& said) {
        const Ran ran = go(script);
        EXPECT_EQ(ran.code, code) << script << ": " << ran.err;
        EXPECT_NE(ran.err.find(said), std::string::npos) << script << ": " << ran.err;
    }
    void same(const std::string& a, const std::string& b) {
        EXPECT_FALSE(scratch_.read(a).empty()) << a;
        EXPECT_TRUE(scratch_.read(a) == scratch_.read(b)) << a << " and " << b << " differ";
    }
    // Writes the bytes of the only image of a model into a file.
    void extract(const std::string& model, const std::string& file) {
        const auto read = read_model(scratch_.path(model));
        ASSERT_TRUE(read) << read.error().message();
        const auto& bytes = read->images.at(0).bytes;
        std::ofstream out(scratch_.path(file), std::ios::binary);
        out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    // FlightHelmet with its files, whose materials have the given addition to their normal textures.
    void copy_helmet(const std::string& addition = {}) {
        does("cp " + kHelmet.string() + "/* .");
        std::string text = scratch_.read("FlightHelmet.gltf");
        auto model = nlohmann::json::parse(text);
        for (auto& material : model["materials"]) {
            if (!addition.empty()) material["normalTexture"].update(nlohmann::json::parse(addition));
        }
        scratch_.write("FlightHelmet.gltf", model.dump());
    }
    Scratch scratch_;
};

TEST_F(ModelInputs, PackMakesOfImagesInsideWhatItMakesOfTheirFiles) {
    extract("N804-scale-not-positive.glb", "inside.png");
    for (const std::string options : {"--format bc5 --mips all", "--for unreal", "--format rgb16 --y down"}) {
        const std::string name = options == "--format bc5 --mips all" ? "dds" : "png";
        does("pack-normals N804-scale-not-positive.glb -o model." + name + " " + options);
        does("pack-normals inside.png -o file." + name + " " + options);
        same("model." + name, "file." + name);
    }
}

TEST_F(ModelInputs, OneOutputForEachMap) {
    does("pack-normals N802*.glb N804*.glb --out-dir out");
    EXPECT_TRUE(scratch_.has("out/N802-used-as-color_stone.dds"));
    EXPECT_TRUE(scratch_.has("out/N804-scale-not-positive_stone.dds"));
    does("pack-normals N802*.glb --out-dir named --for gltf,unreal --name '{material}/{stem}_{engine}.{type}'");
    EXPECT_TRUE(scratch_.has("named/stone/N802-used-as-color_unreal.png"));
    does("convert-normals N802*.glb --out-dir out --to object");
    EXPECT_TRUE(scratch_.has("out/N802-used-as-color_stone.png"));
    does("preview-normals N802*.glb --out-dir out --name '{stem}.preview{ext}' --size 64");
    EXPECT_TRUE(scratch_.has("out/N802-used-as-color.preview.png"));
}

TEST_F(ModelInputs, ConversionsAreThoseOfTheMapOnItsMesh) {
    extract("N805-double-sided-tangents.glb", "inside.png");
    does("convert-normals N805*.glb -o model.exr --decoder three --format float");
    does("convert-normals inside.png -o file.exr --mesh N805*.glb --decoder-in gltf --decoder three --format float");
    same("model.exr", "file.exr");
    does("convert-normals N805*.glb -o model.exr --to object --format float");
    does("convert-normals inside.png -o file.exr --mesh N805*.glb --to object --format float");
    same("model.exr", "file.exr");
    does("convert-normals N805*.glb -o model.exr --to-mesh N802*.glb --format float");
    does("convert-normals inside.png -o file.exr --mesh N805*.glb --to-mesh N802*.glb --format float");
    same("model.exr", "file.exr");
}

TEST_F(ModelInputs, ScaleIsAPartOfWhatIsConverted) {
    extract("N804-scale-not-positive.glb", "inside.png");
    does("scale-normals inside.png -o scaled.exr --scale -1 --format float");
    const Ran ran = go("convert-normals N804*.glb -o model.exr --decoder three --format float");
    EXPECT_EQ(ran.code, 0);
    EXPECT_NE(ran.err.find("N804-scale-not-positive.glb: stone: the scale -1 of its material is in the output: set it "
                           "to 1 there\n"),
              std::string::npos)
        << ran.err;
    does("convert-normals scaled.exr -o file.exr --mesh N804*.glb --decoder-in gltf --decoder three --format float");
    does("compare-normals model.exr file.exr --max 0.001");
    does("preview-normals N804*.glb -o model.png");
    does("preview-normals inside.png -o file.png --mesh N804*.glb --bump-scale -1");
    same("model.png", "file.png");
}

TEST_F(ModelInputs, SheetsHaveARowForEachMaterial) {
    if (!std::filesystem::exists(kHelmet)) GTEST_SKIP() << "no ../shared/data";
    copy_helmet();
    const Ran ran = go("preview-normals FlightHelmet.gltf -o look.png --size 48 --show lit,seams --json");
    EXPECT_EQ(ran.code, 0) << ran.err;
    const auto report = nlohmann::json::parse(ran.out);
    ASSERT_EQ(report["maps"].size(), 6u);
    EXPECT_EQ(report["maps"][0], "FlightHelmet.gltf: HoseMat");
    const auto picture = read_texture(scratch_.path("look.png"));
    ASSERT_TRUE(picture);
    EXPECT_GT(picture->extent().height, 6 * 48);
    does("preview-normals FlightHelmet.gltf -o one.png --material HoseMat --size 48");
    does(
        "preview-normals FlightHelmet_Materials_RubberWoodMat_Normal.png -o map.png --mesh FlightHelmet.gltf "
        "--material HoseMat --size 48");
    same("one.png", "map.png");
    does("preview-normals FlightHelmet_Materials_RubberWoodMat_Normal.png FlightHelmet.gltf -o both.png --size 32");
}

TEST_F(ModelInputs, RealMapsInFilesWithTransformsAndScales) {
    if (!std::filesystem::exists(kHelmet)) GTEST_SKIP() << "no ../shared/data";
    copy_helmet(R"({"scale":0.5,"extensions":{"KHR_texture_transform":{"scale":[0.5,0.5],"offset":[0.25,0]}}})");
    does("convert-normals FlightHelmet.gltf --out-dir out --decoder godot --format float --name '{material}.exr'");
    for (const std::string material : {"Hose", "RubberWood", "GlassPlastic", "MetalParts", "LeatherParts", "Lenses"})
        EXPECT_TRUE(scratch_.has("out/" + material + "Mat.exr")) << material;
    const std::string map = "FlightHelmet_Materials_LeatherPartsMat_Normal.png";
    does("scale-normals " + map + " -o scaled.exr --scale 0.5 --format float");
    does(
        "convert-normals scaled.exr -o file.exr --mesh FlightHelmet.gltf --material LeatherPartsMat --decoder-in gltf "
        "--decoder godot --format float");
    does("compare-normals out/LeatherPartsMat.exr file.exr --max 0.001");
}

TEST_F(ModelInputs, NamesThatFilesCannotHaveAndThatAreNotUnique) {
    does("bake-normals " TEX_SOURCE_DIR "/samples/waves.png -o n.png");
    scratch_.write("m.gltf", R"({"asset":{"version":"2.0"},"images":[{"uri":"n.png"}],"textures":[{"source":0}],
        "materials":[{"name":"a/b","normalTexture":{"index":0}},{"name":"a:b","normalTexture":{"index":0}},
        {"name":".","normalTexture":{"index":0}},{"normalTexture":{"index":0},
        "extensions":{"KHR_materials_clearcoat":{"clearcoatNormalTexture":{"index":0}}}}]})");
    does("pack-normals m.gltf --out-dir out");
    for (const std::string name : {"a_b_0", "a_b_1", "_", "3", "3_clearcoat"})
        EXPECT_TRUE(scratch_.has("out/m_" + name + ".dds")) << name;
    does("pack-normals m.gltf --material 1 -o one.dds");
    does("pack-normals m.gltf --material a/b -o two.dds");
    refuses("pack-normals m.gltf --material glass -o x.dds", 4, "has no material \"glass\"");
    refuses("pack-normals m.gltf --out-dir out --name '{stem}.dds'", 2, "{material} in --name separates them");
    refuses("convert-normals m.gltf --out-dir out --to object", 4, "m.gltf");  // it has no mesh
}

TEST_F(ModelInputs, WhatCannotBeIsSaid) {
    refuses("pack-normals N802*.glb N804*.glb -o x.dds", 2, "-o takes one input, 2 are given");
    refuses("pack-normals N802*.glb --out-dir out --name '{material'", 2, "without its }");
    does("bake-normals " TEX_SOURCE_DIR "/samples/waves.png -o n.png");
    refuses("pack-normals n.png --out-dir out --name '{material}.dds'", 2, "{material} needs inputs that are models");
    refuses("pack-normals n.png -o x.dds --material stone", 2, "--material needs a model");
    refuses("convert-normals N802*.glb -o x.png", 2, "nothing changes");
    refuses("convert-normals N802*.glb -o x.png --mesh N804*.glb --to object", 2, "is a model with meshes of its own");
    refuses("convert-normals N802*.glb n.png --out-dir out --to object", 2, "no mesh: give --mesh FILE");
    refuses("convert-normals N802*.glb -o x.png --to object --node a", 2, "--node needs --mesh");
    refuses("preview-normals N802*.glb -o x.png --shape sphere", 2, "--shape is not for models");
    refuses("preview-normals N802*.glb n.png -o x.png --show tangents", 2, "--show tangents needs --mesh, or a model");
    refuses("preview-normals n.png -o x.png --decoder three", 2, "--decoder needs --mesh, or a model");
    scratch_.write("words.gltf", "These are words.\n");
    refuses("pack-normals words.gltf --out-dir out", 4, "words.gltf: is not a glTF model");
    refuses("convert-normals words.gltf --out-dir out --to object", 4, "words.gltf: is not a glTF model");
    scratch_.write("bad.glb", "glTF\2\0\0\0");
    scratch_.write("empty.gltf", R"({"asset":{"version":"2.0"}})");
    refuses("pack-normals bad.glb -o x.dds", 4, "bad.glb");
    refuses("pack-normals empty.gltf -o x.dds", 4, "no material uses a normal map");
    EXPECT_FALSE(scratch_.has("x.dds"));
    const Ran some = go("pack-normals empty.gltf N802*.glb --out-dir some");
    EXPECT_EQ(some.code, 0) << some.err;
    EXPECT_NE(some.err.find("warning: empty.gltf: no material uses a normal map\n"), std::string::npos) << some.err;
    refuses("preview-normals bad.glb N802*.glb -o x.png", 4, "bad.glb");
    EXPECT_TRUE(scratch_.has("x.png"));  // a sheet with an empty cell
    refuses("pack-normals N802*.glb -o N802-used-as-color.glb", 2, "is the input");
}

// A map of the material "m_0" and one of the first material "m" must not meet.
TEST_F(ModelInputs, NamesThatMaterialsHaveAreLeftToThem) {
    does("bake-normals " TEX_SOURCE_DIR "/samples/waves.png -o n.png");
    scratch_.write("m.gltf", R"({"asset":{"version":"2.0"},"images":[{"uri":"n.png"}],"textures":[{"source":0}],
        "materials":[{"name":"m","normalTexture":{"index":0}},{"name":"m","normalTexture":{"index":0}},
        {"name":"m_0","normalTexture":{"index":0}},{"name":"m_1_1","normalTexture":{"index":0}}]})");
    does("pack-normals m.gltf --out-dir out");
    for (const std::string name : {"m_0_0", "m_1", "m_0", "m_1_1"})
        EXPECT_TRUE(scratch_.has("out/m_" + name + ".dds")) << name;
}

// What is known of a model is found once, not for each of its maps: that took minutes.
TEST_F(ModelInputs, ModelsMayHaveManyThousandMaterials) {
    std::string materials;
    for (int k = 0; k < 10000; ++k) {
        materials += (k == 0 ? "" : ",") + std::string(R"({"name":"m)") + std::to_string(k / 2) +
                     R"(","normalTexture":{"index":0}})";
    }
    scratch_.write("m.gltf", R"({"asset":{"version":"2.0"},"images":[{"uri":"n.png"}],"textures":[{"source":0}],)"
                             R"("materials":[)" +
                                 materials + "]}");
    refuses("pack-normals m.gltf --out-dir out --name '{stem}.dds'", 2, "{material} in --name separates them");
}

// Maps of materials with the same name are compared.
TEST_F(ModelInputs, TwoModelsAreComparedByTheirMaterials) {
    does("bake-normals " TEX_SOURCE_DIR "/samples/waves.png -o n.png --bumpiness 4");
    does("scale-normals n.png -o half.png --scale 0.5");
    const auto model = [&](const char* file, const std::string& first, const std::string& second) {
        const auto material = [](const std::string& name, int texture) {
            return R"({"name":")" + name + R"(","normalTexture":{"index":)" + std::to_string(texture) + "}}";
        };
        scratch_.write(file, R"({"asset":{"version":"2.0"},"images":[{"uri":"n.png"},{"uri":"half.png"}],)"
                             R"("textures":[{"source":0},{"source":1}],"materials":[)" +
                                 material(first, 0) + "," + material(second, 1) + "]}");
    };
    model("a.gltf", "wood", "stone");
    model("b.gltf", "stone", "wood");
    model("c.gltf", "stone", "iron");
    const Ran both = go("compare-normals a.gltf b.gltf --json");
    const std::vector<std::string> lines = lines_of(both.out);
    ASSERT_EQ(lines.size(), 2u) << both.out << both.err;
    const auto expected = nlohmann::json::parse(go("compare-normals n.png half.png --json").out);
    for (std::size_t k = 0; k < 2; ++k) {
        const auto line = nlohmann::json::parse(lines[k]);
        EXPECT_EQ(line["material"], k == 0 ? "wood" : "stone");
        EXPECT_EQ(line["degrees"], expected["degrees"]) << line;
    }
    EXPECT_NE(go("compare-normals a.gltf b.gltf").out.find("wood:\nlevel "), std::string::npos);
    const Ran some = go("compare-normals a.gltf c.gltf");
    EXPECT_EQ(some.out.find("stone:\nlevel "), 0u) << some.out;
    for (const char* sentence : {"a.gltf: wood: is not compared: c.gltf has no map of that material",
                                 "c.gltf: iron: is not compared: a.gltf has no map of that material"})
        EXPECT_NE(some.err.find(sentence), std::string::npos) << some.err;
    EXPECT_EQ(nlohmann::json::parse(go("compare-normals n.png a.gltf --material wood --json").out)["degrees"]["max"],
              0);
    does("compare-normals a.gltf b.gltf --material wood --heatmap angles.png");
    refuses("compare-normals a.gltf n.png", 4,
            "has 2 normal maps, and n.png is one: give --material, which is one of "
            "wood, stone");
    refuses("compare-normals a.gltf b.gltf --heatmap x.png", 4, "--heatmap shows two: give --material");
    refuses("compare-normals a.gltf c.gltf --material wood", 4, "c.gltf: has no material \"wood\"");
    refuses("compare-normals a.gltf b.gltf --heatmap half.png", 2, "half.png");
    refuses("compare-normals a.gltf b.gltf --mesh a.gltf", 4, "--mesh is for maps without their mesh");
    // The command that an error advises.
    does("pack-normals n.png -o small.png --max-size 64 --format rgb8");
    const std::string advised = "pack-normals a.gltf --material wood --max-size 64 -o SMALL.png";
    refuses("compare-normals a.gltf small.png --material wood", 4, "; " + advised + " makes a map of that extent");
    does(advised + "; compare-normals SMALL.png small.png --max 0.001");
    model("odd.gltf", R"(st/one\u001b[31m)", "wood");
    EXPECT_EQ(go("compare-normals odd.gltf odd.gltf").out.find("st/one\\x1b[31m:\nlevel "), 0u);
    refuses("compare-normals odd.gltf n.png", 4, "give --material, which is one of st/one\\x1b[31m, wood");
    const Ran over = shell(scratch_, "compare-normals a.gltf b.gltf --max 0.1");
    EXPECT_EQ(over.code, 1);
    EXPECT_NE(over.err.find("a.gltf: wood: level 0: max "), std::string::npos) << over.err;
}

// Commands that take pictures alone say which take models.
TEST_F(ModelInputs, OtherCommandsNameThoseThatTakeModels) {
    const std::string reason =
        "a glTF model, or other JSON, not a picture: check-normals, compare-normals, convert-normals, pack-normals "
        "and preview-normals read the normal maps of a model if its file is given\n";
    does("bake-normals " TEX_SOURCE_DIR "/samples/waves.png -o n.png");
    scratch_.write("text.gltf", " \n{\"asset\":{\"version\":\"2.0\"}}");
    does("cp N802*.glb model.glb");
    for (const std::string model : {"model.glb", "text.gltf"}) {
        refuses("mip-normals " + model + " -o x.dds", 4, model + ": " + reason);
        refuses("scale-normals " + model + " -o x.dds --scale 2", 4, model + ": " + reason);
        refuses("unpack-normals " + model + " -o x.png", 4, model + ": " + reason);
        refuses("bake-normals " + model + " -o x.png", 4, model + ": " + reason);
        refuses("blend-normals " + model + " n.png -o x.png", 4, model + ": " + reason);
        refuses("blend-normals n.png " + model + " -o x.png", 4, model + ": " + reason);
        refuses("integrate-normals " + model + " -o x.png", 4, model + ": " + reason);
        refuses("compare-normals " + model + " --rdo-means 0", 4, model + ": " + reason);
        refuses("pack-normals - -o x.png < " + model, 4, "-: " + reason);
        scratch_.write("normals.toml", "version = 1\n[[rule]]\nmatch = \"" + model + "\"\nsteps = [{ mip = {} }]\n");
        refuses("build-normals", 4, model + ": " + reason);
    }
    EXPECT_FALSE(scratch_.has("x.png"));
}

// What the rules of models advise ends their findings.
TEST_F(ModelInputs, AdviceOfRulesIsRight) {
    using Json = nlohmann::json;
    does("cp " TEX_SOURCE_DIR "/samples/bricks.png other.png");
    // Changes the JSON of a sample, and returns the rules that are then found.
    const auto rules_after = [&](const std::string& sample, const auto& change) {
        std::string bytes = scratch_.read(sample);
        const auto word_at = [&](std::size_t at) {
            std::uint32_t word = 0;
            std::memcpy(&word, bytes.data() + at, sizeof word);
            return word;
        };
        const std::size_t length = word_at(12);
        Json document = Json::parse(bytes.substr(20, length));
        change(document);
        std::string text = document.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        bytes.replace(20, length, text);
        const auto put = [&](std::size_t at, std::size_t value) {
            const auto word = static_cast<std::uint32_t>(value);
            std::memcpy(bytes.data() + at, &word, sizeof word);
        };
        put(8, bytes.size());
        put(12, text.size());
        scratch_.write("mended.glb", bytes);
        std::string rules;
        const Ran ran = go("check-normals mended.glb --json");
        const auto findings = Json::parse(ran.out)["findings"];
        for (const Json& finding : findings) rules += finding["id"].get<std::string>() + " ";
        return rules;
    };
    const auto use_another_image = [](Json& document, const std::string& slot) {
        document["images"].push_back({{"uri", "other.png"}});
        document["textures"].push_back({{"source", document["images"].size() - 1}});
        Json& material = document["materials"][0];
        Json& texture = slot == "baseColorTexture" ? material["pbrMetallicRoughness"][slot] : material[slot];
        texture["index"] = document["textures"].size() - 1;
    };
    does("pack-normals N801*.glb -o three.png --for gltf");
    EXPECT_EQ(rules_after("N801-two-channel-in-model.glb",
                          [](Json& document) {
                              document["images"] = {{{"uri", "three.png"}}};
                              document["textures"] = {{{"source", 0}}};
                          })
                  .find("N801"),
              std::string::npos);
    const auto other_color = [&](Json& document) { use_another_image(document, "baseColorTexture"); };
    EXPECT_EQ(rules_after("N802-used-as-color.glb", other_color), "");
    const auto first_set = [](Json& document) { document["materials"][0]["normalTexture"]["texCoord"] = 0; };
    EXPECT_EQ(rules_after("N803-uv-set-missing.glb", first_set), "");
    const auto scale_of_1 = [](Json& document) { document["materials"][0]["normalTexture"]["scale"] = 1; };
    EXPECT_EQ(rules_after("N804-scale-not-positive.glb", scale_of_1), "");
    const auto one_sided = [](Json& document) { document["materials"][0]["doubleSided"] = false; };
    EXPECT_EQ(rules_after("N805-double-sided-tangents.glb", one_sided).find("N805"), std::string::npos);
    const auto other_data = [&](Json& document) { use_another_image(document, "occlusionTexture"); };
    EXPECT_EQ(rules_after("N806-data-in-normal-slot.glb", other_data), "");
    // Any normals will do.
    const auto with_normals = [](Json& document) {
        auto& attributes = document["meshes"][0]["primitives"][0]["attributes"];
        attributes["NORMAL"] = attributes["POSITION"];
    };
    EXPECT_EQ(rules_after("N807-mesh-not-examined.glb", with_normals).find("N807"), std::string::npos);
}

TEST_F(ModelInputs, DepfilesAndUpdatesKnowTheFilesOfAModel) {
    does("bake-normals " TEX_SOURCE_DIR "/samples/waves.png -o n.png");
    scratch_.write("m.gltf", R"({"asset":{"version":"2.0"},"images":[{"uri":"n.png"}],"textures":[{"source":0}],
        "materials":[{"name":"a","normalTexture":{"index":0}}]})");
    does("pack-normals m.gltf --out-dir out --depfile d");
    EXPECT_EQ(scratch_.read("d"), "out/m_a.dds: \\\n  m.gltf \\\n  n.png\n");
    const auto status = [&] {
        return nlohmann::json::parse(go("pack-normals m.gltf --out-dir out --update --json").out)["status"];
    };
    EXPECT_EQ(status(), "current");
    does("sleep 0.02; touch n.png");
    EXPECT_EQ(status(), "made");
}

TEST_F(ModelInputs, ReportsNameTheMap) {
    const Ran ran = go("pack-normals N804*.glb -o x.dds --json");
    EXPECT_EQ(ran.code, 0) << ran.err;
    const auto line = nlohmann::json::parse(ran.out);
    EXPECT_EQ(line["input"], "N804-scale-not-positive.glb");
    EXPECT_EQ(line["material"], "stone");
    EXPECT_EQ(line["slot"], "normal");
    EXPECT_EQ(line["image"], "normals");
    EXPECT_EQ(line["scale"], -1.0);
}

// The normals of a smooth cone, on the flat facets of the same cone, are no slopes of heights.
TEST_F(ModelInputs, SmoothNormalsOnFacetsAreNotTakenForExchangedChannels) {
    const std::string meshes = TEX_SOURCE_DIR "/../shared/data/mesh/mikktspace_obj/";
    if (!std::filesystem::exists(meshes)) GTEST_SKIP() << "no ../shared/data";
    does("transfer-normals " + meshes + "doomcone.obj " + meshes + "doomcone_smooth.obj --extent 256 -o n.png --quiet");
    EXPECT_EQ(go("check-normals n.png").out.find("N308"), std::string::npos);
}

}  // namespace tex::cli
