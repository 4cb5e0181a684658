// SPDX-License-Identifier: Apache-2.0
// What build-normals does not believe: a state, a report or an entry of the cache that somebody else has written.

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/texture_tree.h"
#include "tree/placement.h"
#include "tree/state.h"

namespace tex::cli {
namespace {

class BuildTrust : public TextureTree {
protected:
    BuildTrust() {
        victims_.write("notes.txt", "notes");
        victims_.write("x.dds", "a texture of somebody else");
        write_rule("art/*_h.png", "{dir}/{stem:-_h}_n.dds");
    }
    void write_rule(const std::string& match, const std::string& name, const std::string& out = "out") const {
        scratch_.write("normals.toml", "version = 1\n[[rule]]\nmatch = \"" + match + "\"\nout-dir = \"" + out +
                                           "\"\nname = \"" + name + "\"\nsteps = [ { bake = {} } ]\n");
    }
    // Adds an output to the state, as whoever ships a folder can.
    void forge(const std::string& file, const std::string& input = "art/gone_h.png") const {
        BuildState state = BuildState::parse(scratch_.read(".normals.toml.state"));
        const auto digest = digest_of_file(path_from(scratch_.path(), file));
        state.outputs[file] = {input, {}, {}, {{file, digest ? *digest : Digest()}}};
        scratch_.write(".normals.toml.state", state.text(BuildState::Memos::all));
    }
    [[nodiscard]] Ran prune(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments = {"--prune", "--no-sync"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(scratch_, "build-normals", arguments);
    }

    Scratch victims_;
};

}  // namespace

TEST_F(BuildTrust, PruneRemovesNothingThatTheRulesCannotMake) {
    ASSERT_EQ(build().code, 0);
    scratch_.write("src.c", "int main;");
    scratch_.write("art/x_n.dds", "not in out-dir");
    scratch_.write("out/notes.txt", "notes");
    scratch_.write("out/art/gone.dds", "another name");
    const std::string away = fs::relative(victims_.path("notes.txt"), scratch_.path()).string();
    const std::vector<std::string> files = {"src.c",         away,
                                            "art/x_n.dds",   victims_.path("notes.txt"),
                                            "out/notes.txt", "out/../../" + fs::path(away).filename().string(),
                                            "normals.toml",  "out/art/../../src.c",
                                            "./src.c",       "out/art/gone.dds",
                                            "art/wall_h.png"};
    const auto before = scratch_.list();
    for (const std::string& file : files) {
        for (const std::string input : {"art/gone_h.png", "../art/gone_h.png", "/art/gone_h.png", ""}) {
            forge(file, input);
            const Ran ran = prune();
            EXPECT_EQ(ran.code, 0) << ran.err;
            EXPECT_NE(ran.out.find(" up to date\n"), std::string::npos) << file << ": " << ran.out;
            EXPECT_EQ(scratch_.list(), before) << file;
            EXPECT_TRUE(victims_.has("notes.txt"));
        }
    }
    EXPECT_EQ(prune({"--dry-run"}).out, "0 to make, 1 up to date\n");
    EXPECT_NE(prune().err.find("no rule of this manifest gives an output such a name"), std::string::npos);
}

TEST_F(BuildTrust, PruneRemovesWhatARuleMakesOfAnInputThatIsGone) {
    ASSERT_EQ(build().code, 0);
    scratch_.write("out/art/gone_n.dds", "an output");
    forge("out/art/gone_n.dds");
    EXPECT_EQ(prune().out, "0 made, 1 up to date, 1 removed\n");
    EXPECT_FALSE(scratch_.has("out/art/gone_n.dds"));
}

TEST_F(BuildTrust, PruneFollowsNoLinkBelowOutDir) {
    ASSERT_EQ(build().code, 0);
    fs::create_directory_symlink(victims_.path(), scratch_.path("out/lnk"));
    fs::create_symlink(victims_.path("x.dds"), scratch_.path("out/l.dds"));
    write_rule("**/*_h.png", "{dir}/{stem:-_h}.dds");
    forge("out/lnk/x.dds", "lnk/x_h.png");
    forge("out/l.dds", "l_h.png");
    EXPECT_EQ(prune().code, 0);
    EXPECT_TRUE(victims_.has("x.dds"));
    EXPECT_TRUE(fs::is_symlink(scratch_.path("out/l.dds")));
    // An out-dir that is a link is what the user wants.
    fs::create_directory_symlink(victims_.path(), scratch_.path("chosen"));
    write_rule("art/*_h.png", "{stem:-_h}.dds", "chosen");
    forge("chosen/x.dds", "art/x_h.png");
    EXPECT_EQ(prune().code, 0);
    EXPECT_FALSE(victims_.has("x.dds"));
    EXPECT_TRUE(victims_.has("notes.txt"));
}

// A name that was given up is known again if a last rule has it, which then makes nothing.
TEST_F(BuildTrust, ALastRuleWithTheOldNameLetsPruneRemoveIt) {
    ASSERT_EQ(build().code, 0);
    write_rule("art/*_h.png", "{dir}/{stem:-_h}_new.dds");
    const Ran kept = prune();
    EXPECT_NE(kept.err.find("1 file of an earlier run is kept, such as out/art/wall_n.dds: no rule"), std::string::npos)
        << kept.err;
    EXPECT_TRUE(scratch_.has("out/art/wall_n.dds"));
    scratch_.write("normals.toml", scratch_.read("normals.toml") +
                                       "[[rule]]\nmatch = \"art/*_h.png\"\nout-dir = \"out\"\nname = "
                                       "\"{dir}/{stem:-_h}_n.dds\"\nsteps = [ { bake = {} } ]\n");
    EXPECT_EQ(prune().out, "0 made, 1 up to date, 1 removed\n");
    EXPECT_EQ(outputs().size(), 1u);
}

// The state says which digests outputs have, and not which files they are.
TEST_F(BuildTrust, AnOutputWhoseStateNamesOtherFilesIsMade) {
    ASSERT_EQ(build().code, 0);
    const auto bytes = outputs();
    const BuildState honest = BuildState::parse(scratch_.read(".normals.toml.state"));
    scratch_.write("other", "other");
    for (const NamedDigests& files : {NamedDigests(), NamedDigests{{"other", digest_of("other")}}}) {
        BuildState state = honest;
        for (auto& [name, record] : state.outputs) record.files = files;
        scratch_.write(".normals.toml.state", state.text(BuildState::Memos::all));
        fs::remove_all(scratch_.path("out"));
        ASSERT_EQ(build({"--prune", "--depfile", "d"}).code, 0);
        EXPECT_EQ(outputs(), bytes);
        EXPECT_TRUE(scratch_.has("other"));
        EXPECT_EQ(scratch_.read("d").find("other"), std::string::npos);
    }
}

TEST_F(BuildTrust, AReportThatNamesOtherFilesIsNotUsed) {
    ASSERT_EQ(build({"--plan", "plan.jsonl"}).code, 0);
    ASSERT_EQ(build({"--plan", "plan.jsonl", "--shard", "1/1", "--report", "r.jsonl"}).code, 0);
    const std::string report = scratch_.read("r.jsonl"), name = "\"file\":\"out/art/wall_n.dds\"";
    ASSERT_NE(report.find(name), std::string::npos) << report;
    scratch_.write("src.c", "int main;");
    std::string forged = report;
    forged.replace(forged.find(name), name.size(), "\"file\":\"src.c\"");
    const std::string sum = "\"sha256\":\"";
    forged.replace(forged.find(sum) + sum.size(), 64, digest_of("int main;").hex());
    scratch_.write("forged.jsonl", forged);
    const Ran ran = run(scratch_, "build-normals", {"--plan", "plan.jsonl", "--merge", "forged.jsonl"});
    EXPECT_EQ(ran.code, 4) << ran.err;
    EXPECT_NE(ran.err.find("art/wall_h.png has files that its rule does not make"), std::string::npos) << ran.err;
    EXPECT_TRUE(BuildState::parse(scratch_.read(".normals.toml.state")).outputs.empty());
    EXPECT_EQ(run(scratch_, "build-normals", {"--plan", "plan.jsonl", "--merge", "r.jsonl"}).code, 0);
}

// Whatever an option of a command writes, nothing but the outputs of the manifest takes its place.
TEST(Placement, AcceptsNoFileThatIsNoOutput) {
    const Scratch scratch;
    const TreeFiles files({}, {}, scratch.path(), {});
    Placement placement(files, {scratch.path("a.dds")}, [] { return Result<bool>(true); });
    const std::vector<std::byte> bytes(4);
    WriteOptions write;
    write.sync = false;
    EXPECT_TRUE(write_file(scratch.path("a.dds"), bytes, placement.watched(write)));
    const auto refused = write_file(scratch.path("b.dds"), bytes, placement.watched(write));
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message().find("is not an output that the manifest names"), std::string::npos);
    EXPECT_EQ(scratch.list(), std::vector<std::string>{"a.dds"});
}

// 8 TiB without a byte of them on the disk.
TEST_F(BuildTrust, AHugeEntryOfACacheIsMadeAgain) {
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    const auto bytes = outputs();
    std::vector<std::string> entries;
    for (const std::string& name : scratch_.list()) {
        const bool is_entry = name.starts_with("cache/") && fs::path(name).filename().string().size() == 64;
        if (is_entry && scratch_.read(name).size() > 1000) entries.push_back(name);  // the other one holds warnings
    }
    ASSERT_EQ(entries.size(), 1u);
    const std::string whole = scratch_.read(entries[0]), key = fs::path(entries[0]).filename();
    constexpr std::uintmax_t kHuge = std::uintmax_t{8} << 40;
    const std::string head = fmt::format("libtex-cache 3 {} {} ", key, digest_of("").hex());
    const auto fitting = fmt::format("{}{}\n", head, kHuge - head.size() - 14 - 1);
    for (const std::string& begin : {whole, std::string(), std::string("libtex-cache 3 "), fitting}) {
        scratch_.write(entries[0], begin);
        std::error_code error;
        fs::resize_file(scratch_.path(entries[0]), kHuge, error);
        if (error) GTEST_SKIP() << "the file system has no files of 8 TiB";
        fs::remove_all(scratch_.path("out"));
        const Ran ran = run(scratch_, "build-normals", {"--cache", "cache", "--no-sync"});
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_EQ(ran.out, "1 made, 0 up to date, 0 from the cache (1 damaged entry repaired)\n");
        EXPECT_LT(ran.peak_bytes, std::int64_t{512} << 20);
        EXPECT_EQ(outputs(), bytes);
        EXPECT_EQ(scratch_.read(entries[0]), whole);
    }
}

TEST_F(BuildTrust, AListThatNeverEndsIsGivenUpEarly) {
    constexpr std::int64_t kMost = std::int64_t{256} << 20;
    const std::vector<std::vector<std::string>> lines = {
        {"check-normals", "--files-from", "/dev/zero"},
        {"check-normals", "@/dev/zero"},
        {"check-normals", "--baseline", "/dev/zero", "art/wall_h.png"},
        {"build-normals", "--plan", "/dev/zero", "--shard", "1/1"},
    };
    for (const auto& line : lines) {
        const Ran ran = run(scratch_, line[0], {line.begin() + 1, line.end()});
        EXPECT_NE(ran.code, 0) << line[1];
        EXPECT_NE(ran.err.find("has more than 67108864 bytes"), std::string::npos) << line[1] << ran.err;
        EXPECT_LT(ran.peak_bytes, kMost) << line[1];
    }
    // A file without a byte on the disk says its size.
    scratch_.write("list", "");
    fs::resize_file(scratch_.path("list"), std::uintmax_t{1} << 33);
    const Ran ran = run(scratch_, "check-normals", {"--files-from", "list"});
    EXPECT_NE(ran.err.find("list: has more than 67108864 bytes"), std::string::npos) << ran.err;
    EXPECT_LT(ran.peak_bytes, std::int64_t{64} << 20);
}

TEST_F(BuildTrust, AManifestOfManyOutputsTakesLittleMemory) {
    std::string text = "version = 1\n[[rule]]\nmatch = \"art/wall_h.png\"\nsteps = [ { bake = {} } ]\noutputs = [\n";
    for (int k = 0; k < 20000; ++k) text += fmt::format("{{ name = \"o/{}.dds\" }},\n", k);
    scratch_.write("normals.toml", text + "]\n");
    const Ran ran = run(scratch_, "build-normals", {"--dry-run"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_LT(ran.peak_bytes, std::int64_t{250} << 20);
    // Different settings share the table of options, which takes 40 KB.
    text = text.substr(0, text.find("{ name"));
    for (int k = 0; k < 4000; ++k)
        text += fmt::format("{{ name = \"o/{}.dds\", format = \"bc5\", rdo-mean = {} }},\n", k, 0.1 + 0.001 * k);
    scratch_.write("normals.toml", text + "]\n");
    const Ran different = run(scratch_, "build-normals", {"--dry-run"});
    ASSERT_EQ(different.code, 0) << different.err;
    EXPECT_LT(different.peak_bytes, std::int64_t{125} << 20);
}

}  // namespace tex::cli
