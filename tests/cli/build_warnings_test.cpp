// SPDX-License-Identifier: Apache-2.0
// What build-normals says of textures that it need not make, and of pictures that no rule takes.

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/texture_tree.h"

namespace tex::cli {

class BuildWarnings : public TextureTree {
protected:
    // Two maps whose green points down, and a rule that says up.
    BuildWarnings() {
        scratch_.write("normals.toml",
                       "version = 1\n[defaults]\nout-dir = \"out\"\n[[rule]]\nmatch = \"art/*_n.png\"\n"
                       "steps = [ { pack = { y-in = \"up\" } } ]\n");
        EXPECT_EQ(shell(scratch_, "bake-normals '" TEX_SOURCE_DIR
                                  "/samples/bricks.png' -o art/a_n.png --bumpiness 8 --y down && cp art/a_n.png "
                                  "art/b_n.png")
                      .code,
                  0);
    }
    [[nodiscard]] static std::size_t warnings_of(const Ran& ran) {
        std::size_t count = 0;
        for (const std::string& line : lines_of(ran.out))
            count += nlohmann::json::parse(line).value("warnings", nlohmann::json::array()).size();
        return count;
    }
};

TEST_F(BuildWarnings, StandAsLongAsTheOutput) {
    const Ran first = build({"--threads", "1"});
    ASSERT_EQ(first.code, 0) << first.err;
    EXPECT_NE(first.err.find("green"), std::string::npos) << first.err;
    ASSERT_EQ(warnings_of(first), 4u) << first.out << "of inputs and of outputs";
    const Ran second = build({"--threads", "1"});
    EXPECT_EQ(count("current"), 2u);
    EXPECT_EQ(second.err, first.err);
    EXPECT_EQ(warnings_of(second), 4u) << second.out;
    EXPECT_EQ(build({"--quiet"}).err, "");
    // What is mended is no longer said.
    const std::string manifest = scratch_.read("normals.toml");
    scratch_.write("normals.toml", std::string(manifest).replace(manifest.find("up"), 2, "down"));
    EXPECT_EQ(build().err.find("green"), std::string::npos);
    EXPECT_EQ(build().err.find("green"), std::string::npos);
}

TEST_F(BuildWarnings, ComeWithWhatTheCacheHolds) {
    const Ran first = build({"--cache", "cache", "--threads", "1"});
    ASSERT_EQ(first.code, 0) << first.err;
    ASSERT_EQ(shell(scratch_, "rm -r out .normals.toml.state; mv art/a_n.png art/c_n.png").code, 0);
    const Ran second = build({"--cache", "cache", "--threads", "1"});
    EXPECT_EQ(count("cached"), 2u);
    EXPECT_EQ(warnings_of(second), 4u) << second.out;
    EXPECT_NE(second.out.find(R"("file":"out/art/c_n.dds")"), std::string::npos) << second.out;
    EXPECT_EQ(second.out.find("art/a_n.png"), std::string::npos) << second.out;
    const Ran third = build({"--cache", "cache", "--threads", "1"});
    EXPECT_EQ(count("current"), 2u);
    EXPECT_EQ(third.err, second.err);
}

TEST_F(BuildWarnings, ComeBackFromShards) {
    const Ran shards =
        shell(scratch_,
              "set -e; build-normals --plan plan.jsonl; for k in 1 2; do build-normals --plan plan.jsonl "
              "--shard $k/2 --report $k.jsonl --no-sync --quiet; done\n"
              "build-normals --plan plan.jsonl --merge 1.jsonl 2.jsonl");
    ASSERT_EQ(shards.code, 0) << shards.err;
    const Ran ran = build();
    EXPECT_EQ(count("current"), 2u);
    EXPECT_EQ(warnings_of(ran), 4u) << ran.out;
}

TEST_F(BuildWarnings, PicturesWithoutARuleAreCounted) {
    scratch_.add_sample("ramp.png", "art/hall.png");
    scratch_.add_sample("ramp.png", "art/hall_color.png");
    scratch_.add_sample("ramp.png", "art/notes.txt");
    const Ran first = run(scratch_, "build-normals", {"--no-sync"});
    EXPECT_NE(first.out.find("2 made, 0 up to date; 2 other pictures have no rule (--dry-run lists them)"),
              std::string::npos)
        << first.out;
    const Ran listed = run(scratch_, "build-normals", {"--dry-run"});
    EXPECT_NE(listed.out.find("art/hall.png: has no rule\n"), std::string::npos) << listed.out;
    EXPECT_EQ(listed.out.find("notes"), std::string::npos) << listed.out;
    EXPECT_EQ(nlohmann::json::parse(lines_of(build().out).back())["without_rule"], 3) << "and art/wall_h.png";
    scratch_.write("normals.toml", scratch_.read("normals.toml") + "exclude = \"art/*_color.png\"\n");
    const Ran excluded = run(scratch_, "build-normals", {"--no-sync"});
    EXPECT_NE(excluded.out.find("; 1 other picture has no rule"), std::string::npos) << excluded.out;
}

TEST_F(BuildWarnings, OutputsOfInputsThatAreGoneAreCounted) {
    ASSERT_EQ(build().code, 0);
    fs::remove(scratch_.path("art/a_n.png"));
    const Ran gone = run(scratch_, "build-normals", {"--no-sync"});
    EXPECT_NE(gone.out.find("0 made, 1 up to date; 1 output of earlier runs is no longer made (--prune removes it)"),
              std::string::npos)
        << gone.out;
    const Ran pruned = run(scratch_, "build-normals", {"--no-sync", "--prune"});
    EXPECT_NE(pruned.out.find("0 made, 1 up to date, 1 removed"), std::string::npos) << pruned.out;
    EXPECT_EQ(run(scratch_, "build-normals", {"--no-sync"}).out.find("no longer"), std::string::npos);
}

// --prune removes only what a rule can make, so that another file type leaves files that it does not know.
TEST_F(BuildWarnings, OutputsThatNoRuleNamesAnyMoreAreForTheUserToDelete) {
    ASSERT_EQ(build().code, 0);
    scratch_.write("normals.toml",
                   "version = 1\n[defaults]\nout-dir = \"out\"\nname = \"{dir}/{stem}.png\"\n[[rule]]\n"
                   "match = \"art/*_n.png\"\nsteps = [ { pack = { y-in = \"up\", format = \"rgb8\" } } ]\n");
    const Ran changed = run(scratch_, "build-normals", {"--no-sync"});
    EXPECT_NE(changed.out.find("; 2 outputs of earlier runs are no longer made (such as "), std::string::npos)
        << changed.out;
    EXPECT_NE(changed.out.find(": no rule gives an output such a name now, so delete what you do not need)"),
              std::string::npos)
        << changed.out;
    EXPECT_EQ(changed.out.find("--prune"), std::string::npos) << changed.out;
}

}  // namespace tex::cli
