// SPDX-License-Identifier: Apache-2.0
// build-normals --explain prints the rule of an input or an output, its settings and its command lines.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cli/texture_tree.h"

namespace tex::cli {

class BuildExplain : public TextureTree {};

TEST_F(BuildExplain, PrintsTheRuleAndTheCommandLines) {
    const Ran ran = run(scratch_, "build-normals", {"--explain", "art/wall_h.png"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    for (const char* part : {"rule 2 (line 7)", "tiling = 3  (line 11)", "effort = normal  (default of mip-normals)",
                             "y = down  (outputs, line 12)", "reads out/shared/grain.dds",
                             "bake-normals art/wall_h.png -o step1.exr --bumpiness 4 --format float"})
        EXPECT_NE(ran.out.find(part), std::string::npos) << part << "\n" << ran.out;
    EXPECT_EQ(run(scratch_, "build-normals", {"--explain", "out/art/wall_n.dds"}).out, ran.out);
    EXPECT_EQ(run(scratch_, "build-normals", {"--explain", "other.png"}).code, 2);
    EXPECT_FALSE(scratch_.has("out"));
    // A file that is made by one rule and read by another; one that is only read.
    const std::string grain = run(scratch_, "build-normals", {"--explain", "out/shared/grain.dds"}).out;
    EXPECT_TRUE(grain.starts_with("shared/grain.png: rule 1 (line 4)")) << grain;
    const std::string reader = ": read by rule 2 (line 7) for 2 textures, match art/**/*_h.{png,tif}\n";
    EXPECT_TRUE(grain.ends_with("\nout/shared/grain.dds" + reader)) << grain;
    std::string manifest = kManifest;
    manifest.replace(manifest.find("out/shared/grain.dds"), 20, "./mask.png");
    scratch_.write("normals.toml", manifest);
    EXPECT_EQ(run(scratch_, "build-normals", {"--explain", "mask.png"}).out, "mask.png" + reader);
}

// The values are those of the run, not the defaults of the command.
TEST_F(BuildExplain, PrintsWhatAnEngineDecides) {
    scratch_.write("normals.toml", R"(version = 1
[[rule]]
match = "art/wall_h.png"
steps = [ { bake = {} }, { pack = {} } ]
outputs = [ { name = "g/{stem}.png", for = "godot" }, { name = "b/{stem}.ktx2", for = "bevy", y = "down" },
            { name = "p/{stem}.dds" } ]
)");
    const Ran ran = run(scratch_, "build-normals", {"--explain", "art/wall_h.png"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    const std::size_t godot = ran.out.find("pack for g/"), bevy = ran.out.find("pack for b/"),
                      plain = ran.out.find("pack for p/");
    ASSERT_TRUE(godot < bevy && bevy < plain && plain != std::string::npos) << ran.out;
    const std::string parts[] = {ran.out.substr(godot, bevy - godot), ran.out.substr(bevy, plain - bevy),
                                 ran.out.substr(plain)};
    const auto expect = [&](const std::string& part, std::initializer_list<const char*> lines) {
        for (const char* line : lines) EXPECT_NE(part.find(line), std::string::npos) << line << "\n" << part;
    };
    expect(parts[0],
           {"    format = rgb8  (for = godot)\n", "    y = up  (for = godot)\n", "    mips = none  (for = godot)\n"});
    expect(parts[1],
           {"    format = bc5  (for = bevy)\n", "    y = down  (outputs, line 5)\n", "    mips = all  (for = bevy)\n"});
    expect(parts[2], {"    format = dxt5nm  (default of pack-normals for .dds)\n", "    y = as in the input"});
    EXPECT_EQ(parts[0].find("dxt5nm"), std::string::npos) << parts[0];
}

// A default means nothing beside a setting that is used instead. An output with a file for each level is found by each.
TEST_F(BuildExplain, KnowsWhatReplacesADefaultAndTheFilesOfLevels) {
    scratch_.write("normals.toml", R"(version = 1
[defaults]
out-dir = "out"
[[rule]]
match = "art/wall_h.png"
name = "w_{level}.png"
steps = [ { bake = { height-range = 0.05, world-size = 2 } }, { mip = {} } ]
)");
    const std::string text = run(scratch_, "build-normals", {"--explain", "art/wall_h.png"}).out;
    EXPECT_NE(text.find("height-range = 0.05  (line 7)"), std::string::npos) << text;
    EXPECT_EQ(text.find("bumpiness = "), std::string::npos) << text;
    EXPECT_EQ(run(scratch_, "build-normals", {"--explain", "out/w_0.png"}).out, text);
    EXPECT_EQ(run(scratch_, "build-normals", {"--explain", "out/w_3.png"}).out, text);
    ASSERT_EQ(build({"--plan", "plan.jsonl"}).code, 0);
    EXPECT_NE(scratch_.read("plan.jsonl").find(R"("outputs":["out/w_{level}.png"])"), std::string::npos);
    ASSERT_EQ(build({"--plan", "plan.jsonl", "--shard", "1/1", "--report", "r.jsonl"}).code, 0);
    EXPECT_TRUE(scratch_.has("out/w_3.png"));
}

}  // namespace tex::cli
