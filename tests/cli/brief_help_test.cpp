// SPDX-License-Identifier: Apache-2.0
// -h: one screen, whose options exist and whose examples run.

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {
namespace {

// The lines of a command's screen between two headings.
std::vector<std::string> examples_of(const std::string& screen) {
    std::vector<std::string> examples;
    const std::vector<std::string> lines = lines_of(screen);
    auto line = std::find(lines.begin(), lines.end(), "Examples:");
    for (; line != lines.end(); ++line) {
        if (line->starts_with("  ") && !line->starts_with("      ")) examples.push_back(line->substr(2));
    }
    return examples;
}

TEST(BriefHelp, IsOneScreenOfOptionsThatExist) {
    const Scratch scratch;
    for (const std::string& command : commands()) {
        const Ran ran = run(scratch, command, {"-h"});
        EXPECT_EQ(ran.code, 0);
        EXPECT_EQ(ran.err, "");
        EXPECT_EQ(run(scratch, command, {"--nonsense", "-h"}).out, ran.out) << "also if another option is wrong";
        const std::vector<std::string> lines = lines_of(ran.out);
        EXPECT_LE(lines.size(), 24u) << ran.out;
        const std::string table = "\n" + run(scratch, command, {"--list-options"}).out;
        std::size_t options = 0;
        for (const std::string& line : lines) {
            EXPECT_LE(line.size(), 80u) << command << ": " << line;
            const std::size_t name = line.find("--");
            if (!(line.starts_with("  -") || line.starts_with("      --"))) continue;
            ++options;
            const std::string option = line.substr(name, line.find(' ', name) - name);
            EXPECT_TRUE(table.find("\n" + option + "\t") != std::string::npos ||
                        table.find("," + option + "\t") != std::string::npos)
                << command << ": " << option;
        }
        EXPECT_EQ(options, 8u) << ran.out;
        EXPECT_EQ(examples_of(ran.out).size(), 3u) << ran.out;
        EXPECT_NE(ran.out.find("--help lists all options"), std::string::npos);
        EXPECT_EQ(run(scratch, command, {"-h", "--json"}).out, run(scratch, command, {"--help", "--json"}).out);
        EXPECT_EQ(run(scratch, command, {"-h", "--help"}).out, run(scratch, command, {"--help"}).out);
    }
}

// The files that the examples name, made of the samples.
class BriefExamples : public testing::Test {
protected:
    BriefExamples() {
        namespace fs = std::filesystem;
        for (const char* folder : {"maps", "directx", "walls", "art/stone"})
            fs::create_directories(scratch_.path(folder));
        for (const char* heights : {"bricks.png", "maps/a.png", "maps/b.png", "bricks_h.png"})
            scratch_.add_sample("bricks.png", heights);
        scratch_.add_sample("hemisphere.png", "art/wall_h.png");
        scratch_.add_sample("hemisphere.png", "moss_mask.png");
        scratch_.add_sample("waves.png", "grain_h.png");
        for (const char* mesh : {"rock.glb", "rock_v1.glb", "rock_v2.glb", "rock_low.glb", "low.glb"})
            scratch_.add_sample("crate_low.glb", mesh);
        for (const char* mesh : {"rock_high.glb", "high.glb"}) scratch_.add_sample("crate_high.glb", mesh);
        for (const char* model : {"model.glb", "scene.glb", "cat.glb", "cat_low.glb"})
            scratch_.add_sample("broken/N805-double-sided-tangents.glb", model);
        const std::string manifest =
            "version = 1\n[[rule]]\nmatch = \"*_h.png\"\nname = \"{stem:-_h}_n.dds\"\n"
            "steps = [ { bake = {} } ]\n";
        scratch_.write("normals.toml", manifest);
        scratch_.write("art/normals.toml", manifest);
        make("bake-normals bricks.png -o bricks_n.png");
        for (const char* picture :
             {"rock_n.png", "rock.png", "n.png", "wall.png", "directx/a.png", "art/stone/b_n.png"})
            fs::copy_file(scratch_.path("bricks_n.png"), scratch_.path(picture));
        make("bake-normals grain_h.png -o grain.png");
        make("bake-normals bricks.png -o bricks.exr");
        for (const char* texture : {"bricks.dds", "bricks.ktx2", "rock_n.dds", "rock.dds", "old.dds", "new.dds",
                                    "before.dds", "after.dds", "walls/a.dds", "art/stone/a_n.dds"})
            make(std::string("mip-normals bricks_n.png --effort fast -o ") + texture);
        for (const char* texture : {"grain.dds", "moss.dds"}) make(std::string("mip-normals grain.png -o ") + texture);
    }
    void run_shards() {
        std::filesystem::remove(scratch_.path("r3.jsonl"));  // of 64 shards
        for (const char* shard : {"1", "2"})
            make(std::string("build-normals --plan plan.jsonl --shard ") + shard + "/2 --report r" + shard + ".jsonl");
    }
    void make(const std::string& line) {
        const Ran ran = shell(scratch_, line + " --quiet --no-sync");
        EXPECT_EQ(ran.code, 0) << line << ": " << ran.err;
    }
    Scratch scratch_;
};

TEST_F(BriefExamples, RunAsTheyArePrinted) {
    for (const std::string& command : commands()) {
        for (const std::string& example : examples_of(run(scratch_, command, {"-h"}).out)) {
            EXPECT_TRUE(example.starts_with(command)) << example;
            // The reports that a merge reads come from shards, and a folder of maps has no heights.
            if (example.find("--merge") != std::string::npos) run_shards();
            const Ran ran =
                shell(scratch_, (example.find(" *.png") != std::string::npos ? "cd directx; " : "") + example);
            EXPECT_EQ(ran.code, 0) << example << ": " << ran.out << ran.err;
            EXPECT_EQ(ran.err.find("error"), std::string::npos) << example << ": " << ran.err;
        }
    }
}

}  // namespace
}  // namespace tex::cli
