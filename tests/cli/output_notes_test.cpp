// SPDX-License-Identifier: Apache-2.0
// What commands say of outputs that lack something although nobody asked for that.

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {

class OutputNotes : public testing::Test {
protected:
    OutputNotes() {
        scratch_.add_sample("bricks.png", "bricks.png");
        const Ran made = shell(scratch_,
                               "set -e; bake-normals bricks.png -o n.png --bumpiness 3 --no-sync;"
                               "convert n.png -crop 130x126+0+0 +repage odd.png");
        EXPECT_EQ(made.code, 0) << made.err;
    }
    std::string said(const std::string& script) {
        const Ran ran = shell(scratch_, script + " --no-sync");
        EXPECT_EQ(ran.code, 0) << script << ran.err;
        return ran.err;
    }
    static bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
    Scratch scratch_;
};

TEST_F(OutputNotes, BlocksWithoutSmallerLevels) {
    const std::string one = "n.png: one level is written, as in the input";
    EXPECT_TRUE(has(said("pack-normals n.png -o n.dds"), one));
    EXPECT_TRUE(has(said("pack-normals n.png -o n.ktx2 --format astc-4x4"), one));
    EXPECT_EQ(said("pack-normals n.png -o n.dds --mips keep"), "");
    EXPECT_EQ(said("pack-normals n.png -o n.dds --mips none"), "");
    EXPECT_EQ(said("pack-normals n.png -o n.ktx2 --for bevy"), "");
    EXPECT_EQ(said("pack-normals n.png -o all.dds --mips all"), "");
    EXPECT_EQ(said("pack-normals all.dds -o again.ktx2"), "");
    EXPECT_EQ(said("pack-normals n.dds -o again.dds --format bc5"), "") << "a texture with one level is meant to be so";
    EXPECT_EQ(said("pack-normals n.png -o n.tga"), "");
    EXPECT_EQ(said("pack-normals n.png -o n.dds --format rgba8"), "") << "not compressed: engines build levels";
}

TEST_F(OutputNotes, SidesThatAreNoMultiplesOf4) {
    const std::string side = "odd.png: a side of the base level is no multiple of 4";
    EXPECT_TRUE(has(said("pack-normals odd.png -o odd.dds --mips all"), side));
    EXPECT_TRUE(has(said("mip-normals odd.png -o odd.ktx2 --format bc5"), side));
    EXPECT_EQ(said("pack-normals odd.png -o odd.ktx2 --mips all --format astc-4x4"), "");
    EXPECT_EQ(said("pack-normals odd.png -o odd.tga"), "");
}

TEST_F(OutputNotes, SizesThatHalvingMisses) {
    const std::string size = "--max-size 300 gives 256x256: it only halves";
    EXPECT_TRUE(has(said("pack-normals n.png -o n.tga --max-size 300"), size));
    EXPECT_TRUE(has(said("mip-normals n.png -o n.dds --max-size 300"), size));
    EXPECT_TRUE(has(said("bake-normals bricks.png -o n.dds --bumpiness 9 --max-size 300"), size));
    EXPECT_TRUE(has(said("blend-normals n.png n.png -o n.dds --max-size 300"), size));
    EXPECT_EQ(said("pack-normals n.png -o n.tga --max-size 256"), "");
    EXPECT_EQ(said("pack-normals n.png -o n.tga --max-size 600"), "") << "nothing is halved";
}

// Standard error sums them up; the JSON does not.
TEST_F(OutputNotes, AreNotRepeatedForManyFiles) {
    ASSERT_EQ(shell(scratch_, "cp n.png a.png; cp n.png b.png").code, 0);
    const Ran ran = run(scratch_, "pack-normals", {"n.png", "b.png", "a.png", "--out-dir", "out", "--no-sync"});
    ASSERT_EQ(lines_of(ran.err).size(), 1u) << ran.err;
    EXPECT_TRUE(has(ran.err, "a.png and 2 more: one level is written")) << ran.err;
    const Ran told = run(scratch_, "pack-normals", {"n.png", "a.png", "--out-dir", "out", "--no-sync", "--json"});
    for (const std::string& line : lines_of(told.out)) {
        const auto json = nlohmann::json::parse(line);
        ASSERT_EQ(json["warnings"].size(), 1u) << line;
        EXPECT_EQ(json["warnings"][0]["file"], json["input"]) << line;
    }
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"{a,b,n}.png\"\nname = \"{stem}.dds\"\n"
                   "steps = [ { pack = {} } ]\n");
    const Ran built = run(scratch_, "build-normals", {"--no-sync"});
    ASSERT_EQ(lines_of(built.err).size(), 1u) << built.err;
    EXPECT_TRUE(has(built.err, "a.dds and 2 more: one level is written")) << built.err;
}

}  // namespace tex::cli
