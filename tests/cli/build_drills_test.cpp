// SPDX-License-Identifier: Apache-2.0
// build-normals with a cache, with other builders, with files that change under it, and killed.

#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "cli/texture_tree.h"

namespace tex::cli {

class BuildDrills : public TextureTree {};

TEST_F(BuildDrills, ACloneWithAWarmCacheMakesNothing) {
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    EXPECT_EQ(count("made"), 3u);
    const auto first = outputs();
    fs::remove_all(scratch_.path("out"));
    fs::remove(scratch_.path(".normals.toml.state"));
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    EXPECT_EQ(count("cached"), 3u);
    EXPECT_EQ(outputs(), first);
    // A flipped bit is noticed and repaired.
    fs::remove_all(scratch_.path("out"));
    for (const std::string& name : scratch_.list()) {
        if (!name.starts_with("cache/") || fs::path(name).filename().string().size() != 64) continue;
        std::string entry = scratch_.read(name);
        entry[entry.size() / 2] = static_cast<char>(entry[entry.size() / 2] ^ 16);
        scratch_.write(name, entry);
    }
    const Ran repaired = run(scratch_, "build-normals", {"--cache", "cache", "--no-sync"});
    EXPECT_EQ(repaired.out, "3 made, 0 up to date, 0 from the cache (5 damaged entries repaired)\n");
    EXPECT_EQ(outputs(), first);
    fs::remove_all(scratch_.path("out"));
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    EXPECT_EQ(count("cached"), 3u);
    EXPECT_EQ(outputs(), first);
}

// A key names the contents that were there before the file was read. If the file is replaced in between, the cache must
// not keep what was made from the other contents.
TEST_F(BuildDrills, AnInputThatIsReplacedWhileItIsReadNeverReachesTheCache) {
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"swapped.png\"\nsteps = [ { bake = {} } ]\n"
                   "outputs = [ { name = \"out/{stem}.dds\" } ]\n");
    const std::string contents[] = {scratch_.read("art/wall_h.png"), scratch_.read("shared/grain.png")};
    std::string right[2];
    for (const int k : {0, 1}) {
        scratch_.write("swapped.png", contents[k]);
        ASSERT_EQ(build().code, 0);
        right[k] = scratch_.read("out/swapped.dds");
    }
    ASSERT_NE(right[0], right[1]);
    std::atomic<bool> is_done{false};
    std::thread editor([&] {
        for (int k = 0; !is_done; k = 1 - k) {
            scratch_.write("new.tmp", contents[k]);
            fs::rename(scratch_.path("new.tmp"), scratch_.path("swapped.png"));
        }
    });
    for (int run = 0; run < 40; ++run) {
        fs::remove(scratch_.path(".normals.toml.state"));
        build({"--cache", fmt::format("cache{}", run)});  // may fail, because the file changes again and again
    }
    is_done = true;
    editor.join();
    for (int run = 0; run < 40; ++run) {
        const std::string cache = fmt::format("cache{}", run);
        if (!fs::is_directory(scratch_.path(cache))) continue;
        for (const int k : {0, 1}) {
            scratch_.write("swapped.png", contents[k]);
            fs::remove(scratch_.path(".normals.toml.state"));
            EXPECT_EQ(build({"--cache", cache}).code, 0);
            EXPECT_EQ(scratch_.read("out/swapped.dds"), right[k]) << cache;
        }
    }
}

TEST_F(BuildDrills, TwoBuildersAtOnceDoNoHarm) {
    const Ran ran = shell(scratch_,
                          "build-normals --cache cache --no-sync & first=$!; build-normals --cache cache --no-sync & "
                          "wait $! && wait $first");
    EXPECT_EQ(ran.code, 0) << ran.err;
    const auto both = outputs();
    fs::remove_all(scratch_.path("out"));
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(outputs(), both);
}

TEST_F(BuildDrills, AKilledRunLeavesNothingThatTheNextDoesNotRepair) {
    for (int k = 0; k < 12; ++k) scratch_.add_sample("bricks.png", fmt::format("art/m{}_h.png", k));
    ASSERT_EQ(build().code, 0);
    const auto expected = outputs();
    for (int k = 0; k < 8; ++k) {
        fs::remove_all(scratch_.path("out"));
        Setting setting;
        setting.interrupt_after_ms = 5 + 17 * k;
        setting.signal = k % 4 == 3 ? SIGINT : SIGKILL;
        build({"--cache", "cache" + std::to_string(k % 2)}, setting);
        for (const auto& [name, contents] : outputs()) {
            if (!expected.contains(name)) continue;
            EXPECT_TRUE(contents == expected.at(name)) << name;
        }
        ASSERT_EQ(build({"--cache", "cache" + std::to_string(k % 2)}).code, 0);
        EXPECT_EQ(outputs(), expected);
    }
}

TEST_F(BuildDrills, LevelsCanHaveTheirOwnFiles) {
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"art/*_h.png\"\nname = \"out/{stem}_{level}.png\"\nsteps "
                   "= [ { bake = {} } ]\n");
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    EXPECT_TRUE(scratch_.has("out/wall_h_0.png"));
    EXPECT_TRUE(scratch_.has("out/wall_h_5.png"));
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("current"), 1u);
    fs::remove(scratch_.path("out/wall_h_3.png"));
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("made"), 1u);
    EXPECT_TRUE(scratch_.has("out/wall_h_3.png"));
    // The cache holds all levels.
    const auto first = outputs();
    fs::remove_all(scratch_.path("out"));
    fs::remove(scratch_.path(".normals.toml.state"));
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    EXPECT_EQ(count("cached"), 1u);
    EXPECT_TRUE(outputs() == first);
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("current"), 1u);
    // Equal settings with one file for all levels are another output, and neither takes the other's entries.
    scratch_.write(
        "normals.toml",
        "version = 1\n[[rule]]\nmatch = \"art/*_h.png\"\nname = \"out/{stem}.png\"\nsteps = [ { bake = {} } ]\n");
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    EXPECT_TRUE(scratch_.read("out/wall_h.png") == first.at("out/wall_h_0.png"));
    fs::remove_all(scratch_.path("out"));
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    EXPECT_TRUE(scratch_.read("out/wall_h.png") == first.at("out/wall_h_0.png"));
}

}  // namespace tex::cli
