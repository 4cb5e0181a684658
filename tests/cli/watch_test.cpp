// SPDX-License-Identifier: Apache-2.0
// build-normals --watch builds what is saved.

#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <iostream>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/meshes.h"
#include "cli/program.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;
using WatchClock = std::chrono::steady_clock;

constexpr const char* kWatched = R"(version = 1
[defaults]
out-dir = "out"
[[rule]]
match = "art/**/*_h.png"
name = "{dir}/{stem:-_h}_n.dds"
steps = [ { bake = { bumpiness = 4 } } ]
)";

}  // namespace

class BuildNormalsWatch : public testing::Test {
protected:
    BuildNormalsWatch() {
        scratch_.write("normals.toml", kWatched);
        fs::create_directories(scratch_.path("art/sub"));
        scratch_.add_sample("ramp.png", "art/wall_h.png");
        scratch_.add_sample("ramp.png", "art/sub/floor_h.png");
    }

    // Waits until `done` returns true. A machine under load may take long, but not forever.
    static bool within_seconds(const std::function<bool()>& done, int seconds = 20) {
        const auto begun = WatchClock::now();
        while (!done()) {
            if (WatchClock::now() - begun > std::chrono::seconds(seconds)) return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return true;
    }
    static bool prints(const Background& builder, const std::string& text, int seconds = 20) {
        return within_seconds([&] { return builder.out().find(text) != std::string::npos; }, seconds);
    }
    static bool complains(const Background& builder, const std::string& text) {
        return within_seconds([&] { return builder.err().find(text) != std::string::npos; });
    }
    // How often a pass has ended.
    static std::size_t passes(const Background& builder) {
        std::size_t count = 0;
        for (const std::string& line : lines_of(builder.out())) count += line.ends_with(" up to date") ? 1u : 0u;
        return count;
    }
    [[nodiscard]] std::string made_of(const std::string& sample, const std::string& bumpiness = "4") const {
        const Scratch other;
        other.add_sample(sample, "a.png");
        EXPECT_EQ(run(other, "bake-normals", {"a.png", "-o", "a.dds", "--bumpiness", bumpiness}).code, 0);
        return other.read("a.dds");
    }
    // Saves and waits until the output is what it should be. Prints how long that took.
    void save(const std::string& way, const std::function<void()>& write, const std::string& output,
              const std::string& expected) const {
        const auto begun = WatchClock::now();
        write();
        ASSERT_TRUE(within_seconds([&] { return scratch_.has(output) && scratch_.read(output) == expected; })) << way;
        const auto took = std::chrono::duration_cast<std::chrono::milliseconds>(WatchClock::now() - begun).count();
        std::cout << fmt::format("{}: {} ms\n", way, took);
        EXPECT_LT(took, 5000);
    }
    static int ended(Background& builder, int signal) {
        const auto begun = WatchClock::now();
        builder.send(signal);
        const Ran ran = builder.wait();
        // Nothing is printed while it waits. On a machine under load it may still build.
        const std::string said = without_notes(ran.err);
        EXPECT_TRUE(said.empty() || said.starts_with("build-normals: error: interrupted by ")) << said;
        EXPECT_LT(WatchClock::now() - begun, std::chrono::seconds(5));
        return ran.code;
    }

    Scratch scratch_;
};

TEST_F(BuildNormalsWatch, EveryWayOfSavingBuilds) {
    Background builder(scratch_, "build-normals", {"--watch", "--no-sync"});
    ASSERT_TRUE(prints(builder, "2 made, 0 up to date\nwatching "));
    const Scratch elsewhere;
    for (const char* sample : {"ramp.png", "waves.png", "hemisphere.png", "bricks.png"})
        elsewhere.add_sample(sample, sample);
    const std::string wall = scratch_.path("art/wall_h.png"), output = "out/art/wall_n.dds";
    save(
        "write in place", [&] { scratch_.write("art/wall_h.png", elsewhere.read("waves.png")); }, output,
        made_of("waves.png"));
    save(
        "write a temporary file, then rename it",
        [&] {
            scratch_.write("art/.wall.tmp", elsewhere.read("hemisphere.png"));
            fs::rename(scratch_.path("art/.wall.tmp"), wall);
        },
        output, made_of("hemisphere.png"));
    save(
        "rename the old file, then write a new one",
        [&] {
            fs::rename(wall, wall + "~");
            scratch_.write("art/wall_h.png", elsewhere.read("ramp.png"));
        },
        output, made_of("ramp.png"));
    save(
        "remove the old file, then link a new one",
        [&] {
            fs::remove(wall);
            fs::create_hard_link(elsewhere.path("waves.png"), wall);
        },
        output, made_of("waves.png"));
    save(
        "a new file in a new folder",
        [&] {
            fs::create_directories(scratch_.path("art/new/deep"));
            scratch_.write("art/new/deep/x_h.png", elsewhere.read("bricks.png"));
        },
        "out/art/new/deep/x_n.dds", made_of("bricks.png"));
    save(
        "a folder that is moved here",
        [&] {
            fs::create_directory(scratch_.path("later"));
            scratch_.write("later/y_h.png", elsewhere.read("waves.png"));
            fs::rename(scratch_.path("later"), scratch_.path("art/later"));
        },
        "out/art/later/y_n.dds", made_of("waves.png"));
    save(
        "after a folder was renamed", [&] { fs::rename(scratch_.path("art/later"), scratch_.path("art/renamed")); },
        "out/art/renamed/y_n.dds", made_of("waves.png"));
    save(
        "a file in it", [&] { scratch_.write("art/renamed/y_h.png", elsewhere.read("ramp.png")); },
        "out/art/renamed/y_n.dds", made_of("ramp.png"));
    EXPECT_TRUE(prints(builder, "art/wall_h.png -> out/art/wall_n.dds\n1 made, 0 up to date\n"));
    EXPECT_EQ(ended(builder, SIGINT), 128 + SIGINT);
}

TEST_F(BuildNormalsWatch, OutputsAndOtherFilesDoNotWakeIt) {
    // Outputs beside the inputs, in folders that the pattern reaches, and a cache there.
    std::string manifest = kWatched;
    manifest.replace(manifest.find("out-dir = \"out\""), 15, "");
    manifest.replace(manifest.find("art/**/*_h.png"), 14, "**/*_h.png");
    manifest.replace(manifest.find("{dir}/"), 6, "{dir}/made/{dir}/");
    scratch_.write("normals.toml", manifest);
    Background builder(scratch_, "build-normals", {"--watch", "--no-sync", "--cache", "cache"});
    ASSERT_TRUE(prints(builder, "\nwatching "));
    scratch_.write("art/notes.txt", "a note");
    scratch_.write("art/.wall_h.png.swp", "an editor's file");
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    EXPECT_EQ(lines_of(builder.out()).size(), 4u) << builder.out();
    const Scratch elsewhere;
    elsewhere.add_sample("waves.png", "waves.png");
    save(
        "write in place", [&] { scratch_.write("art/wall_h.png", elsewhere.read("waves.png")); },
        "art/made/art/wall_n.dds", made_of("waves.png"));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    EXPECT_EQ(lines_of(builder.out()).size(), 6u) << builder.out();
    EXPECT_EQ(ended(builder, SIGTERM), 128 + SIGTERM);
}

TEST_F(BuildNormalsWatch, TheManifestIsReadAgainAndItsMistakesWait) {
    scratch_.write("normals.toml", "version = 1\n[[rul]]\n");
    Background builder(scratch_, "build-normals", {"--watch", "--no-sync"});
    ASSERT_TRUE(complains(builder, "normals.toml: line 2, column 3: "));
    save(
        "the manifest", [&] { scratch_.write("normals.toml", kWatched); }, "out/art/wall_n.dds", made_of("ramp.png"));
    std::string manifest = kWatched;
    manifest.replace(manifest.find("bumpiness = 4"), 13, "bumpyness = 4");
    scratch_.write("normals.toml", manifest);
    ASSERT_TRUE(complains(builder, "did you mean bumpiness?"));
    manifest.replace(manifest.find("bumpyness = 4"), 13, "bumpiness = 7");
    scratch_.write("new.toml", manifest);
    save(
        "the manifest, renamed", [&] { fs::rename(scratch_.path("new.toml"), scratch_.path("normals.toml")); },
        "out/art/wall_n.dds", made_of("ramp.png", "7"));
    fs::remove(scratch_.path("normals.toml"));
    ASSERT_TRUE(complains(builder, "normals.toml: no such file or directory"));
    save(
        "a manifest that comes back", [&] { scratch_.write("normals.toml", kWatched); }, "out/art/wall_n.dds",
        made_of("ramp.png"));
    builder.send(SIGINT);
    EXPECT_EQ(builder.wait().code, 128 + SIGINT);
    EXPECT_EQ(run(scratch_, "build-normals", {"--watch", "none.toml"}).code, 3) << "a name that is not there";
}

TEST_F(BuildNormalsWatch, ATextureThatFailsStaysWatched) {
    scratch_.write("art/wall_h.png", "no picture");
    Background builder(scratch_, "build-normals", {"--watch", "--no-sync"});
    ASSERT_TRUE(complains(builder, "art/wall_h.png: "));
    ASSERT_TRUE(prints(builder, "1 made, 0 up to date, 1 failed\n"));
    scratch_.add_sample("waves.png", "waves.png");
    save(
        "a repaired file", [&] { fs::rename(scratch_.path("waves.png"), scratch_.path("art/wall_h.png")); },
        "out/art/wall_n.dds", made_of("waves.png"));
    scratch_.write("art/wall_h.png", "no picture");
    ASSERT_TRUE(prints(builder, "0 made, 0 up to date, 1 failed\n"));
    EXPECT_EQ(scratch_.read("out/art/wall_n.dds"), made_of("waves.png"));
    builder.send(SIGINT);
    EXPECT_EQ(builder.wait().code, 128 + SIGINT);
}

TEST_F(BuildNormalsWatch, FilesThatOptionsNameAreWatched) {
    const Scratch masks;
    masks.add_sample("waves.png", "mask.png");
    fs::create_symlink(masks.path("mask.png"), scratch_.path("mask.png"));
    scratch_.write("normals.toml", fmt::format(R"(version = 1
[[rule]]
match = "grain/*.png"
name = "out/{{stem}}.exr"
steps = [ {{ bake = {{ bumpiness = 20 }} }} ]
[[rule]]
match = "art/*_h.png"
name = "out/{{stem}}.png"
steps = [ {{ bake = {{ bumpiness = 20 }} }}, {{ blend = {{ detail = "out/g.exr", mask = "mask.png" }} }} ]
)"));
    fs::create_directory(scratch_.path("grain"));
    scratch_.add_sample("waves.png", "grain/g.png");
    Background builder(scratch_, "build-normals", {"--watch", "--no-sync"});
    ASSERT_TRUE(prints(builder, "2 made, 0 up to date\n"));
    masks.add_sample("ramp.png", "ramp.png");
    masks.write("mask.png", masks.read("ramp.png"));  // the file behind the link
    EXPECT_TRUE(prints(builder, "art/wall_h.png -> out/wall_h.png\n1 made, 1 up to date\n"));
    scratch_.write("grain/g.png", masks.read("ramp.png"));  // another rule's input, whose output is needed
    EXPECT_TRUE(within_seconds([&] { return passes(builder) == 3; }));
    EXPECT_TRUE(
        builder.out().ends_with("art/wall_h.png -> out/wall_h.png\ngrain/g.png -> out/g.exr\n2 made, 0 up to date\n"))
        << builder.out();
    masks.add_sample("hemisphere.png", "other.png");
    scratch_.write("art/wall_h.png", masks.read("other.png"));  // an input whose rule needs another texture
    EXPECT_TRUE(within_seconds([&] { return passes(builder) == 4; })) << builder.out();
    EXPECT_TRUE(builder.out().ends_with("art/wall_h.png -> out/wall_h.png\n1 made, 1 up to date\n")) << builder.out();
    EXPECT_EQ(ended(builder, SIGHUP), 128 + SIGHUP);
    const std::string watched = scratch_.read("out/wall_h.png");
    fs::remove_all(scratch_.path("out"));
    ASSERT_EQ(run(scratch_, "build-normals", {"--no-sync"}).code, 0);
    EXPECT_TRUE(scratch_.read("out/wall_h.png") == watched);
}

// A pattern names them, and several textures may share one, in a folder without inputs.
TEST_F(BuildNormalsWatch, FilesOfSomeTexturesAreWatched) {
    fs::create_directory(scratch_.path("ao"));
    scratch_.add_sample("ramp.png", "ao/wall_ao.png");
    scratch_.add_sample("ramp.png", "art/floor_h.png");
    scratch_.write("normals.toml", R"(version = 1
[[rule]]
match = "art/*_h.png"
name = "out/{stem}.png"
steps = [ { bake = { format = "rgba8", alpha = "ao/wall_ao.png:r", blue = "{dir}/../ao/{stem:-_h}_ao.png:R" } } ]
)");
    scratch_.add_sample("ramp.png", "ao/floor_ao.png");
    ASSERT_EQ(run(scratch_, "bake-normals", {"art/floor_h.png", "-o", "other.png", "--invert"}).code, 0);
    Background builder(scratch_, "build-normals", {"--watch", "--no-sync"});
    ASSERT_TRUE(prints(builder, "2 made, 0 up to date\n")) << builder.err();
    scratch_.write("ao/floor_ao.png", scratch_.read("other.png"));
    EXPECT_TRUE(prints(builder, "art/floor_h.png -> out/floor_h.png\n1 made, 0 up to date\n")) << builder.out();
    scratch_.write("ao/wall_ao.png", scratch_.read("other.png"));
    EXPECT_TRUE(within_seconds([&] { return passes(builder) == 3; })) << builder.out();
    EXPECT_TRUE(builder.out().ends_with("2 made, 0 up to date\n")) << builder.out();
    EXPECT_EQ(ended(builder, SIGINT), 128 + SIGINT);
}

TEST_F(BuildNormalsWatch, AMeshThatHasChangedIsReadAgain) {
    scratch_.write("sheet.obj", kSheetObj);
    scratch_.write("normals.toml", R"(version = 1
[[rule]]
match = "art/n.png"
exclude = "art/*_h.png"
name = "out/{stem}.exr"
steps = [ { convert = { mesh = "sheet.obj", to = "object" } } ]
)");
    ASSERT_EQ(run(scratch_, "bake-normals", {"art/wall_h.png", "-o", "art/n.png"}).code, 0);
    Background builder(scratch_, "build-normals", {"--watch", "--no-sync"});
    ASSERT_TRUE(prints(builder, "1 made, 0 up to date\n"));
    const std::string before = scratch_.read("out/n.exr");
    std::string bent = kSheetObj;
    bent.replace(bent.find("vn -0.3 -0.1 1"), 14, "vn -0.1 -0.8 1");
    scratch_.write("sheet.obj", bent);
    EXPECT_TRUE(within_seconds([&] { return passes(builder) == 2; }));
    EXPECT_EQ(ended(builder, SIGINT), 128 + SIGINT);
    const std::string watched = scratch_.read("out/n.exr");
    EXPECT_FALSE(watched == before);
    fs::remove_all(scratch_.path("out"));
    ASSERT_EQ(run(scratch_, "build-normals", {"--no-sync"}).code, 0);
    EXPECT_TRUE(scratch_.read("out/n.exr") == watched);
}

TEST_F(BuildNormalsWatch, AHighMeshThatHasChangedIsTransferredAgain) {
    scratch_.write("art/sheet_low.obj", kSheetObj);
    fs::create_directories(scratch_.path("sculpts"));
    scratch_.write("sculpts/sheet_high.obj", kSheetObj);
    scratch_.write("normals.toml", R"(version = 1
[[rule]]
match = "art/*_low.obj"
exclude = "art/*_h.png"
name = "out/{stem:-_low}_n.<UDIM>.png"
steps = [ { transfer = { high = "sculpts/{stem:-_low}_high.obj", extent = "32", height-out = "out/h.<UDIM>.exr" } } ]
)");
    Background builder(scratch_, "build-normals", {"--watch", "--no-sync"});
    ASSERT_TRUE(prints(builder, "1 made, 0 up to date\n"));
    const std::string before = scratch_.read("out/h.1001.exr");
    std::string bent = kSheetObj;
    bent.replace(bent.find("v 1 1 0.4"), 9, "v 1 1 0.5");
    scratch_.write("sculpts/sheet_high.obj", bent);
    EXPECT_TRUE(within_seconds([&] { return passes(builder) == 2; }));
    EXPECT_FALSE(scratch_.read("out/h.1001.exr") == before);
    // The low mesh gets another tile.
    scratch_.write("art/sheet_low.obj",
                   std::string(kSheetObj) + "vt 1.1 0.1\nvt 1.9 0.1\nvt 1.1 0.9\nf 1/10/1 2/11/2 5/12/5\n");
    EXPECT_TRUE(within_seconds([&] { return passes(builder) == 3; }));
    EXPECT_EQ(ended(builder, SIGINT), 128 + SIGINT);
    ASSERT_TRUE(scratch_.has("out/h.1002.exr"));
    const std::string watched = scratch_.read("out/h.1002.exr");
    EXPECT_EQ(run(scratch_, "build-normals", {"--no-sync"}).out, "0 made, 1 up to date\n");
    fs::remove_all(scratch_.path("out"));
    ASSERT_EQ(run(scratch_, "build-normals", {"--no-sync"}).code, 0);
    EXPECT_TRUE(scratch_.read("out/h.1002.exr") == watched);
}

// Every run with --json ends with a line that says so.
TEST_F(BuildNormalsWatch, JsonEndsWithALineOfTheInterruption) {
    Background builder(scratch_, "build-normals", {"--watch", "--no-sync", "--json"});
    ASSERT_TRUE(prints(builder, "\"interrupted\":false"));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    builder.send(SIGINT);
    const Ran ran = builder.wait();
    EXPECT_EQ(ran.code, 128 + SIGINT);
    const auto last = nlohmann::json::parse(lines_of(ran.out).back());
    EXPECT_EQ(last["interrupted"], true);
    EXPECT_EQ(last["made"], 0);
    EXPECT_EQ(last["untried"], 0);
}

TEST_F(BuildNormalsWatch, VanishedInputsArePruned) {
    Background builder(scratch_, "build-normals", {"--watch", "--no-sync", "--prune"});
    ASSERT_TRUE(prints(builder, "watching "));
    fs::remove(scratch_.path("art/wall_h.png"));
    EXPECT_TRUE(prints(builder, "0 made, 1 up to date, 1 removed\n"));
    EXPECT_FALSE(scratch_.has("out/art/wall_n.dds"));
    EXPECT_EQ(ended(builder, SIGINT), 128 + SIGINT);
    // What is known about the rest of the tree stays known.
    EXPECT_EQ(run(scratch_, "build-normals", {"--no-sync"}).out, "0 made, 1 up to date\n");
}

TEST_F(BuildNormalsWatch, ManySavesAtOnceEndRight) {
    Background builder(scratch_, "build-normals", {"--watch", "--no-sync", "--quiet"});
    ASSERT_TRUE(within_seconds([&] { return scratch_.has("out/art/sub/floor_n.dds"); }));
    const Scratch elsewhere;
    for (const char* sample : {"ramp.png", "waves.png"}) elsewhere.add_sample(sample, sample);
    for (int k = 0; k < 200; ++k) {
        scratch_.write(fmt::format("art/sub/m{}_h.png", k % 20),
                       elsewhere.read(k >= 180 || k % 3 == 0 ? "waves.png" : "ramp.png"));
        if (k % 10 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(7));
    }
    const std::string expected = made_of("waves.png");
    for (int k = 0; k < 20; ++k) {
        const std::string output = fmt::format("out/art/sub/m{}_n.dds", k);
        EXPECT_TRUE(within_seconds([&] { return scratch_.has(output) && scratch_.read(output) == expected; })) << k;
    }
    builder.send(SIGINT);
    EXPECT_EQ(builder.wait().code, 128 + SIGINT);
}

TEST_F(BuildNormalsWatch, LimitsOfTheSystemComeWithTheRemedy) {
    // Limits of a user namespace, because those of the system concern everybody.
    const auto limited = [&](const char* limit) {
        return shell(scratch_, fmt::format("unshare --user --map-root-user sh -c 'echo 0 >/proc/sys/user/{} || exit 99;"
                                           " build-normals --watch'",
                                           limit));
    };
    const Ran ran = limited("max_inotify_watches");
    if (ran.code == 99 || ran.err.find("unshare") != std::string::npos) GTEST_SKIP() << "no user namespaces here";
    EXPECT_EQ(ran.code, 3);
    EXPECT_NE(ran.err.find("raise fs.inotify.max_user_watches"), std::string::npos) << ran.err;
    EXPECT_EQ(lines_of(ran.err).size(), 1u) << ran.err;
    const Ran none = limited("max_inotify_instances");
    EXPECT_EQ(none.code, 3);
    EXPECT_NE(none.err.find("raise fs.inotify.max_user_instances"), std::string::npos) << none.err;
    EXPECT_FALSE(scratch_.has("out"));
}

TEST_F(BuildNormalsWatch, RefusesWhatDoesNotGoWithIt) {
    for (const char* other : {"--dry-run", "--explain=art/wall_h.png", "-"}) {
        const Ran ran = run(scratch_, "build-normals", {"--watch", other});
        EXPECT_EQ(ran.code, 2) << ran.err;
        EXPECT_NE(ran.err.find("--watch "), std::string::npos) << ran.err;
    }
}

}  // namespace tex::cli
