// SPDX-License-Identifier: Apache-2.0
// build-normals makes what is not up to date, and no more.

#include <chrono>
#include <filesystem>
#include <map>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "cli/texture_tree.h"

namespace tex::cli {

class BuildNormals : public TextureTree {};

TEST_F(BuildNormals, MakesWhatTheCommandsMakeOneAfterTheOther) {
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("made"), 3u);
    const Ran ran =
        shell(scratch_,
              "set -e; bake-normals shared/grain.png -o g.dds --bumpiness 2\n"
              "bake-normals art/wall_h.png -o 1.exr --bumpiness 4 --format float\n"
              "blend-normals 1.exr -o 2.exr --detail g.dds --tiling 3 --format float --quiet\n"
              "mip-normals 2.exr -o n.dds; mip-normals 2.exr -o ue.ktx2 --format bc5 --y down\n"
              "cmp g.dds out/shared/grain.dds; cmp n.dds out/art/wall_n.dds; cmp ue.ktx2 out/art/wall_ue.ktx2\n");
    EXPECT_EQ(ran.code, 0) << ran.out << ran.err;
    EXPECT_TRUE(scratch_.has("out/art/sub/floor_n.dds"));
    EXPECT_FALSE(scratch_.has("out/art/wip"));
}

// A run of hours shows what it does: each line is printed when its texture is done, and a summary when the run ends.
TEST_F(BuildNormals, JsonHasALineForEachTextureWhenItIsDoneAndASummary) {
    const auto last = [](const Ran& ran) { return nlohmann::json::parse(lines_of(ran.out).back()); };
    EXPECT_EQ(last(build()), nlohmann::json::parse(R"({"schema":1,"made":3,"cached":0,"current":0,"failed":0,
                                                       "untried":0,"removed":0,"without_rule":0,
                                                       "interrupted":false})"));
    scratch_.write("art/wall_h.png", "damaged");
    const auto summary = last(build());
    EXPECT_EQ(summary["current"], 2);
    EXPECT_EQ(summary["failed"], 1);
    // The largest file is made first, after the detail map that it needs.
    scratch_.add_sample("bricks.png", "art/z_h.png");
    fs::remove(scratch_.path(".normals.toml.state"));
    const Ran ran = build({"--threads", "1"});
    EXPECT_EQ(nlohmann::json::parse(lines_of(ran.out)[0])["input"], "shared/grain.png");
    EXPECT_EQ(nlohmann::json::parse(lines_of(ran.out)[1])["input"], "art/z_h.png");
}

TEST_F(BuildNormals, MakesNothingTwice) {
    ASSERT_EQ(build().code, 0);
    const auto first = outputs();
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("current"), 3u);
    // A checkout gives all files new times.
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    ASSERT_EQ(shell(scratch_, "touch art/*.png art/sub/* shared/*; cp -r . ../copy; rm -r ../copy").code, 0);
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("current"), 3u);
    // The state may be lost: then everything is made again, with the same bytes.
    fs::remove(scratch_.path(".normals.toml.state"));
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("made"), 3u);
    EXPECT_EQ(outputs(), first);
    scratch_.write(".normals.toml.state", "build-normals state 1\ndamaged");
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("made"), 3u);
}

TEST_F(BuildNormals, ContentsDecideAndNotTimes) {
    ASSERT_EQ(build().code, 0);
    const auto old = fs::last_write_time(scratch_.path("art/wall_h.png")) - std::chrono::hours(1);
    fs::remove(scratch_.path("art/wall_h.png"));
    scratch_.add_sample("hemisphere.png", "art/wall_h.png");
    fs::last_write_time(scratch_.path("art/wall_h.png"), old);
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(done_["art/wall_h.png"], "made");
    EXPECT_EQ(count("current"), 2u);
    // A file that options name.
    fs::remove(scratch_.path("shared/grain.png"));
    scratch_.add_sample("hemisphere.png", "shared/grain.png");
    ASSERT_EQ(build({"--dry-run"}).code, 0);
    EXPECT_EQ(count("stale"), 3u);
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("made"), 3u);
}

TEST_F(BuildNormals, AnEditOfOneRuleMakesItsMatches) {
    ASSERT_EQ(build().code, 0);
    std::string manifest = kManifest;
    manifest.replace(manifest.find("tiling = 3"), 10, "tiling = 5");
    scratch_.write("normals.toml", "# a comment\n" + manifest);
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("made"), 2u);
    EXPECT_EQ(done_["shared/grain.png"], "current");
    // One more output leaves the others alone.
    const auto before = fs::last_write_time(scratch_.path("out/art/wall_n.dds"));
    manifest.replace(manifest.find("{}, {"), 5, "{}, { name = \"{dir}/{stem}.exr\" }, {");
    scratch_.write("normals.toml", manifest);
    ASSERT_EQ(build().code, 0);
    EXPECT_TRUE(scratch_.has("out/art/wall_h.exr"));
    EXPECT_EQ(fs::last_write_time(scratch_.path("out/art/wall_n.dds")), before);
}

TEST_F(BuildNormals, SaysWhichSettingOrFileHasChanged) {
    std::map<std::string, nlohmann::json> lines;
    const auto rebuild = [&](const std::vector<std::string>& options) {
        lines.clear();
        const Ran ran = build(options);
        EXPECT_EQ(ran.code, 0) << ran.err;
        for (const std::string& line : lines_of(ran.out)) {
            const auto json = nlohmann::json::parse(line);
            if (json.contains("input")) lines[json["input"].get<std::string>()] = json;
        }
    };
    rebuild({});
    EXPECT_EQ(lines["art/wall_h.png"]["why"], "is new");
    EXPECT_FALSE(lines["art/wall_h.png"].contains("changes"));
    std::string manifest = kManifest;
    const auto edit = [&](const std::string& from, const std::string& to) {
        manifest.replace(manifest.find(from), from.size(), to);
        scratch_.write("normals.toml", manifest);
    };
    edit("tiling = 3", "tiling = 5");
    rebuild({});
    EXPECT_EQ(lines["art/wall_h.png"]["why"], "tiling: 3 to 5");
    EXPECT_EQ(lines["art/wall_h.png"]["changes"],
              nlohmann::json::parse(R"([{"setting":"blend tiling","from":"3","to":"5"}])"));
    // An option that comes, one that goes, and one more step.
    edit("tiling = 5", "strength = 0.5");
    edit("{ mip = {} }", "{ mip = { fade = \"2,4\" } }");
    rebuild({"--dry-run"});
    EXPECT_EQ(lines["art/wall_h.png"]["why"],
              "strength: default to 0.5; fade: default to 2,4; tiling: 5 to 1,1 (default)");
    edit("{ bake = { bumpiness = 4 } }", "{ bake = { bumpiness = 4 } }, { scale = { scale = 2 } }");
    rebuild({});
    EXPECT_NE(
        lines["art/wall_h.png"]["why"].get<std::string>().find("steps: bake, blend, mip to bake, scale, blend, mip"),
        std::string::npos);
    // A file that many textures read, and an input.
    fs::remove(scratch_.path("shared/grain.png"));
    scratch_.add_sample("hemisphere.png", "shared/grain.png");
    rebuild({});
    EXPECT_EQ(lines["shared/grain.png"]["why"], "shared/grain.png changed");
    EXPECT_EQ(lines["art/wall_h.png"]["why"], "out/shared/grain.dds changed");
    EXPECT_EQ(lines["art/wall_h.png"]["changes"], nlohmann::json::parse(R"([{"file":"out/shared/grain.dds"}])"));
}

TEST_F(BuildNormals, AFullDiskIsReportedOnce) {
    for (int k = 0; k < 12; ++k) scratch_.add_sample("ramp.png", fmt::format("art/more{}_h.png", k));
    Setting setting;
    setting.environment = {"LD_PRELOAD=" TEX_BINARY_DIR "/faults.so", "TEX_FAULT_FULL=3"};
    for (const char* output : {"--json", "--threads=4"}) {
        fs::remove_all(scratch_.path("out"));
        fs::remove(scratch_.path(".normals.toml.state"));
        const Ran ran = run(scratch_, "build-normals", {"--no-sync", output}, setting);
        EXPECT_EQ(ran.code, 3);
        std::vector<std::string> errors;
        for (const std::string& line : lines_of(ran.err)) {
            if (line.find("error: ") != std::string::npos) errors.push_back(line);
        }
        ASSERT_EQ(errors.size(), 2u) << ran.err;
        EXPECT_NE(errors[0].find("no space left on the disk"), std::string::npos);
        EXPECT_NE(errors[1].find("no space is left, so the run stops here; "), std::string::npos);
        EXPECT_NE(errors[1].find(" of 15 files are done"), std::string::npos);
        if (std::string_view(output) != "--json") continue;
        const auto summary = nlohmann::json::parse(lines_of(ran.out).back());
        EXPECT_GT(summary["untried"], 5);
        EXPECT_EQ(summary["untried"].get<int>() + summary["made"].get<int>() + summary["failed"].get<int>(), 15);
    }
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(outputs().size(), 1u + 2u * 14u);
}

TEST_F(BuildNormals, LostAndChangedOutputsAreMadeAgain) {
    ASSERT_EQ(build().code, 0);
    const auto first = outputs();
    fs::remove(scratch_.path("out/art/wall_ue.ktx2"));
    scratch_.write("out/art/sub/floor_n.dds", "changed");
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("made"), 2u);
    EXPECT_EQ(outputs(), first);
}

TEST_F(BuildNormals, PruneRemovesOutputsOfVanishedInputsAndNothingElseDoes) {
    ASSERT_EQ(build().code, 0);
    fs::remove(scratch_.path("art/wall_h.png"));
    scratch_.write("out/art/mine.dds", "not made here");
    ASSERT_EQ(build().code, 0);
    EXPECT_TRUE(scratch_.has("out/art/wall_n.dds"));
    const auto summary = [&](const std::string& option) {
        return run(scratch_, "build-normals", {"--prune", "--no-sync", option}).out;
    };
    EXPECT_EQ(summary("--dry-run"),
              "remove out/art/wall_n.dds\nremove out/art/wall_ue.ktx2\n0 to make, 2 up to date, 2 to remove\n");
    EXPECT_TRUE(scratch_.has("out/art/wall_n.dds"));
    // With --json, all lines are JSON.
    const Ran listed = run(scratch_, "build-normals", {"--prune", "--no-sync", "--dry-run", "--json"});
    std::vector<std::string> obsolete;
    for (const std::string& line : lines_of(listed.out)) {
        const auto json = nlohmann::json::parse(line, nullptr, false);
        ASSERT_FALSE(json.is_discarded()) << line;
        EXPECT_EQ(json["schema"], 1) << line;
        if (json.value("status", "") == "obsolete") obsolete.push_back(json["output"].dump());
    }
    EXPECT_EQ(obsolete, (std::vector<std::string>{R"(["out/art/wall_n.dds"])", R"(["out/art/wall_ue.ktx2"])"}));
    EXPECT_EQ(nlohmann::json::parse(lines_of(listed.out).back())["removed"], 2);
    // A file that something else has changed is kept, and does not count.
    const std::string made = scratch_.read("out/art/wall_ue.ktx2");
    scratch_.write("out/art/wall_ue.ktx2", "changed");
    EXPECT_EQ(summary("--dry-run"), "remove out/art/wall_n.dds\n0 to make, 2 up to date, 1 to remove\n");
    scratch_.write("out/art/wall_ue.ktx2", made);
    EXPECT_EQ(summary("--threads=1"), "0 made, 2 up to date, 2 removed\n");
    EXPECT_FALSE(scratch_.has("out/art/wall_n.dds"));
    EXPECT_FALSE(scratch_.has("out/art/wall_ue.ktx2"));
    EXPECT_TRUE(scratch_.has("out/art/mine.dds"));
    EXPECT_TRUE(scratch_.has("out/art/sub/floor_n.dds"));
}

TEST_F(BuildNormals, OneBadFileFailsAlone) {
    scratch_.write("art/broken_h.png", "no picture");
    fs::create_symlink("nowhere", scratch_.path("art/gone_h.png"));
    scratch_.add_sample("ramp.png", "art/twin_h.png");
    scratch_.add_sample("ramp.png", "art/twin_h.tif");  // a PNG, but the name counts
    scratch_.add_sample("ramp.png", "art/WALL_h.png");
    const Ran ran = build();
    EXPECT_EQ(ran.code, 4);
    EXPECT_EQ(count("failed"), 6u) << ran.err;
    EXPECT_EQ(count("made"), 2u);
    EXPECT_NE(ran.err.find("art/broken_h.png: "), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("art/twin_h.png and art/twin_h.tif have the same output out/art/twin_n.dds; rename or "
                           "exclude one"),
              std::string::npos)
        << ran.err;
    EXPECT_NE(ran.err.find("differ only in the case of letters, out/art/wall_n.dds"), std::string::npos) << ran.err;
    EXPECT_FALSE(scratch_.has("out/art/broken_n.dds"));
    ASSERT_EQ(build().code, 4);
    EXPECT_EQ(count("current"), 2u);
    // What needs a file that cannot be made fails with a sentence that says so.
    scratch_.write("shared/grain.png", "no picture");
    const Ran all = build();
    EXPECT_EQ(all.code, 4);
    EXPECT_NE(all.err.find("needs out/shared/grain.dds, which could not be made"), std::string::npos) << all.err;
}

TEST_F(BuildNormals, OddNamesAreOrdinary) {
    const std::vector<std::string> names = {
        "quo'te\".png", "new\nline.png", "bytes\xff\x01.png", "$(x) %41;#.png", std::string(200, 'l') + ".png",
        "-o.png"};
    fs::create_directory(scratch_.path("odd"));
    for (const std::string& name : names) scratch_.add_sample("ramp.png", "odd/" + name);
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"odd/*.png\"\nname = \"made/{stem}.dds\"\nsteps = [ { "
                   "bake = {} } ]\n");
    const Ran ran = build();
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(count("made"), names.size());
    for (const std::string& name : names)
        EXPECT_TRUE(scratch_.has("made/" + name.substr(0, name.size() - 4) + ".dds")) << name;
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("current"), names.size());
}

TEST_F(BuildNormals, MistakesAreFoundBeforeAnythingIsWritten) {
    const std::string rule = "[[rule]]\nmatch = \"art/*_h.png\"\nsteps = [ { bake = {} } ]\n";
    const struct {
        std::string text;
        const char* error;
    } mistakes[] = {
        {rule + "name = \"same.dds\"\n[[rule]]\nmatch = \"shared/*\"\nname = \"same.dds\"\nsteps = [ { bake = {} } ]\n",
         "line 6, column 1: art/wall_h.png and shared/grain.png have the same output same.dds, by the rules 1 and 2"},
        {rule + "name = \"shared/grain.png\"\n[[rule]]\nmatch = \"shared/*\"\nsteps = [ { bake = {} } ]\n",
         "line 2, column 1: the output shared/grain.png of art/wall_h.png is the input shared/grain.png"},
        {rule + "outputs = [ {}, {} ]\n",
         "two outputs of art/wall_h.png are one file, art/wall_h.dds; give each a name"},
        {"[[rule]]\nmatch = \"art/*.png\"\nsteps = [ { bake = {} }, { blend = { detail = \"art/wall_h.dds\" } } ]\n",
         "line 2, column 1: rules need each other's outputs: rule 1 needs 1"},
        {rule + "out-dir = \"../x\"\n",
         "line 5, column 11: out-dir: ../x leads out of the folder of the manifest; --root sets another folder"},
        {"[defaults]\nout-dir = \"a/../../x\"\n" + rule, "line 3, column 11: out-dir: a/../../x leads out"},
        {rule + "name = \"../{stem}.dds\"\n", "name: ../name.dds leads out of the folder of the manifest"},
    };
    for (const auto& mistake : mistakes) {
        scratch_.write("normals.toml", "version = 1\n" + mistake.text);
        const auto before = scratch_.list();
        const Ran ran = build();
        EXPECT_EQ(ran.code, 2);
        EXPECT_NE(ran.err.find(std::string("build-normals: error: normals.toml: ")), std::string::npos) << ran.err;
        EXPECT_NE(ran.err.find(mistake.error), std::string::npos) << ran.err;
        EXPECT_EQ(lines_of(ran.err).size(), 1u) << ran.err;
        EXPECT_EQ(scratch_.list(), before);
    }
    EXPECT_EQ(build({"none.toml"}).code, 3);
    EXPECT_EQ(build({"a", "b"}).code, 2);
}

TEST_F(BuildNormals, ANameWithoutExtensionGetsThatOfTheEngine) {
    scratch_.write("normals.toml", R"(version = 1
[defaults]
out-dir = "out"
[[rule]]
match = "art/wall_h.png"
steps = [ { bake = {} } ]
outputs = [ { name = "{engine}/{stem}_n", for = "godot" }, { for = "bevy", name = "{stem}" }, { format = "bc5" } ]
)");
    const Ran ran = build();
    EXPECT_EQ(ran.code, 0) << ran.err;
    for (const char* made : {"out/godot/wall_h_n.png", "out/wall_h.ktx2", "out/art/wall_h.dds"})
        EXPECT_TRUE(scratch_.has(made)) << made;
    EXPECT_EQ(run(scratch_, "build-normals", {"--dry-run"}).out, "0 to make, 1 up to date\n");
}

TEST_F(BuildNormals, PathsAreRelativeToTheManifest) {
    const Scratch elsewhere;
    const Ran ran = run(elsewhere, "build-normals", {scratch_.path("normals.toml"), "--no-sync", "--quiet"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_TRUE(scratch_.has("out/art/wall_n.dds"));
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("current"), 3u) << "names in the state are relative, too";
    EXPECT_TRUE(elsewhere.list().empty());
}

TEST_F(BuildNormals, EveryNumberOfThreadsMakesTheSameBytes) {
    std::map<std::string, std::string> first;
    for (const char* threads : {"1", "2", "8"}) {
        fs::remove_all(scratch_.path("out"));
        ASSERT_EQ(build({"--threads", threads, "--memory", "1"}).code, 0);
        if (first.empty()) first = outputs();
        EXPECT_EQ(outputs(), first);
    }
}

TEST_F(BuildNormals, ReadOnlyOutputsGetARemedy) {
    ASSERT_EQ(build().code, 0);
    std::string manifest = kManifest;
    manifest.replace(manifest.find("bumpiness = 2"), 13, "bumpiness = 3");
    scratch_.write("normals.toml", manifest);
    fs::permissions(scratch_.path("out/shared/grain.dds"), fs::perms::owner_read);
    // The superuser may replace read-only files.
    const std::string as_nobody =
        "chown -R 65534 . && setpriv --reuid=65534 --regid=65534 --clear-groups "
        "--inh-caps=-all,+dac_read_search --ambient-caps=-all,+dac_read_search ";
    const Ran ran = shell(scratch_, (geteuid() == 0 ? as_nobody : std::string()) + "build-normals --quiet --no-sync");
    EXPECT_EQ(ran.code, 3) << "also of the textures that need it";
    EXPECT_NE(
        ran.err.find("out/shared/grain.dds: permission denied; make it writable (chmod u+w, p4 edit) or remove it"),
        std::string::npos)
        << ran.err;
}

TEST_F(BuildNormals, ACheckThatFailsKeepsTheOldOutput) {
    const std::string rule =
        "version = 1\n[[rule]]\nmatch = \"art/*_h.png\"\nname = \"out/{stem}.dds\"\nsteps = [ { bake = "
        "{ bumpiness = 9 } } ]\n";
    scratch_.write("normals.toml", rule + "check = { require = [\"mips=full\", \"format=dxt5nm\"], max-p999 = 30 }\n");
    ASSERT_EQ(build().code, 0);
    const auto first = outputs();
    EXPECT_EQ(first.size(), 1u);
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("current"), 1u);
    scratch_.write("normals.toml", rule + "check = { require = \"format=bc5\", max-p999 = 0.001 }\n");
    const Ran ran = build();
    EXPECT_EQ(ran.code, 1);
    EXPECT_EQ(count("refused"), 1u);
    EXPECT_NE(ran.err.find("error: out/wall_h.dds, made from art/wall_h.png (normals.toml, line "), std::string::npos)
        << ran.err;
    EXPECT_NE(ran.err.find("level 0: p99.9 "), std::string::npos) << ran.err;
    EXPECT_EQ(outputs(), first) << "the old output stays, and no other file";
    // What needs a texture that is refused is refused, too.
    scratch_.write("normals.toml", rule + "check = { require = \"format=bc5\" }\n[[rule]]\nmatch = \"shared/*\"\n" +
                                       "name = \"out/g.exr\"\nsteps = [ { bake = {} }, { blend = { detail = "
                                       "\"out/wall_h.dds\" } } ]\n");
    const Ran both = build();
    EXPECT_EQ(both.code, 1);
    EXPECT_EQ(count("refused"), 2u) << both.err;
    EXPECT_NE(both.err.find("shared/grain.png: needs out/wall_h.dds, which could not be made"), std::string::npos);
    // The direction of y and the layout are those that were packed, although a DDS does not state them.
    scratch_.write("normals.toml", rule + "outputs = [ { y = \"down\" } ]\ncheck = { max-mean = 2 }\n");
    EXPECT_EQ(build().code, 0);
}

TEST_F(BuildNormals, WarnsAsTheCommandsDo) {
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"art/wall_h.png\"\nname = \"{stem}.dds\"\nsteps = [ { bake = { "
                   "bumpiness = 4000 } } ]\n");
    const Ran alone = run(scratch_, "bake-normals", {"art/wall_h.png", "-o", "a.dds", "--bumpiness", "4000"});
    const std::size_t at = alone.err.find("art/wall_h.png: ");
    ASSERT_NE(at, std::string::npos) << alone.err;
    EXPECT_NE(alone.err.find("texels are steeper than dxt5nm can hold"), std::string::npos) << alone.err;
    EXPECT_NE(build().err.find(alone.err.substr(at)), std::string::npos) << alone.err;
}

TEST_F(BuildNormals, OutputVersionCanBePinned) {
    scratch_.write("normals.toml", std::string("output-version = 1\n") + kManifest);
    EXPECT_EQ(build().code, 0);
    scratch_.write("normals.toml", std::string("output-version = 999\n") + kManifest);
    const Ran ran = build();
    EXPECT_EQ(ran.code, 2);
    EXPECT_NE(ran.err.find("output-version = 999, but this program makes version 2"), std::string::npos) << ran.err;
}

}  // namespace tex::cli
