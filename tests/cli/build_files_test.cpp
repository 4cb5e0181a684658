// SPDX-License-Identifier: Apache-2.0
// What build-normals may replace and remove: its outputs, its state, the entries of its cache, and nothing else.

#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/texture_tree.h"

namespace tex::cli {

class BuildFiles : public TextureTree {
protected:
    BuildFiles() { victims_.write("victim", "nobody may write this\n"); }
    ~BuildFiles() override { EXPECT_EQ(victims_.read("victim"), "nobody may write this\n"); }

    [[nodiscard]] std::string victim() const { return victims_.path("victim"); }
    void link(const std::string& target, const std::string& name) const {
        fs::create_directories(fs::path(scratch_.path(name)).parent_path());
        fs::create_symlink(target, scratch_.path(name));
    }
    // Every file of the tree that is not an output, the state or in the cache.
    [[nodiscard]] std::map<std::string, std::string> own_files() const {
        std::map<std::string, std::string> all;
        for (const std::string& name : scratch_.list()) {
            const bool is_ours = name.starts_with("out/") || name.starts_with("cache/") || name.ends_with(".state");
            if (!is_ours && fs::is_regular_file(scratch_.path(name))) all[name] = scratch_.read(name);
        }
        return all;
    }
    // The arguments are a mistake of the command line or the manifest, and every file stays.
    void refuses(const std::vector<std::string>& arguments, const std::string& reason) {
        const auto before = own_files();
        const auto made = outputs();
        const Ran ran = build(arguments);
        EXPECT_EQ(ran.code, 2) << ran.err;
        EXPECT_NE(ran.err.find(reason), std::string::npos) << ran.err;
        EXPECT_EQ(own_files(), before);
        EXPECT_EQ(outputs(), made);
    }
    [[nodiscard]] std::vector<std::string> entries() const {
        std::vector<std::string> names;
        for (const std::string& name : scratch_.list()) {
            if (name.starts_with("cache/") && fs::path(name).filename().string().size() == 64) names.push_back(name);
        }
        return names;
    }
    void write_rule(const std::string& rule) const {
        scratch_.write("normals.toml", "version = 1\n[[rule]]\nsteps = [ { bake = {} } ]\n" + rule);
    }

    Scratch victims_;
};

TEST_F(BuildFiles, ACacheIsAFolderThatWasMadeForIt) {
    refuses({"--cache", ".", "--cache-size", "1"}, "--cache .: holds other files and is not a cache of build-normals");
    refuses({"--cache", "art", "--cache-size", "1"}, "--cache art: holds other files");
    link(victims_.path(), "lnk");
    refuses({"--cache", "lnk"}, "--cache lnk: holds other files");
    fs::create_directory(scratch_.path("cache"));
    ASSERT_EQ(build({"--cache", "cache", "--dry-run"}).code, 0);
    EXPECT_FALSE(scratch_.has("cache/CACHEDIR.TAG"));
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    EXPECT_TRUE(scratch_.read("cache/CACHEDIR.TAG").starts_with("Signature: 8a477f597d28d172789f06886806bc55\n"));
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    scratch_.write("cache/libtex-cache", "libtex-cache 9\n");
    refuses({"--cache", "cache"}, "is a cache of another version");
}

// A BIL file is two files: the header counts as the input does.
TEST_F(BuildFiles, TheHeaderOfABilIsReadAndNeverReplaced) {
    std::string heights;
    for (int k = 0; k < 2 * 64; ++k) heights += static_cast<char>(k * k % 11);
    const std::string header = "NROWS 8\nNCOLS 8\nNBITS 16\nPIXELTYPE SIGNEDINT\nBYTEORDER ";
    scratch_.write("dem.bil", heights);
    scratch_.write("dem.hdr", header + "I\n");
    write_rule("match = \"dem.bil\"\nname = \"out/dem_n.png\"\n");
    ASSERT_EQ(build({"--depfile", "d"}).code, 0);
    EXPECT_NE(scratch_.read("d").find("dem.hdr"), std::string::npos);
    const std::string first = scratch_.read("out/dem_n.png");
    EXPECT_NE(build().out.find("\"current\":1"), std::string::npos);
    scratch_.write("dem.hdr", header + "M\n");
    const Ran again = build();
    EXPECT_NE(again.out.find("dem.hdr changed"), std::string::npos) << again.out;
    EXPECT_NE(scratch_.read("out/dem_n.png"), first);
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"dem.bil\"\nname = \"dem.hdr\"\n"
                   "steps = [ { bake = { container = \"png\" } } ]\n");
    refuses({}, "the output dem.hdr of dem.bil is dem.hdr, which belongs to dem.bil");
}

TEST_F(BuildFiles, NothingButEntriesIsRemovedFromACache) {
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    ASSERT_EQ(entries().size(), 5u);
    const std::string name = "cache/ab/" + std::string(62, 'c');
    const std::string foreign[] = {"cache/notes.txt", "cache/ab/notes.txt", "cache/ab/" + std::string(64, 'a'),
                                   "cache/notes/" + std::string(64, 'b'), name + "AB"};
    for (const std::string& file : foreign) {
        fs::create_directories(fs::path(scratch_.path(file)).parent_path());
        scratch_.write(file, "libtex-cache 1 somebody's notes\n");
    }
    victims_.write(std::string(64, 'e'), "libtex-cache 3 nobody may remove this\n");
    link(victim(), "cache/ab/ab" + std::string(62, 'd'));
    link(victims_.path(), "cache/ee");
    ASSERT_EQ(build({"--cache", "cache", "--cache-size", "1"}).code, 0);
    EXPECT_EQ(entries().size(), 4u) << "the link, and notes with names like those of entries";
    for (const std::string& file : foreign) EXPECT_EQ(scratch_.read(file), "libtex-cache 1 somebody's notes\n") << file;
    EXPECT_TRUE(victims_.has(std::string(64, 'e')));
    EXPECT_TRUE(scratch_.has("cache/CACHEDIR.TAG") && scratch_.has("cache/libtex-cache"));
}

TEST_F(BuildFiles, ALinkInACacheIsNeitherReadNorWrittenThrough) {
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    const auto first = outputs();
    for (const std::string& entry : entries()) {
        fs::remove(scratch_.path(entry));
        link(victim(), entry);
    }
    fs::remove_all(scratch_.path("out"));
    EXPECT_EQ(run(scratch_, "build-normals", {"--cache", "cache", "--no-sync"}).out,
              "3 made, 0 up to date, 0 from the cache (5 damaged entries repaired)\n");
    EXPECT_EQ(outputs(), first);
    for (const std::string& entry : entries()) EXPECT_FALSE(fs::is_symlink(scratch_.path(entry))) << entry;
    // A link in the place of a folder of entries.
    for (const std::string& entry : entries()) {
        const fs::path folder = fs::path(scratch_.path(entry)).parent_path();
        if (fs::is_symlink(folder)) continue;
        fs::remove_all(folder);
        fs::create_directory_symlink(victims_.path(), folder);
    }
    fs::remove_all(scratch_.path("out"));
    EXPECT_EQ(build({"--cache", "cache"}).code, 0);
    EXPECT_EQ(outputs(), first);
    EXPECT_EQ(victims_.list().size(), 1u);
}

TEST_F(BuildFiles, AnEntryOfAnotherKeyIsDamaged) {
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    const auto first = outputs();
    const std::vector<std::string> names = entries();
    const std::string last = scratch_.read(names.back());
    for (std::size_t k = names.size() - 1; k > 0; --k) scratch_.write(names[k], scratch_.read(names[k - 1]));
    scratch_.write(names.front(), last);
    fs::remove_all(scratch_.path("out"));
    fs::remove(scratch_.path(".normals.toml.state"));
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    EXPECT_EQ(outputs(), first);
}

TEST_F(BuildFiles, AnOutputIsNoInputUnderAnotherName) {
    link("art", "lnk");
    write_rule("match = \"art/*.png\"\nname = \"lnk/{stem}.png\"\n");
    refuses({}, "the output lnk/wall_h.png of art/wall_h.png is the input art/wall_h.png");
    write_rule("match = \"art/*.png\"\nout-dir = \"lnk\"\nname = \"{stem}.png\"\n");
    refuses({}, "is the input art/wall_h.png");
    write_rule("match = \"art/*.png\"\nout-dir = \"" + scratch_.path("art") + "\"\nname = \"{stem}.png\"\n");
    refuses({}, "is the input art/wall_h.png");
    write_rule("match = \"art/*.png\"\nname = \"out/{stem}.png\"\n");
    link(scratch_.path("art/wall_h.png"), "out/wall_h.png");
    refuses({}, "the output out/wall_h.png of art/wall_h.png is the input art/wall_h.png");
    fs::remove(scratch_.path("out/wall_h.png"));
    fs::create_hard_link(scratch_.path("art/wall_h.png"), scratch_.path("out/wall_h.png"));
    refuses({}, "is the input art/wall_h.png");
    fs::remove_all(scratch_.path("out"));
    // An input that is a link: neither the link nor the file behind it may be replaced.
    fs::rename(scratch_.path("art/wall_h.png"), scratch_.path("store.png"));
    link("../store.png", "art/wall_h.png");
    write_rule("match = \"art/*.png\"\nname = \"store.png\"\n");
    refuses({}, "is the input art/wall_h.png");
    write_rule("match = \"art/*.png\"\nname = \"lnk/wall_h.png\"\n");
    refuses({}, "is the input art/wall_h.png");
    // A file that a rule reads, but no input.
    link("shared", "s");
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"art/sub/*\"\nname = \"s/grain.png\"\n"
                   "steps = [ { bake = {} }, { blend = { detail = \"shared/grain.png\" } } ]\n");
    refuses({}, "is shared/grain.png, which rule 1 reads");
}

TEST_F(BuildFiles, TwoOutputsAreNoOneFile) {
    for (const char* const folder : {"a", "b", "c"}) fs::create_directory(scratch_.path(folder));
    scratch_.add_sample("ramp.png", "a/x.png");
    scratch_.add_sample("waves.png", "b/x.png");
    fs::create_directory(scratch_.path("out"));
    link(scratch_.path("out"), "a/made");
    link("../out", "b/made");
    write_rule("match = \"?/*.png\"\nname = \"{dir}/made/{stem}.dds\"\n");
    const Ran ran = build();
    EXPECT_EQ(ran.code, 4) << ran.err;
    EXPECT_NE(ran.err.find("a/x.png and b/x.png have the same output"), std::string::npos) << ran.err;
    EXPECT_FALSE(scratch_.has("out/x.dds"));
    // One file for each level of one texture, and a file of another that has the name of a level.
    scratch_.add_sample("ramp.png", "c/y_3.png");
    scratch_.add_sample("ramp.png", "c/y.png");
    scratch_.write(
        "normals.toml",
        "version = 1\n[[rule]]\nmatch = \"c/y.png\"\nname = \"out/{stem}_{level}.png\"\nsteps = [ { bake = {} "
        "} ]\n[[rule]]\nmatch = \"c/*.png\"\nname = \"out/{stem}.png\"\nsteps = [ { bake = {} } ]\n");
    refuses({}, "c/y.png and c/y_3.png have the same output out/y_3.png, by the rules 1 and 2");
}

TEST_F(BuildFiles, ADocumentIsNoOtherFileOfTheRun) {
    ASSERT_EQ(build().code, 0);
    link("normals.toml", "lnk.toml");
    refuses({"--plan", "normals.toml"}, "--plan: normals.toml is the manifest");
    refuses({"--plan", "lnk.toml"}, "--plan: lnk.toml is the manifest");
    refuses({"--plan", "art/wall_h.png"}, "--plan: art/wall_h.png is the input art/wall_h.png");
    refuses({"--plan", "out/art/wall_n.dds"}, "--plan: out/art/wall_n.dds is an output of art/wall_h.png");
    refuses({"--plan", ".normals.toml.state"}, "is the file of the state of the build");
    refuses({"--depfile", "art/../normals.toml"}, "--depfile: art/../normals.toml is the manifest");
    refuses({"--depfile", "shared/grain.png"}, "is the input shared/grain.png");
    refuses({"--depfile", "out/shared/grain.dds"}, "is an output of shared/grain.png");
    refuses({"--depfile", scratch_.path(".normals.toml.state")}, "is the file of the state of the build");
    ASSERT_EQ(build({"--plan", "plan.jsonl"}).code, 0);
    for (const char* const file : {"plan.jsonl", "normals.toml", "art/wall_h.png", "out/art/wall_n.dds"})
        refuses({"--plan", "plan.jsonl", "--shard", "1/1", "--report", file}, fmt::format("--report: {} is", file));
    refuses({"--plan", "plan.jsonl", "--shard", "1/1", "--report", "r", "--depfile", "r"}, "is the file of --report");
    // What the run keeps for itself is not written through links, and does not replace what is no state.
    for (const bool is_link : {false, true}) {
        fs::remove(scratch_.path(".normals.toml.state"));
        if (is_link) {
            link(victim(), ".normals.toml.state");
        } else {
            scratch_.write(".normals.toml.state", "somebody's notes\n");
        }
        const Ran ran = build();
        EXPECT_EQ(ran.code, 3);
        EXPECT_NE(ran.err.find(".normals.toml.state: is not a file of build-normals"), std::string::npos) << ran.err;
    }
    link(victim(), "r.jsonl");
    link(victim(), ".q.jsonl.state");
    fs::remove(scratch_.path(".normals.toml.state"));
    ASSERT_EQ(build({"--plan", "plan.jsonl", "--shard", "1/1", "--report", "r.jsonl"}).code, 0);
    EXPECT_FALSE(fs::is_symlink(scratch_.path("r.jsonl")));
    EXPECT_EQ(build({"--plan", "plan.jsonl", "--shard", "1/1", "--report", "q.jsonl"}).code, 3);
}

TEST_F(BuildFiles, AnOutputThatIsALinkIsReplacedAndItsTargetStays) {
    link(victim(), "out/shared/grain.dds");
    ASSERT_EQ(build().code, 0);
    EXPECT_FALSE(fs::is_symlink(scratch_.path("out/shared/grain.dds")));
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("current"), 3u);
}

// An input that is replaced every 3 ms never stays the same while it is read.
TEST_F(BuildFiles, OldOutputsStayIfAnInputChangesWhileItIsRead) {
    const std::string contents[] = {scratch_.read("art/wall_h.png"), scratch_.read("shared/grain.png")};
    write_rule(
        "match = \"swapped.png\"\nname = \"out/{stem}.dds\"\noutputs = [ {}, { format = \"bc5\", name = "
        "\"out/{stem}.ktx2\" } ]\n");
    scratch_.add_sample("hemisphere.png", "swapped.png");
    ASSERT_EQ(build().code, 0);
    const auto old = outputs();
    ASSERT_EQ(old.size(), 2u);
    std::map<std::string, std::vector<std::string>> right;
    for (const auto& [name, bytes] : old) right[name].push_back(bytes);
    for (const std::string& content : contents) {
        scratch_.write("swapped.png", content);
        ASSERT_EQ(build().code, 0);
        for (const auto& [name, bytes] : outputs()) right[name].push_back(bytes);
    }
    std::atomic<bool> is_done{false};
    std::thread editor([&] {
        for (int k = 0; !is_done; k = 1 - k) {
            scratch_.write("new.tmp", contents[k]);
            fs::rename(scratch_.path("new.tmp"), scratch_.path("swapped.png"));
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    });
    for (int k = 0; k < 25; ++k) {
        fs::remove(scratch_.path(".normals.toml.state"));
        for (const auto& [name, bytes] : old) scratch_.write(name, bytes);
        const Ran ran = build();
        const auto now = outputs();
        if (ran.code == 3) {
            EXPECT_EQ(now, old) << ran.err;
        }
        for (const auto& [name, bytes] : now)
            EXPECT_NE(std::find(right[name].begin(), right[name].end(), bytes), right[name].end()) << name;
    }
    is_done = true;
    editor.join();
}

TEST_F(BuildFiles, PruningRemovesWhatWasMadeAndIsMadeNoMore) {
    // A rule that reads what an older rule made.
    ASSERT_EQ(build().code, 0);
    // Rules of names that were given up, which make nothing.
    const std::string old =
        "[[rule]]\nmatch = \"shared/*.png\"\nexclude = \"**/*\"\nout-dir = \"out\"\nsteps = [ { bake = {} } ]\n"
        "[[rule]]\nmatch = \"art/**/*_h.png\"\nexclude = \"**/*\"\nout-dir = \"out\"\nsteps = [ { bake = {} } ]\n"
        "name = \"{dir}/{stem:-_h}_n.dds\"\n"
        "[[rule]]\nmatch = \"out/shared/*.dds\"\nexclude = \"**/*\"\nsteps = [ { pack = {} } ]\n"
        "name = \"made/{stem}.dds\"\n";
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"out/shared/*.dds\"\nsteps = [ { pack = {} } ]\n"
                   "name = \"made/{stem}.dds\"\n" +
                       old);
    const Ran ran = build({"--prune"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.err.find("out/shared/grain.dds is not removed: this run reads it"), std::string::npos) << ran.err;
    EXPECT_TRUE(scratch_.has("out/shared/grain.dds"));
    EXPECT_FALSE(scratch_.has("out/art/wall_n.dds"));
    EXPECT_TRUE(scratch_.has("made/grain.dds"));
    // The folder has moved, and a link with the old name leads to it.
    fs::rename(scratch_.path("made"), scratch_.path("moved"));
    fs::create_directory_symlink("moved", scratch_.path("made"));
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"out/shared/*.dds\"\nsteps = [ { pack = {} } ]\n"
                   "name = \"moved/{stem}.dds\"\n" +
                       old);
    EXPECT_EQ(build({"--prune"}).code, 0);
    EXPECT_TRUE(scratch_.has("moved/grain.dds"));
    // A link that somebody has put in the place of an output is not ours.
    fs::rename(scratch_.path("moved/grain.dds"), scratch_.path("kept.dds"));
    fs::create_symlink("../kept.dds", scratch_.path("moved/grain.dds"));
    write_rule("match = \"shared/*.png\"\nname = \"last/{stem}.dds\"\n");
    EXPECT_EQ(build({"--prune"}).code, 0);
    EXPECT_TRUE(fs::is_symlink(scratch_.path("moved/grain.dds")));
}

TEST_F(BuildFiles, PruningRemovesLevelsThatATextureHasNoMore) {
    write_rule("match = \"x.png\"\nname = \"out/{stem}_{level}.png\"\n");
    scratch_.add_sample("bricks.png", "x.png");
    ASSERT_EQ(build().code, 0);
    const std::size_t before = outputs().size();
    fs::remove(scratch_.path("x.png"));
    scratch_.add_sample("ramp.png", "x.png");
    ASSERT_EQ(build({"--prune"}).code, 0);
    EXPECT_LT(outputs().size(), before);
    EXPECT_EQ(outputs().count(fmt::format("out/x_{}.png", outputs().size() - 1)), 1u);
    fs::remove(scratch_.path("x.png"));
    scratch_.add_sample("bricks.png", "x.png");
    ASSERT_EQ(build({"--prune"}).code, 0);
    EXPECT_EQ(outputs().size(), before);
}

// A run fails after some levels of the new contents have taken their place. The old contents come back: the state must
// not take that mixture for what they make.
TEST_F(BuildFiles, LevelsOfDifferentContentsAreMadeAgain) {
    fs::create_directory(scratch_.path("in"));
    scratch_.add_sample("ramp.png", "in/x.png");
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"in/x.png\"\nname = \"out/{stem}_{level}.png\"\nsteps = [ { "
                   "bake = {} } ]\n");
    ASSERT_EQ(build().code, 0);
    const auto expected = outputs();
    const std::string last = fmt::format("out/x_{}.png", expected.size() - 1);
    fs::rename(scratch_.path("in/x.png"), scratch_.path("before.png"));
    scratch_.add_sample("hemisphere.png", "in/x.png");
    fs::rename(scratch_.path(last), scratch_.path("level.png"));
    fs::create_directories(scratch_.path(last + "/in the way"));
    ASSERT_NE(build().code, 0);
    EXPECT_NE(scratch_.read("out/x_0.png"), expected.at("out/x_0.png"));
    fs::remove_all(scratch_.path(last));
    fs::rename(scratch_.path("level.png"), scratch_.path(last));
    fs::rename(scratch_.path("before.png"), scratch_.path("in/x.png"));
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("made"), 1u);
    EXPECT_TRUE(outputs() == expected);
}

TEST_F(BuildFiles, SettingsAreReadNoFurtherThanTheirLimit) {
    for (const char* const program : {"build-normals", "check-normals"}) {
        std::vector<std::string> arguments = {"/dev/zero"};
        if (std::string(program) == "check-normals") arguments = {"--config", "/dev/zero", "art/wall_h.png"};
        const Ran ran = run(scratch_, program, arguments);
        EXPECT_EQ(ran.code, 2);
        EXPECT_NE(ran.err.find("/dev/zero: has more than 1048576 bytes"), std::string::npos) << ran.err;
        EXPECT_LT(ran.peak_bytes, std::int64_t{64} << 20);
    }
}

}  // namespace tex::cli
