// SPDX-License-Identifier: Apache-2.0
// The step transfer of build-normals: a low mesh by the rule, its high one by a pattern.

#include <string>

#include <gtest/gtest.h>

#include "cli/meshes.h"
#include "cli/texture_tree.h"

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
                                           "\"\nname = \"out/{stem:-_low}_n.png\"\nsteps = [ { transfer = { size = "
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
                  {"meshes/crate_low.glb", "meshes/crate_high.glb", "-o", "hand.png", "--size", "64", "--no-sync"})
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
    write_manifest("meshes/*_low.glb", "high = \"{dir}/{stem:-_low}_high.glb\", height-out = \"h.png\"");
    fails(2, "a manifest cannot name a second file to write yet");
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

TEST_F(BuildTransfer, FailsIfMoreIsMissedThanTheLimit) {
    write_manifest("meshes/crate_low.glb",
                   "high = \"{dir}/{stem:-_low}_high.glb\", front = \"1%\", back = 0.02, max-missed = 0.5");
    fails(4, "more texels are missed than --max-missed 0.5 allows");
}

}  // namespace
}  // namespace tex::cli
