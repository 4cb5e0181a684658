// SPDX-License-Identifier: Apache-2.0
// pack-normals with glTF models as its outputs.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "unit/gltf_files.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;
using JsonValue = nlohmann::json;

const fs::path kMeshes = TEX_SOURCE_DIR "/../shared/data/mesh";
const fs::path kWild = TEX_SOURCE_DIR "/../shared/data/wild";

}  // namespace

class ModelOutputs : public testing::Test {
protected:
    // Two maps: one with green up, and one with green down.
    ModelOutputs() {
        does("cp " TEX_SOURCE_DIR "/samples/broken/N80*.glb .; cp " TEX_SOURCE_DIR
             "/samples/bricks.png .; "
             "bake-normals bricks.png -o up.png --bumpiness 12; pack-normals up.png -o down.png --y down; mkdir maps; "
             "convert up.png -strip maps/up.png; convert down.png -strip maps/down.png");
        write_model_of("m.gltf", {"maps/up.png", "maps/down.png"});
    }
    Ran go(const std::string& script) { return shell(scratch_, "set -e; " + script); }
    Ran does(const std::string& script) {
        Ran ran = go(script);
        EXPECT_EQ(ran.code, 0) << script << ": " << ran.err;
        return ran;
    }
    void refuses(const std::string& script, int code, const std::string& said) {
        const std::vector<std::string> before = scratch_.list();
        const Ran ran = go(script);
        EXPECT_EQ(ran.code, code) << script << ": " << ran.err;
        EXPECT_NE(ran.err.find(said), std::string::npos) << script << ": " << ran.err;
        EXPECT_EQ(scratch_.list(), before) << script;
    }
    // A square for each picture, with a material "m0", "m1" ... Tangents have this w; 0: there are none.
    void write_model_of(const std::string& name, const std::vector<std::string>& pictures, float w = 0.0f) {
        GltfMaker maker;
        maker.add(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 5126);
        maker.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
        maker.add(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 5126);
        maker.add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123);
        std::vector<float> tangents;
        for (int k = 0; k < 4; ++k) tangents.insert(tangents.end(), {1, 0, 0, w});
        maker.add(tangents, "VEC4", 5126);
        maker.uri = R"("uri":"maps/square.bin",)";
        scratch_.write("maps/square.bin", maker.binary);
        std::string primitives;
        for (std::size_t k = 0; k < pictures.size(); ++k) {
            primitives += std::string(k == 0 ? "" : ",") + R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2)" +
                          (w == 0.0f ? "" : R"(,"TANGENT":4)") + R"(},"indices":3,"material":)" + std::to_string(k) +
                          "}";
        }
        JsonValue model = JsonValue::parse(maker.json(primitives));
        for (const std::string& picture : pictures) {
            const std::size_t k = model["images"].size();
            model["images"].push_back({{"uri", picture}});
            model["textures"].push_back({{"source", k}});
            model["materials"].push_back({{"name", "m" + std::to_string(k)}, {"normalTexture", {{"index", k}}}});
        }
        scratch_.write(name, model.dump(2));
    }
    void same(const std::string& a, const std::string& b) {
        EXPECT_FALSE(scratch_.read(a).empty()) << a;
        EXPECT_TRUE(scratch_.read(a) == scratch_.read(b)) << a << " and " << b << " differ";
    }
    // Writes the bytes of an image inside a model to a file.
    void extract(const std::string& model, const std::string& file, std::size_t image = 0) {
        const auto read = read_model(scratch_.path(model));
        ASSERT_TRUE(read) << read.error().message();
        const auto& bytes = read->images.at(image).bytes;
        std::ofstream out(scratch_.path(file), std::ios::binary);
        out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    Scratch scratch_;
};

TEST_F(ModelOutputs, PicturesAreWhatTheCommandMakesOfTheirFiles) {
    extract("N804-scale-not-positive.glb", "inside.png");
    for (const std::string options : {"--y-in down --y up", "--normalize", "--max-size 32", "--format rgb16",
                                      "--format rgba8 --y-in up --y down"}) {
        does("pack-normals N804*.glb -o model.glb " + options);
        does("pack-normals inside.png -o file.png " + options);
        extract("model.glb", "model.png");
        same("model.png", "file.png");
    }
    does("pack-normals N804*.glb -o model.glb --container jpeg --quality 80 2>said");
    EXPECT_NE(scratch_.read("said").find("JPEG is lossy"), std::string::npos);
    does("pack-normals inside.png -o file.jpg --quality 80");
    extract("model.glb", "model.jpg");
    same("model.jpg", "file.jpg");
    EXPECT_EQ(does("pack-normals N804*.glb -o model.glb --container webp").err, "");
    does("pack-normals inside.png -o file.webp");
    extract("model.glb", "model.webp");
    same("model.webp", "file.webp");
    EXPECT_NE(scratch_.read("model.glb").find(R"("extensionsRequired":["EXT_texture_webp"])"), std::string::npos);
}

TEST_F(ModelOutputs, DirectionsThatAreMeasuredAreThoseOfEachMap) {
    does("pack-normals m.gltf -o fixed.gltf --y-in measured --y up");
    does("compare-normals up.png maps/fixed_up.png --max 0.001; compare-normals up.png maps/fixed_down.png --max 1");
    const std::string text = scratch_.read("fixed.gltf");
    EXPECT_NE(text.find("maps/fixed_down.png"), std::string::npos) << text;
    does("check-normals fixed.gltf --fail-on warning --disable N403");
}

TEST_F(ModelOutputs, OneMaterialAloneChanges) {
    does("pack-normals m.gltf -o fixed.gltf --material m1 --y-in down --y up");
    EXPECT_FALSE(scratch_.has("maps/fixed_up.png"));
    does("compare-normals up.png maps/fixed_down.png --max 1");
    const auto model = JsonValue::parse(scratch_.read("fixed.gltf"));
    EXPECT_EQ(model["images"][0]["uri"], "maps/up.png");
    EXPECT_EQ(model["images"][1]["uri"], "maps/fixed_down.png");
}

TEST_F(ModelOutputs, ManyModelsGoIntoAFolderWithTheirFiles) {
    write_model_of("n.gltf", {"maps/up.png"});
    does("pack-normals m.gltf n.gltf --out-dir out --name '{stem}.gltf' --y down --json > lines");
    for (const char* name : {"out/m.gltf", "out/n.gltf", "out/maps/up.png", "out/maps/down.png"})
        EXPECT_TRUE(scratch_.has(name)) << name;
    same("out/m.gltf", "m.gltf");
    const auto line = JsonValue::parse(lines_of(scratch_.read("lines")).at(0));
    EXPECT_EQ(line["output"], "out/m.gltf");
    ASSERT_EQ(line["maps"].size(), 2u);
    EXPECT_EQ(line["maps"][1]["material"], "m1");
    EXPECT_EQ(line["maps"][1]["format"], "rgb8");
    // One picture of both must not be two.
    write_model_of("n.gltf", {"maps/down.png"});
    refuses("pack-normals m.gltf n.gltf --out-dir other --name '{stem}.gltf' --material m0", 2, "have the same output");
    does("mkdir glb; pack-normals N802*.glb N804*.glb --out-dir glb --name '{stem}.glb' --y down");
    EXPECT_TRUE(scratch_.has("glb/N802-used-as-color.glb"));
}

TEST_F(ModelOutputs, OutputsThatReachInputsAreRefused) {
    refuses("pack-normals m.gltf -o m.gltf --y down", 2, "the output m.gltf is the input m.gltf");
    does("ln m.gltf hard.gltf; ln -s m.gltf soft.gltf; mkdir out; ln -s ../maps out/maps");
    refuses("pack-normals m.gltf -o hard.gltf --y down", 2, "is the input");
    refuses("pack-normals m.gltf -o soft.gltf --y down", 2, "is the input");
    refuses("pack-normals m.gltf -o out/m.gltf --y down", 2, "the output out/maps/");
    does("ln maps/up.png maps/fixed_up.png");
    refuses("pack-normals m.gltf -o fixed.gltf --y down", 2, "the output maps/fixed_up.png is the input");
    refuses("pack-normals m.gltf -o a.gltf --y down --depfile maps/a_up.png", 2, "--depfile");
}

// A model chooses the names of the files beside it: it must not replace what others keep there.
TEST_F(ModelOutputs, FilesOfOthersStay) {
    does("mkdir -p out/maps; cp bricks.png out/maps/down.png");
    refuses("pack-normals m.gltf -o out/m.gltf --y down", 3, "out/maps/down.png: exists and is not known to be a file");
    same("out/maps/down.png", "bricks.png");
    EXPECT_FALSE(scratch_.has("out/m.gltf"));
    // A copy that would not change is no loss: a run that was killed can be repeated.
    does("cp maps/square.bin out/maps; rm out/maps/down.png; pack-normals m.gltf -o out/m.gltf --y down");
    // What the last run wrote is replaced, with other settings, too.
    does("cp out/maps/down.png old.png; pack-normals m.gltf -o out/m.gltf --y down --max-size 16");
    EXPECT_NE(scratch_.read("old.png"), scratch_.read("out/maps/down.png"));
    // What that model does not name is not.
    write_model_of("n.gltf", {"maps/up.png", "maps/down.png"});
    refuses("pack-normals n.gltf -o out/n.gltf --y up", 3, "exists and is not known to be a file of out/n.gltf");
    does("rm out/maps/down.png; ln -s ../../bricks.png out/maps/down.png");
    refuses("pack-normals n.gltf -o out/n.gltf --y up", 3, "exists and is not known to be a file of out/n.gltf");
    does("rm out/maps/down.png; ln -s nowhere out/maps/down.png");
    refuses("pack-normals n.gltf -o out/n.gltf --y up", 3, "exists and is not known to be a file of out/n.gltf");
}

// glTF's viewers read UASTC in models (KHR_texture_basisu); it saves no bytes of the file of itself.
TEST_F(ModelOutputs, UastcIsReadByViewersAndItsGrowthIsSaid) {
    const Ran grown = does("pack-normals N804*.glb -o big.glb --format uastc --supercompress none");
    EXPECT_NE(grown.err.find("big.glb: it has "), std::string::npos) << grown.err;
    EXPECT_NE(grown.err.find("UASTC saves memory of the GPU"), std::string::npos) << grown.err;
    EXPECT_EQ(does("pack-normals N804*.glb -o png.glb --y up").err.find("it has "), std::string::npos);
    for (const char* engine : {"three", "babylon", "playcanvas", "cesium", "gltf-ktx2"}) {
        const Ran ran = go(std::string("check-normals big.glb --disable N804 --for ") + engine + " --json");
        EXPECT_EQ(ran.out.find("N113"), std::string::npos) << ran.out;
    }
}

// Levels of PNG in models are the engines' matter; KTX2 holds them. The command that writes it is named, and runs.
TEST_F(ModelOutputs, MipNormalsNamesTheCommandThatWritesModelsWithLevels) {
    const std::string packing = "pack-normals m.gltf -o x.glb --format uastc";
    refuses("mip-normals m.gltf -o x.glb", 2, packing);
    refuses("mip-normals m.gltf --out-dir o --name {stem}.glb", 2,
            "pack-normals m.gltf --out-dir o --name '{stem}.glb'");
    does(packing);
    does("mip-normals maps/up.png -o up.ktx2 --format uastc");
    const auto model = read_model(scratch_.path("x.glb"));
    ASSERT_TRUE(model) << model.error().message();
    const auto made = read_map(*model, model->maps.at(0)), levels = read_texture(scratch_.path("up.ktx2"));
    ASSERT_TRUE(made && levels);
    ASSERT_EQ(levels->levels.size(), 10u);
    ASSERT_EQ(made->levels.size(), 10u);
    for (std::size_t k = 0; k < 10; ++k) EXPECT_TRUE(made->levels[k].bytes == levels->levels[k].bytes) << k;
}

// Text with its files becomes one file, and one file becomes text, with all commands that write models.
TEST_F(ModelOutputs, TheNameDecidesTheForm) {
    does(
        "pack-normals m.gltf -o one.glb --y up; mkdir alone out busy alone/text; cp one.glb alone; cd alone; "
        "pack-normals one.glb -o text/n.gltf; test -e text/n.bin; test $(ls text | wc -l) = 2");
    for (const std::string verb :
         {"pack-normals one.glb -o out/a.gltf", "convert-normals one.glb -o out/c.gltf --tangents mikktspace",
          "repair-normals N802*.glb -o out/d.gltf", "convert-normals m.gltf -o out/e.glb --tangents mikktspace",
          "transfer-normals one.glb m.gltf -o out/g.gltf --extent 16",
          "transfer-normals m.gltf one.glb -o out/h.glb --extent 16"}) {
        does(verb);
        const std::string made = verb.substr(verb.find("out/"), verb.find("gl", verb.find("out/")) - verb.find("out/"));
        does("check-normals " + made + "gl* --json > /dev/null || test $? = 1");
    }
    // What goes into the file is an input, too.
    does("ln maps/up.png hard.glb");
    refuses("pack-normals m.gltf -o hard.glb", 2, "is the input");
    refuses("pack-normals m.gltf -o x.glb --depfile maps/square.bin", 2, "maps/square.bin");
    // What is beside the output may be anybody's.
    scratch_.write("busy/n.bin", std::string("somebody's"));
    refuses("pack-normals one.glb -o busy/n.gltf", 3, "exists and is not known to be a file of busy/n.gltf");
}

TEST_F(ModelOutputs, WhatCannotBeIsSaid) {
    refuses("pack-normals up.png -o x.glb", 4, "up.png: is not a glTF model");
    refuses("pack-normals none.glb -o x.glb", 3, "none.glb: no such file");
    refuses("pack-normals N802*.glb N804*.glb -o x.glb", 2, "-o takes one input, 2 are given");
    refuses("pack-normals N804*.glb -o x.glb --format bc5", 2,
            "models hold normals as rgb8, rgba8, rgb16, rgba16, uastc, not");
    refuses("pack-normals N804*.glb -o x.glb --container dds", 2,
            "the pictures of a model are PNG, JPEG, WebP or KTX2, not dds");
    refuses("pack-normals N804*.glb -o x.glb --container jpeg --format rgb16", 2, "jpeg files cannot hold rgb16");
    refuses("pack-normals N804*.glb -o x.glb --mips all", 2, "--mips: models hold no levels: engines build them");
    refuses("pack-normals N804*.glb -o x.glb --alpha 0.5", 2, "--alpha is for one map, and not for models");
    refuses("pack-normals N804*.glb -o x.glb --quality 80", 2, "--quality: needs a JPEG file");
    refuses("pack-normals N804*.glb -o x.glb --material glass", 4, "has no material \"glass\"");
    refuses("pack-normals N804*.glb -o none/x.glb", 3, "none");
    scratch_.write("bad.glb", std::string("glTF\2\0\0\0", 8));
    scratch_.write("empty.gltf", std::string(R"({"asset":{"version":"2.0"}})"));
    refuses("pack-normals bad.glb -o x.glb", 4, "bad.glb: truncated");
    refuses("pack-normals empty.gltf -o x.gltf", 4, "empty.gltf: no material uses a normal map");
    write_model_of("gone.gltf", {"gone.png"});
    refuses("pack-normals gone.gltf -o x.gltf", 3, "gone.png");
    scratch_.write("words.png", std::string("These are words."));
    write_model_of("words.gltf", {"words.png"});
    refuses("pack-normals words.gltf -o x.gltf", 4, "words.png");
    const Ran some = go("pack-normals m.gltf empty.gltf --out-dir some --name '{stem}.gltf'");
    EXPECT_EQ(some.code, 4);
    EXPECT_TRUE(scratch_.has("some/m.gltf"));
    EXPECT_FALSE(scratch_.has("some/empty.gltf"));
    const Ran flat = go("pack-normals m.gltf -o down.gltf --y down");
    EXPECT_NE(flat.err.find("viewers of glTF expect up"), std::string::npos) << flat.err;
}

TEST_F(ModelOutputs, FilesBesideAreKnownToDepfilesAndUpdates) {
    does("pack-normals m.gltf --out-dir out --name '{stem}.gltf' --depfile d --y down");
    EXPECT_EQ(scratch_.read("d"),
              "out/m.gltf out/maps/square.bin out/maps/up.png out/maps/down.png: \\\n  m.gltf \\\n  maps/down.png \\\n"
              "  maps/square.bin \\\n  maps/up.png\n");
    const auto status = [&] {
        return JsonValue::parse(
            go("pack-normals m.gltf --out-dir out --name '{stem}.gltf' --update --json --y down").out)["status"];
    };
    EXPECT_EQ(status(), "current");
    does("sleep 0.02; touch maps/up.png");
    EXPECT_EQ(status(), "made");
    does("rm out/maps/up.png");
    EXPECT_EQ(status(), "made");
    EXPECT_TRUE(scratch_.has("out/maps/up.png"));
    refuses("pack-normals m.gltf -o out/m.gltf --no-clobber --y down", 3, "exists, and --no-clobber is given");
}

TEST_F(ModelOutputs, FilesThatAreMissingAreSaid) {
    auto model = JsonValue::parse(scratch_.read("m.gltf"));
    model["images"].push_back({{"uri", "color.png"}});
    scratch_.write("m.gltf", model.dump());
    const Ran ran = does("mkdir out; pack-normals m.gltf -o out/m.gltf --y down");
    EXPECT_NE(ran.err.find("it names color.png, which cannot be found, and so there is no copy"), std::string::npos)
        << ran.err;
    EXPECT_EQ(does("pack-normals m.gltf -o fixed.gltf --y up").err.find("color.png"), std::string::npos);
}

TEST_F(ModelOutputs, RepairsChangeDamagedMapsAlone) {
    does("convert maps/up.png -set colorspace RGB -colorspace sRGB -strip maps/light.png");
    write_model_of("m.gltf", {"maps/up.png", "maps/light.png"});
    refuses("repair-normals m.gltf --dry-run --only N403", 0, "");
    EXPECT_NE(go("repair-normals m.gltf --dry-run").out.find("m.gltf: m1: N302"), std::string::npos);
    does("mkdir out; repair-normals m.gltf -o out/m.gltf --json > lines");
    same("out/maps/up.png", "maps/up.png");
    same("out/maps/square.bin", "maps/square.bin");
    does("compare-normals up.png out/maps/light.png --max 1.5; check-normals out/m.gltf --disable N403");
    const auto line = JsonValue::parse(scratch_.read("lines"));
    EXPECT_EQ(line["maps"][0]["state"], "whole");
    EXPECT_EQ(line["maps"][1]["state"], "repaired");
    EXPECT_EQ(line["maps"][1]["material"], "m1");
    // In its own folder, only the picture that changes is a new one.
    does("repair-normals m.gltf -o mended.gltf");
    same("maps/mended_light.png", "out/maps/light.png");
    EXPECT_FALSE(scratch_.has("maps/mended_up.png"));
    does("repair-normals m.gltf --material m0 -o same.gltf");
    same("same.gltf", "m.gltf");
    // The maps as pictures.
    does("repair-normals m.gltf --out-dir pictures");
    same("pictures/m_m1.png", "out/maps/light.png");
    refuses("repair-normals m.gltf -o a.gltf --depfile d", 2, "--depfile is not for models that are written");
    // x is lost, and the whole model stays unwritten.
    does("convert maps/up.png -channel R -evaluate set 100% +channel maps/pink.png");
    write_model_of("m.gltf", {"maps/light.png", "maps/pink.png"});
    refuses("repair-normals m.gltf -o a.gltf", 1, "");
    does("repair-normals m.gltf --material m0 -o a.gltf");
    // Heights in place of normals.
    does("convert maps/up.png -channel R -separate maps/heights.png");
    write_model_of("h.gltf", {"maps/heights.png"});
    EXPECT_NE(go("check-normals h.gltf").out.find("repair-normals h.gltf --bumpiness B"), std::string::npos);
    does("repair-normals h.gltf --bumpiness 4 -o baked.gltf; check-normals baked.gltf");
}

TEST_F(ModelOutputs, OneRunMendsWhatTheFixesMendOneByOne) {
    does(
        "convert maps/up.png -set colorspace RGB -colorspace sRGB -strip maps/light.png; cp maps/light.png maps/b.png");
    write_model_of("two.gltf", {"maps/light.png", "maps/b.png", "maps/up.png"});
    const std::string two = go("check-normals two.gltf").out;
    const std::string command = "repair-normals two.gltf -o FIXED.gltf";
    EXPECT_NE(two.find("two.gltf: all of these in one run: " + command + "\n"), std::string::npos) << two;
    does(command + "; check-normals FIXED.gltf --disable N403");
    does("convert maps/up.png -channel G -negate +channel maps/down.png");
    write_model_of("kinds.gltf", {"maps/light.png", "maps/down.png"}, 1.0f);
    const std::string kinds = go("check-normals kinds.gltf").out;
    EXPECT_NE(kinds.find("kinds.gltf: each fix reads the model as it is: give it the FIXED of the one before\n"),
              std::string::npos)
        << kinds;
    write_model_of("one.gltf", {"maps/light.png"});
    EXPECT_EQ(go("check-normals one.gltf").out.find("in one run"), std::string::npos);
}

TEST_F(ModelOutputs, RepairsLeaveWhatTangentsMakeUpFor) {
    write_model_of("agree.gltf", {"maps/down.png"}, 1.0f);
    EXPECT_NE(does("repair-normals agree.gltf --dry-run --mirrored green").out.find("N401"), std::string::npos);
    // Nor do they guess which channel is the other way round.
    const Ran left = go("repair-normals agree.gltf -o c.gltf --likely");
    EXPECT_EQ(left.code, 0) << left.err;
    EXPECT_NE(left.out.find("left: warning N401"), std::string::npos) << "as check-normals says: " << left.out;
    EXPECT_NE(left.out.find("--mirrored red"), std::string::npos) << left.out << left.err;
    same("c.gltf", "agree.gltf");
    refuses("repair-normals agree.gltf -o d.gltf --y up", 1, "");
    write_model_of("cancel.gltf", {"maps/down.png"}, -1.0f);  // and the square of both
    does("repair-normals cancel.gltf -o b.gltf --likely > said");
    same("b.gltf", "cancel.gltf");
}

// What check-normals prints about a model mends it.
TEST_F(ModelOutputs, FixesOfCheckNormalsMendModels) {
    write_model_of("d.gltf", {"maps/down.png", "maps/up.png"});
    does("convert maps/up.png -channel RGB -evaluate multiply 0.8 +channel -evaluate add 10% maps/short.png");
    write_model_of("s.gltf", {"maps/up.png", "maps/short.png"});
    does("convert maps/up.png -set colorspace RGB -colorspace sRGB -strip maps/light.png");
    write_model_of("l.gltf", {"maps/light.png", "maps/up.png"});
    extract("N801-two-channel-in-model.glb", "maps/two.dds");
    for (const std::string model : {"d.gltf", "s.gltf", "l.gltf", "N801-two-channel-in-model.glb"}) {
        const auto before = JsonValue::parse(go("check-normals --json " + model).out);
        int fixes = 0;
        for (const auto& finding : before["findings"]) {
            std::string fix = finding.value("fix", "");
            const std::size_t at = fix.rfind("FIXED.");
            if (at == std::string::npos) continue;
            ++fixes;
            does(fix);
            const std::string name = fix.substr(at);
            const auto after = JsonValue::parse(go("check-normals --json " + name).out);
            for (const auto& left : after["findings"]) {
                EXPECT_FALSE(left["id"] == finding["id"] && left["map"].get<std::string>().substr(0, 2) ==
                                                                finding["map"].get<std::string>().substr(0, 2))
                    << fix << ": " << left;
            }
        }
        EXPECT_GT(fixes, 0) << before;
    }
    const Ran said = go("check-normals d.gltf");
    EXPECT_NE(said.out.find("fix: pack-normals d.gltf --material m0 --keep-length --y-in down --y up -o FIXED.gltf\n"),
              std::string::npos)
        << said.out;
}

TEST_F(ModelOutputs, RealModelsKeepTheirGeometry) {
    if (!fs::exists(kMeshes)) GTEST_SKIP() << "no ../shared/data";
    const std::vector<fs::path> models = {kMeshes / "FlightHelmet/FlightHelmet.gltf",
                                          kMeshes / "Suzanne/02_suzanne.gltf", kMeshes / "NormalTangentTest.glb",
                                          kMeshes / "AssetGenerator_plane/Mesh_PrimitiveAttribute_06.gltf"};
    for (const fs::path& model : models) {
        const std::string folder = model.stem();
        does("mkdir " + folder);
        const std::string output = folder + "/" + model.filename().string();
        does("pack-normals " + model.string() + " -o " + output + " --max-size 128 --quiet");
        const auto before = read_model(model), after = read_model(scratch_.path(output));
        ASSERT_TRUE(before && after) << output;
        ASSERT_EQ(after->maps.size(), before->maps.size());
        ASSERT_EQ(after->mesh.parts.size(), before->mesh.parts.size());
        for (std::size_t k = 0; k < before->mesh.parts.size(); ++k)
            EXPECT_EQ(after->mesh.parts[k].indices, before->mesh.parts[k].indices);
        for (const ModelMap& map : after->maps) {
            const auto texture = read_map(*after, map);
            ASSERT_TRUE(texture) << texture.error().message();
            EXPECT_LE(texture->extent().width, 128);
        }
    }
}

}  // namespace tex::cli
