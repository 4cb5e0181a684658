// SPDX-License-Identifier: Apache-2.0
// Names below --root, --update, and arguments in files.

#include <chrono>
#include <filesystem>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

}  // namespace

class TreeOfFiles : public testing::Test {
protected:
    TreeOfFiles() {
        for (const char* name : {"art/walls/brick_h.png", "art/walls/deep/tile_h.png", "art/top_h.png"}) {
            fs::create_directories(fs::path(scratch_.path(name)).parent_path());
            scratch_.add_sample("ramp.png", name);
        }
    }
    Ran bake(std::vector<std::string> arguments, const Setting& setting = {}) {
        arguments.insert(arguments.end(), {"--no-sync"});
        return run(scratch_, "bake-normals", arguments, setting);
    }
    // What --update does to each input: "made" or "current".
    std::string update(std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"--update", "--json"});
        const Ran ran = bake(arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        std::string all;
        for (const std::string& line : lines_of(ran.out))
            all += nlohmann::json::parse(line).value("status", std::string("?")) + " ";
        return all;
    }
    // File systems count time in ticks of some milliseconds.
    static void wait_for_a_tick() { std::this_thread::sleep_for(std::chrono::milliseconds(25)); }

    Scratch scratch_;
};

TEST_F(TreeOfFiles, RootRepeatsTheFoldersOfTheInputs) {
    const std::vector<std::string> inputs = {"art/walls/brick_h.png", "art/walls/deep/tile_h.png",
                                             scratch_.path("art/top_h.png")};
    const auto with = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), inputs.begin(), inputs.end());
        return bake(arguments);
    };
    Ran ran = with({"--root", "art", "--out-dir", "out"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    for (const char* name : {"out/walls/brick_h.dds", "out/walls/deep/tile_h.dds", "out/top_h.dds"})
        EXPECT_TRUE(scratch_.has(name)) << name;
    ran = with({"--root=./art/", "--out-dir", "two", "--name", "n/{dir}/{stem:-_h}_n.ktx2"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_TRUE(scratch_.has("two/n/walls/deep/tile_n.ktx2"));
    EXPECT_TRUE(scratch_.has("two/n/top_n.ktx2"));
    // Without --out-dir, the folders are made, too.
    ran = with({"--root", "art", "--name", "three/{dir}/{stem}.dds"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_TRUE(scratch_.has("three/walls/deep/tile_h.dds"));
    // Through a link, which the names do not show.
    fs::create_directory_symlink("art/walls", scratch_.path("link"));
    ran = bake({"link/brick_h.png", "--root", "art", "--out-dir", "four"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_TRUE(scratch_.has("four/walls/brick_h.dds"));
    Setting setting;
    setting.input = scratch_.read("art/top_h.png");
    EXPECT_EQ(bake({"-", "--root", "art", "--out-dir", "five", "--name", "{dir}/{stem}.dds"}, setting).code, 0);
    EXPECT_TRUE(scratch_.has("five/stdin.dds"));
}

TEST_F(TreeOfFiles, RootRefusesWhatItCannotDo) {
    const auto refuses = [&](const std::vector<std::string>& arguments, const char* part) {
        const auto before = scratch_.list();
        const Ran ran = bake(arguments);
        EXPECT_EQ(ran.code, 2);
        EXPECT_NE(ran.err.find(part), std::string::npos) << ran.err;
        EXPECT_EQ(scratch_.list(), before);
    };
    refuses({"art/top_h.png", "--root", "art/walls", "--out-dir", "out"}, "art/top_h.png is not in --root art/walls");
    refuses({"art/top_h.png", "--root", "art", "-o", "a.dds"}, "--output and --root contradict each other");
    refuses({"art/top_h.png", "--root", "art", "--out-dir", "out", "--name", "{stem}.dds"}, "does not contain {dir}");
}

TEST_F(TreeOfFiles, UpdateSkipsWhatIsNewer) {
    const std::vector<std::string> line = {
        "art/walls/brick_h.png", "art/top_h.png", "--root", "art", "--out-dir", "out"};
    wait_for_a_tick();
    EXPECT_EQ(update(line), "made made ");
    EXPECT_EQ(update(line), "current current ");
    wait_for_a_tick();
    scratch_.write("art/top_h.png", scratch_.read("art/top_h.png"));
    EXPECT_EQ(update(line), "current made ");
}

TEST_F(TreeOfFiles, UpdateNoticesOlderFilesAndDamagedOutputs) {
    wait_for_a_tick();
    const std::vector<std::string> line = {"art/top_h.png", "--out-dir", "out", "--name", "{stem}.dds"};
    EXPECT_EQ(update(line), "made ");
    EXPECT_EQ(update(line), "current ");
    const std::string first = scratch_.read("out/top_h.dds");
    wait_for_a_tick();
    const auto old = fs::last_write_time(scratch_.path("art/top_h.png")) - std::chrono::hours(24);
    fs::remove(scratch_.path("art/top_h.png"));
    scratch_.add_sample("waves.png", "art/top_h.png");
    fs::last_write_time(scratch_.path("art/top_h.png"), old);
    wait_for_a_tick();
    EXPECT_EQ(update(line), "made ") << "rsync and Perforce set mtimes back";
    EXPECT_NE(scratch_.read("out/top_h.dds"), first);
    EXPECT_EQ(update(line), "current ");
    scratch_.write("out/top_h.dds", "");
    EXPECT_EQ(update(line), "made ");
    fs::remove(scratch_.path("out/top_h.dds"));
    EXPECT_EQ(update(line), "made ");
    EXPECT_EQ(update({"art/top_h.png", "--out-dir", "out", "--name", "{stem}_{level}.png"}), "made ");
    EXPECT_EQ(update({"art/top_h.png", "--out-dir", "out", "--name", "{stem}_{level}.png"}), "made ");
    EXPECT_EQ(bake({"art/top_h.png", "-o", "-", "--container", "dds", "--update"}).code, 2);
}

TEST_F(TreeOfFiles, UpdateLooksAtFilesThatOptionsName) {
    scratch_.add_sample("ramp.png", "grain.png");
    ASSERT_EQ(bake({"grain.png", "-o", "grain.dds"}).code, 0);
    ASSERT_EQ(bake({"art/top_h.png", "-o", "base.dds"}).code, 0);
    wait_for_a_tick();
    const auto blend = [&] {
        const Ran ran = run(scratch_, "blend-normals",
                            {"base.dds", "--detail", "grain.dds", "--out-dir", "out", "--update", "--json", "--no-sync",
                             "--depfile", "out.d"});
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_EQ(scratch_.read("out.d"), "out/base.dds: \\\n  base.dds \\\n  grain.dds\n");
        return nlohmann::json::parse(ran.out).value("status", std::string());
    };
    EXPECT_EQ(blend(), "made");
    EXPECT_EQ(blend(), "current") << "and the depfile still names it";
    wait_for_a_tick();
    scratch_.write("grain.dds", scratch_.read("base.dds"));
    wait_for_a_tick();
    EXPECT_EQ(blend(), "made");
    EXPECT_EQ(blend(), "current");
}

TEST_F(TreeOfFiles, FilesHoldArguments) {
    scratch_.add_sample("ramp.png", "@odd name.png");
    scratch_.add_sample("ramp.png", "-dash.png");
    scratch_.write("args", "--out-dir\nout dir\n\n--format=bc5\n@odd name.png\n--\n-dash.png\n");
    const Ran ran = run(scratch_, "bake-normals", {"art/top_h.png", "@args", "--no-sync"});
    EXPECT_EQ(ran.code, 3) << "after the -- of the file, --no-sync is an input";
    for (const char* name : {"out dir/top_h.dds", "out dir/@odd name.dds", "out dir/-dash.dds"})
        EXPECT_TRUE(scratch_.has(name)) << name << ran.err;
    Setting setting;
    setting.input = std::string("art/top_h.png\0art/walls/brick_h.png\0", 36);
    EXPECT_EQ(bake({"--out-dir", "two", "@-"}, setting).code, 0);
    EXPECT_TRUE(scratch_.has("two/brick_h.dds"));
    EXPECT_EQ(bake({"./@odd name.png", "-o", "odd.dds"}).code, 0);
    EXPECT_EQ(run(scratch_, "bake-normals", {"-o", "odd2.dds", "--", "@odd name.png"}).code, 0);
    EXPECT_EQ(bake({"art/top_h.png", "-o", "@value.dds"}).code, 0);
    EXPECT_TRUE(scratch_.has("@value.dds"));
    for (const std::string& command : commands()) {
        const Ran gone = run(scratch_, command, {"@gone"});
        EXPECT_EQ(gone.code, 3) << command;
        EXPECT_EQ(gone.err, command + ": error: gone: no such file or directory\n");
        scratch_.write("help", "--version\n");
        EXPECT_EQ(run(scratch_, command, {"@help"}).code, 0) << command;
    }
    for (const char* other : {"-", "@-", "--files-from=-"}) {
        const Ran twice = bake({"@-", other, "--out-dir", "out"});
        EXPECT_EQ(twice.code, 2);
        EXPECT_NE(twice.err.find("standard input can only be read once"), std::string::npos) << twice.err;
    }
}

TEST_F(TreeOfFiles, ALongListOfArgumentsIsQuick) {
    std::string list;
    for (int k = 0; k < 200000; ++k) list += fmt::format("some/folder/texture{}.dds\n", k);
    scratch_.write("list", list);
    const Ran ran = run(scratch_, "compare-normals", {"@list"});
    EXPECT_EQ(ran.code, 2);
    EXPECT_EQ(ran.err, "compare-normals: error: two files are compared: A and B\n");
}

TEST_F(TreeOfFiles, DepfilesOfDocumentsAndOfAManifest) {
    ASSERT_EQ(bake({"art/top_h.png", "-o", "a.dds"}).code, 0);
    ASSERT_EQ(bake({"art/top_h.png", "-o", "b.exr"}).code, 0);
    scratch_.write("checks.toml", "");
    EXPECT_EQ(run(scratch_, "check-normals",
                  {"a.dds", "--config", "checks.toml", "--sarif", "s", "--junit", "j", "--depfile", "d"})
                  .code,
              0);
    EXPECT_EQ(scratch_.read("d"), "s j: \\\n  a.dds \\\n  checks.toml\n");
    EXPECT_EQ(run(scratch_, "check-normals", {"a.dds", "--depfile", "d"}).code, 2);
    EXPECT_EQ(run(scratch_, "compare-normals", {"a.dds", "b.exr", "--heatmap", "h.png", "--depfile", "d"}).code, 0);
    EXPECT_EQ(scratch_.read("d"), "h.png: \\\n  a.dds \\\n  b.exr\n");
    EXPECT_EQ(run(scratch_, "compare-normals", {"a.dds", "b.exr", "--depfile", "d"}).code, 2);
    fs::rename(scratch_.path("art/top_h.png"), scratch_.path("art/top_x.png"));
    scratch_.write("art/normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"walls/**/*_h.png\"\nname = \"out/{stem}.dds\"\nsteps = [ { bake = "
                   "{} }, { blend = { detail = \"out/grain.exr\" } } ]\n[[rule]]\nmatch = \"top_x.png\"\nname = "
                   "\"out/grain.exr\"\nsteps = [ { bake = {} } ]\n");
    for (int k = 0; k < 2; ++k) {
        const Ran ran = run(scratch_, "build-normals", {"art/normals.toml", "--no-sync", "--depfile", "d"});
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_EQ(
            scratch_.read("d"),
            "art/out/grain.exr: \\\n  art/top_x.png \\\n  art/normals.toml\n"
            "art/out/brick_h.dds: \\\n  art/walls/brick_h.png \\\n  art/normals.toml \\\n  art/out/grain.exr\n"
            "art/out/tile_h.dds: \\\n  art/walls/deep/tile_h.png \\\n  art/normals.toml \\\n  art/out/grain.exr\n");
    }
}

}  // namespace tex::cli
