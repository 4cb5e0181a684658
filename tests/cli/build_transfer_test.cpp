// SPDX-License-Identifier: Apache-2.0
// The step transfer of build-normals: a low mesh by the rule, its high one by a pattern.

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cli/meshes.h"
#include "cli/texture_tree.h"
#include "unit/gltf_files.h"

namespace tex::cli {
namespace {

class BuildTransfer : public TextureTree {
protected:
    BuildTransfer() {
        fs::create_directories(scratch_.path("meshes"));
        for (const std::string kind : {"low", "high"}) {
            scratch_.add_sample("crate_" + kind + ".glb", "meshes/crate_" + kind + ".glb");
            scratch_.write("meshes/sheet_" + kind + ".obj", kSheetObj);
        }
        write_manifest("meshes/crate_low.glb", "high = \"{dir}/{stem:-_low}_high.glb\"");
    }
    void write_manifest(const std::string& match, const std::string& options) const {
        scratch_.write("normals.toml", "version = 1\n[[rule]]\nmatch = \"" + match +
                                           "\"\nname = \"out/{stem:-_low}_n.png\"\nsteps = [ { transfer = { extent = "
                                           "\"64\", " +
                                           options + " } } ]\n");
    }
    void fails(int code, const std::string& reason) {
        const Ran ran = build();
        EXPECT_EQ(ran.code, code) << ran.err;
        EXPECT_NE(ran.err.find(reason), std::string::npos) << ran.err;
    }
};

TEST_F(BuildTransfer, MakesWhatTheCommandMakes) {
    ASSERT_EQ(build({"--depfile", "d"}).code, 0);
    EXPECT_EQ(done_.at("meshes/crate_low.glb"), "made");
    ASSERT_EQ(run(scratch_, "transfer-normals",
                  {"meshes/crate_low.glb", "meshes/crate_high.glb", "-o", "hand.png", "--extent", "64", "--no-sync"})
                  .code,
              0);
    EXPECT_EQ(scratch_.read("out/crate_n.png"), scratch_.read("hand.png"));
    EXPECT_NE(scratch_.read("d").find("meshes/crate_high.glb"), std::string::npos);
    // Also where the manifest is named by its path.
    const Ran ran = run(scratch_, "build-normals", {scratch_.path("normals.toml"), "--json", "--no-sync"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.out.find("\"current\":1"), std::string::npos) << ran.out;
}

TEST_F(BuildTransfer, IsOutOfDateIfEitherMeshChanges) {
    write_manifest("meshes/sheet_low.obj", "high = \"{dir}/{stem:-_low}_high.obj\", back = 1, front = 1");
    ASSERT_EQ(build().code, 0);
    const std::string first = scratch_.read("out/sheet_n.png");
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(done_.at("meshes/sheet_low.obj"), "current");
    std::string text = kSheetObj;
    text.replace(text.find("v 1 1 0.4"), 9, "v 1 1 0.3");
    text.erase(text.find("vn -0.3 -0.1 1"), 14);
    text.insert(text.find("vn "), "vn 0.2 0.3 1\n");
    scratch_.write("meshes/sheet_high.obj", text);
    const Ran again = build();
    EXPECT_EQ(done_.at("meshes/sheet_low.obj"), "made");
    EXPECT_NE(again.out.find("meshes/sheet_high.obj changed"), std::string::npos) << again.out;
    EXPECT_NE(scratch_.read("out/sheet_n.png"), first);
    scratch_.write("meshes/sheet_low.obj", std::string(kSheetObj) + "# later\n");
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(done_.at("meshes/sheet_low.obj"), "made");
    // From the cache, both meshes decide.
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    fs::remove(scratch_.path("meshes/sheet_high.obj"));
    fails(3, "meshes/sheet_high.obj");
    const Ran explained = run(scratch_, "build-normals", {"--explain", "meshes/sheet_low.obj"});
    EXPECT_NE(explained.out.find("reads meshes/sheet_high.obj"), std::string::npos) << explained.out << explained.err;
    const Ran readers = run(scratch_, "build-normals", {"--explain", "meshes/sheet_high.obj"});
    EXPECT_NE(readers.out.find("meshes/sheet_high.obj: read by rule 1"), std::string::npos) << readers.out;
}

TEST_F(BuildTransfer, RefusesWhatCannotBe) {
    write_manifest("meshes/*_low.glb", "subsamples = 1");
    fails(2, "transfer: no high mesh: give LOW HIGH... -o FILE, or --high PATTERN");
    write_manifest("meshes/*_low.glb", "high = \"{dir}/{stem:-_low}_high.glb\", rays = \"straigt\"");
    fails(2, "did you mean straight?");
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"meshes/crate_low.glb\"\nname = \"meshes/crate_high.glb\"\n"
                   "steps = [ { transfer = { high = \"{dir}/{stem:-_low}_high.glb\", container = \"png\" } } ]\n");
    EXPECT_NE(build().code, 0);
    EXPECT_TRUE(scratch_.read("meshes/crate_high.glb").starts_with("glTF"));
    scratch_.write(
        "normals.toml",
        "version = 1\n[[rule]]\nmatch = \"meshes/crate_low.glb\"\nname = \"out/n.png\"\nsteps = [ { transfer "
        "= { high = \"meshes/crate_high.glb\" } }, { mip = {} } ]\n");
    fails(2, "transfer must be the only step");
}

// The name says that the output is the model.
TEST_F(BuildTransfer, MakesModels) {
    GltfMaker maker;
    maker.add(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 5126);
    maker.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0.6f, 0.8f, 0, 0, 1}, "VEC3", 5126);
    maker.add(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 5126);
    maker.add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123);
    for (const char* const name : {"meshes/card_low.glb", "meshes/card_high.glb"}) {
        scratch_.write(name, maker.glb(R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,)"
                                       R"("material":0})",
                                       R"(,"materials":[{"name":"card"}])"));
    }
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"meshes/card_low.glb\"\nname = \"out/{stem:-_low}_lod.glb\"\n"
                   "steps = [ { transfer = { extent = \"16\", high = \"{dir}/{stem:-_low}_high.glb\" } } ]\n");
    const Ran made = build();
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_EQ(done_.at("meshes/card_low.glb"), "made");
    const Ran hand =
        run(scratch_, "transfer-normals",
            {"meshes/card_low.glb", "meshes/card_high.glb", "-o", "hand.glb", "--extent", "16", "--no-sync"});
    ASSERT_EQ(hand.code, 0) << hand.err;
    EXPECT_EQ(scratch_.read("out/card_lod.glb"), scratch_.read("hand.glb"));
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(done_.at("meshes/card_low.glb"), "current");
    // Other commands that write models do the same.
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"out/*_lod.glb\"\nname = \"packed/{stem}.glb\"\n"
                   "steps = [ { pack = { y = \"down\" } } ]\n");
    const Ran packed = build();
    ASSERT_EQ(packed.code, 0) << packed.err;
    ASSERT_EQ(
        run(scratch_, "pack-normals", {"hand.glb", "-o", "hand2.glb", "--y", "down", "--no-sync", "--quiet"}).code, 0);
    EXPECT_EQ(scratch_.read("packed/card_lod.glb"), scratch_.read("hand2.glb"));
    // A model with files beside it would have outputs that the manifest does not know.
    fs::create_directories(scratch_.path("beside"));
    scratch_.write("beside/n.png", "a picture");
    scratch_.write("beside/a.gltf", R"({"asset":{"version":"2.0"},"images":[{"uri":"n.png"}]})");
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"beside/a.gltf\"\nname = \"packed/{stem}.gltf\"\n"
                   "steps = [ { pack = { y = \"down\" } } ]\n");
    fails(2, "a rule writes models as .glb");
}

TEST_F(BuildTransfer, FailsIfMoreIsMissedThanTheLimit) {
    write_manifest("meshes/crate_low.glb",
                   "high = \"{dir}/{stem:-_low}_high.glb\", front = \"1%\", back = 0.02, max-missed = 0.5");
    fails(4, "more texels are missed than --max-missed 0.5 allows");
}

class BuildTransferMaps : public BuildTransfer {
protected:
    // A rule for both crates and sheets, with maps beside the output.
    void write_rule(const std::string& more, const std::string& name = "{stem:-_low}_n.png",
                    const std::string& high = "{dir}/{stem:-_low}_high.glb",
                    const std::string& match = "meshes/crate_low.glb") const {
        scratch_.write("normals.toml", "version = 1\n[defaults]\nout-dir = \"out\"\n[[rule]]\nmatch = \"" + match +
                                           "\"\nname = \"" + name +
                                           "\"\nsteps = [ { transfer = { extent = \"64\", high = \"" + high + "\", " +
                                           more + " } } ]\n");
    }
    void write_sheets() const {
        scratch_.write("meshes/set_low.obj", std::string(kSheetObj) + kSecondTile);
        scratch_.write("meshes/set_high.obj", kSheetObj);
        write_rule("height-out = \"h/{stem:-_low}.<UDIM>.exr\", front = 3, back = 3", "{stem:-_low}_n.<UDIM>.png",
                   "meshes/set_high.obj", "meshes/set_low.obj");
    }
    // A triangle of the sheet in tile 1012.
    static constexpr const char* kSecondTile = "vt 1.1 1.1\nvt 1.9 1.1\nvt 1.1 1.9\nf 1/10/1 2/11/2 5/12/5\n";
};

TEST_F(BuildTransferMaps, WritesThemAsTheCommandDoes) {
    write_rule("height-out = \"h/{stem:-_low}.exr\", occlusion-out = \"{stem:-_low}_ao.png\", rays-per-hit = 4");
    ASSERT_EQ(build({"--depfile", "d"}).code, 0);
    ASSERT_EQ(run(scratch_, "transfer-normals",
                  {"meshes/crate_low.glb", "meshes/crate_high.glb", "-o", "n.png", "--extent", "64", "--no-sync",
                   "--height-out", "h.exr", "--occlusion-out", "ao.png", "--rays-per-hit", "4"})
                  .code,
              0);
    EXPECT_EQ(scratch_.read("out/crate_n.png"), scratch_.read("n.png"));
    EXPECT_EQ(scratch_.read("out/h/crate.exr"), scratch_.read("h.exr"));
    EXPECT_EQ(scratch_.read("out/crate_ao.png"), scratch_.read("ao.png"));
    EXPECT_NE(scratch_.read("d").find("out/h/crate.exr"), std::string::npos) << scratch_.read("d");
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(done_.at("meshes/crate_low.glb"), "current");
    // One that is lost or changed is made again.
    fs::remove(scratch_.path("out/h/crate.exr"));
    const Ran lost = build();
    EXPECT_NE(lost.out.find("out/h/crate.exr is missing"), std::string::npos) << lost.out;
    EXPECT_EQ(scratch_.read("out/h/crate.exr"), scratch_.read("h.exr"));
    scratch_.write("out/crate_ao.png", "other");
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(scratch_.read("out/crate_ao.png"), scratch_.read("ao.png"));
    const Ran explained = run(scratch_, "build-normals", {"--explain", "out/h/crate.exr"});
    EXPECT_NE(explained.out.find("--height-out out/h/crate.exr"), std::string::npos) << explained.out;
}

TEST_F(BuildTransferMaps, ComeFromTheCacheAndAreCleaned) {
    write_rule("height-out = \"h/{stem:-_low}.exr\"");
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    const std::string height = scratch_.read("out/h/crate.exr"), normals = scratch_.read("out/crate_n.png");
    fs::remove_all(scratch_.path("out"));
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    EXPECT_EQ(done_.at("meshes/crate_low.glb"), "cached");
    EXPECT_EQ(scratch_.read("out/h/crate.exr"), height);
    EXPECT_EQ(scratch_.read("out/crate_n.png"), normals);
    // Another name: no rule makes the old file, unless a last one has its name.
    const std::string before = scratch_.read("normals.toml");
    write_rule("height-out = \"{stem:-_low}_h.exr\"");
    ASSERT_EQ(build({"--prune"}).code, 0);
    EXPECT_EQ(scratch_.read("out/crate_h.exr"), height);
    EXPECT_TRUE(scratch_.has("out/h/crate.exr"));
    scratch_.write("normals.toml", scratch_.read("normals.toml") + before.substr(before.find("[[rule]]")));
    ASSERT_EQ(build({"--prune"}).code, 0);
    EXPECT_FALSE(scratch_.has("out/h/crate.exr"));
    EXPECT_TRUE(scratch_.has("out/crate_n.png"));
}

TEST_F(BuildTransferMaps, AreOfTheFirstOfSeveralOutputs) {
    scratch_.write(
        "normals.toml",
        "version = 1\n[[rule]]\nmatch = \"meshes/crate_low.glb\"\nout-dir = \"out\"\nsteps = [ { transfer = { "
        "extent = \"64\", high = \"{dir}/{stem:-_low}_high.glb\", height-out = \"h.exr\" } } ]\n"
        "outputs = [ { name = \"a.png\" }, { name = \"b.dds\", y = \"down\" } ]\n");
    const Ran ran = build();
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(outputs().size(), 3u);
}

TEST_F(BuildTransferMaps, OtherRulesMayReadThem) {
    scratch_.write("normals.toml",
                   "version = 1\n[defaults]\nout-dir = \"out\"\n"
                   "[[rule]]\nmatch = \"meshes/wall.png\"\nname = \"wall_n.png\"\nsteps = [ { bake = {} }, { blend = { "
                   "detail = \"out/obj.png\" } } ]\n"
                   "[[rule]]\nmatch = \"meshes/crate_low.glb\"\nname = \"n.png\"\nsteps = [ { transfer = { extent = "
                   "\"64\", high = \"meshes/crate_high.glb\", bent-out = \"obj.png\", rays-per-hit = 1 } } ]\n");
    scratch_.add_sample("ramp.png", "meshes/wall.png");
    const Ran ran = build({"-j", "2"});
    const Ran first = ran.code == 0 ? ran : build();
    EXPECT_EQ(first.code, 0) << first.err;
    EXPECT_TRUE(scratch_.has("out/wall_n.png"));
    fs::remove(scratch_.path("out/obj.png"));
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(done_.at("meshes/crate_low.glb"), "made");
}

TEST_F(BuildTransferMaps, RefuseNamesThatDestroy) {
    write_rule("height-out = \"../../h.exr\"");
    fails(2, "leads out of the folder of the manifest");
    write_rule("height-out = \"{stem:-_low}_n.png\"");
    fails(2, "crate_n.png");
    write_rule("height-out = \"../meshes/crate_high.exr\"");
    fs::copy(scratch_.path("meshes/crate_high.glb"), scratch_.path("meshes/crate_high.exr"));
    write_rule("height-out = \"../meshes/crate_high.exr\"", "n.png", "meshes/crate_high.exr");
    EXPECT_NE(build().code, 0);
    EXPECT_TRUE(scratch_.read("meshes/crate_high.exr").starts_with("glTF"));
    write_rule("height-out = \"h.txt\"");
    fails(2, "height-out");
    // Two inputs with one file.
    scratch_.add_sample("crate_low.glb", "meshes/box_low.glb");
    write_rule("height-out = \"h.exr\"", "{stem}_n.png", "meshes/crate_high.glb", "meshes/*_low.glb");
    fails(4, "rename or exclude one");
    write_rule("height-out = \"h.exr\"", "{stem}_n.<UDIM>.png");
    fails(2, "--height-out: h.exr: needs <UDIM>, as the output has it");
    write_rule("subsamples = 1", "{stem}_{level}.<UDIM>.png");
    fails(2, "<UDIM> and {level} contradict each other");
}

TEST_F(BuildTransferMaps, FollowTheTilesOfTheMesh) {
    write_sheets();
    const Ran ran = build();
    ASSERT_EQ(ran.code, 0) << ran.err << ran.out;
    for (const char* name : {"out/set_n.1001.png", "out/set_n.1012.png", "out/h/set.1001.exr", "out/h/set.1012.exr"})
        EXPECT_TRUE(scratch_.has(name)) << name;
    EXPECT_EQ(outputs().size(), 4u);
    ASSERT_EQ(run(scratch_, "transfer-normals",
                  {"meshes/set_low.obj", "meshes/set_high.obj", "-o", "n.<UDIM>.png", "--extent", "64", "--no-sync",
                   "--front", "3", "--back", "3", "--quiet"})
                  .code,
              0);
    EXPECT_EQ(scratch_.read("out/set_n.1012.png"), scratch_.read("n.1012.png"));
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(done_.at("meshes/set_low.obj"), "current");
    fs::remove(scratch_.path("out/h/set.1012.exr"));
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    EXPECT_EQ(done_.at("meshes/set_low.obj"), "made");
    fs::remove_all(scratch_.path("out"));
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    EXPECT_EQ(done_.at("meshes/set_low.obj"), "cached");
    EXPECT_EQ(scratch_.read("out/set_n.1012.png"), scratch_.read("n.1012.png"));
    // The mesh loses a tile.
    scratch_.write("meshes/set_low.obj", kSheetObj);
    ASSERT_EQ(build({"--prune"}).code, 0);
    EXPECT_EQ(outputs().size(), 2u);
    EXPECT_TRUE(scratch_.has("out/h/set.1001.exr"));
    // A mesh that cannot be read fails alone, with the file's name.
    scratch_.write("meshes/set_low.obj", "f 1 2\n");
    fails(4, "meshes/set_low.obj");
    EXPECT_EQ(outputs().size(), 2u);
}

}  // namespace
}  // namespace tex::cli
