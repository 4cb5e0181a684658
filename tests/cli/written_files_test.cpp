// SPDX-License-Identifier: Apache-2.0
// Which options write files (Option::writes, "writes" in --help --json), and that build-normals makes outputs of all
// that a manifest can set: below out-dir, in the report, made again, cached and pruned.

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/meshes.h"
#include "cli/texture_tree.h"
#include "tree/manifest.h"
#include "tree/recipe.h"

namespace tex::cli {
namespace {

using Options = std::map<std::string, std::set<std::string>>;  // of each command

nlohmann::json help_of(const std::string& command) {
    return nlohmann::json::parse(run(Scratch(), command, {"--help", "--json"}).out);
}

// The options that write, as --help --json says.
Options written() {
    Options all;
    for (const std::string& command : commands()) {
        const nlohmann::json help = help_of(command);
        for (const auto& option : help["options"]) {
            if (option.value("writes", false)) all[command].insert(option["names"].back().get<std::string>());
        }
    }
    return all;
}

// Steps that together have every option that writes. Values begin with "w/".
struct Step {
    std::string step, match, name, settings;
};
const std::vector<Step> kSteps = {
    {"bake", "h.png", "n.png",
     R"(occlusion-out = "w/ao.png", sky-view-out = "w/sky.png", bent-out = "w/bent.png", )"
     R"(horizon-out = "w/hor.png", horizon-directions = 4, occlusion-directions = 4)"},
    {"integrate", "n.png", "h.png",
     R"(curvature-out = "w/c.png", curl-out = "w/curl.png", occlusion-out = "w/ao.png", sky-view-out = "w/sky.png", )"
     R"(bent-out = "w/bent.png", horizon-out = "w/hor.png", horizon-directions = 4, occlusion-directions = 4)"},
    {"mip", "n.png", "n.dds", R"(roughness-out = "w/r.dds")"},
    {"unpack", "t.png", "u.png", R"(swizzle = "rg", blue-out = "w/b.png", alpha-out = "w/a.png")"},
    {"unpack", "t.png", "u.png", R"(length-in = "occlusion", length-out = "w/l.png")"},
    {"transfer", "low.obj", "n.png",
     R"(extent = "32", high = "high.obj", high-color = "n.png", object-out = "w/o.exr", height-out = "w/h.exr", )"
     R"(position-out = "w/p.exr", occlusion-out = "w/ao.png", bent-out = "w/bent.png", thickness-out = "w/t.png", )"
     R"(color-out = "w/col.png", vertex-color-out = "w/v.png", missed-out = "w/m.png", id-out = "w/id.png", )"
     R"(rays-per-hit = 1)"},
};

class WrittenFiles : public TextureTree {
protected:
    WrittenFiles() {
        scratch_.add_sample("bricks.png", "h.png");
        scratch_.write("low.obj", kSheetObj);
        scratch_.write("high.obj", kSheetObj);
        shell(scratch_,
              "bake-normals h.png -o n.png --bumpiness 6 --no-sync --quiet; pack-normals n.png -o t.png --format rgba8 "
              "--alpha h.png --no-sync --quiet");
    }
    void write_rule(const std::string& rule) const {
        scratch_.write("normals.toml", "version = 1\n[[rule]]\nout-dir = \"out\"\n" + rule + "\n");
    }
    void write_mip(const std::string& roughness, const std::string& more = {}) const {
        write_rule("match = \"n.png\"\nname = \"{stem}.dds\"\nsteps = [ { mip = { roughness-out = \"" + roughness +
                   "\" } } ]\n" + more);
    }
    // What the report of the last run lists.
    [[nodiscard]] static std::set<std::string> listed(const Ran& ran) {
        std::set<std::string> files;
        for (const std::string& line : lines_of(ran.out)) {
            const auto json = nlohmann::json::parse(line, nullptr, false);
            if (!json.is_discarded() && json.contains("output"))
                for (const auto& file : json["output"]) files.insert(file.get<std::string>());
        }
        return files;
    }
    [[nodiscard]] std::set<std::string> made() const {
        std::set<std::string> files;
        for (const auto& [name, bytes] : outputs()) files.insert(name);
        return files;
    }
    void expect_known(const std::string& command, std::size_t files);
};

// The outputs of a rule are known in every way: the report, the state, the cache, --prune, the depfile.
void WrittenFiles::expect_known(const std::string& command, std::size_t files) {
    const auto before = scratch_.list();
    const Ran first = build({"--cache", "cache", "--depfile", "d"});
    ASSERT_EQ(first.code, 0) << command << ": " << first.err;
    const auto bytes = outputs();
    ASSERT_EQ(bytes.size(), files) << command;
    EXPECT_EQ(listed(first), made()) << command;
    std::set<std::string> own(before.begin(), before.end());
    for (const std::string& name : scratch_.list()) {
        const bool is_ours = name.starts_with("out") || name.starts_with("cache") || name.ends_with(".state");
        EXPECT_TRUE(is_ours || name == "d" || own.contains(name)) << command << " wrote " << name;
    }
    const std::string depfile = scratch_.read("d");
    for (const auto& [name, content] : bytes) {
        EXPECT_NE(depfile.find(name), std::string::npos) << command << ": " << name;
        fs::remove(scratch_.path(name));
        ASSERT_EQ(build().code, 0);
        EXPECT_EQ(outputs(), bytes) << command << ": " << name << " was removed";
    }
    fs::remove_all(scratch_.path("out"));
    fs::remove(scratch_.path(".normals.toml.state"));
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    EXPECT_EQ(count("cached"), 1u) << command;
    EXPECT_EQ(outputs(), bytes) << command << ": from the cache";
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("current"), 1u) << command;
}

}  // namespace

TEST_F(WrittenFiles, AnOptionWhoseHelpSaysSoIsInTheTable) {
    for (const std::string& command : commands()) {
        const nlohmann::json help = help_of(command);
        for (const auto& option : help["options"]) {
            if (!option.contains("value")) continue;
            const std::string name = option["names"].back(), text = option["text"];
            const bool is_file = option["type"] == "file" && option["value"] == "FILE";
            const bool says_so = name.ends_with("-out") || name.ends_with("-write") || text.starts_with("write ") ||
                                 text.starts_with("draw ") || text.starts_with("the output");
            EXPECT_EQ(option.value("writes", false), is_file && says_so) << command << " " << name;
        }
    }
}

// A new option that writes is a key of a manifest and stands in kSteps, or it is none.
TEST_F(WrittenFiles, EveryOneIsAnOutputOfTheManifestOrNoKey) {
    const Options all = written();
    EXPECT_GE(all.size(), commands().size());
    for (const std::string& step : step_names()) {
        for (const std::string& option : all.at(step + "-normals")) {
            const std::string key = option.substr(2);
            const auto has_it = [&](const Step& one) {
                return one.step == step && one.settings.find(key + " = \"w/") != std::string::npos;
            };
            if (std::any_of(kSteps.begin(), kSteps.end(), has_it)) continue;
            write_rule("match = \"n.png\"\nname = \"x.dds\"\nsteps = [ { " + step + " = { " + key + " = \"w\" } } ]");
            const Ran ran = build();
            EXPECT_EQ(ran.code, 2) << step << " " << option;
            EXPECT_NE(ran.err.find("has no such option here"), std::string::npos) << ran.err;
        }
    }
}

TEST_F(WrittenFiles, AreKnownToTheManifest) {
    for (const Step& one : kSteps) {
        fs::remove_all(scratch_.path("out"));
        fs::remove(scratch_.path(".normals.toml.state"));
        write_rule("match = \"" + one.match + "\"\nname = \"" + one.name + "\"\nsteps = [ { " + one.step + " = { " +
                   one.settings + " } } ]");
        const auto options = std::count(one.settings.begin(), one.settings.end(), '/');
        expect_known(one.step, static_cast<std::size_t>(options) + 1);
    }
}

TEST_F(WrittenFiles, StayBelowOutDir) {
    scratch_.write("art/keepme.dds", "precious");
    write_mip("art/keepme.dds");
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(scratch_.read("art/keepme.dds"), "precious");
    EXPECT_TRUE(scratch_.has("out/art/keepme.dds"));
    const Scratch elsewhere;
    write_mip(elsewhere.path("r.dds"));
    ASSERT_EQ(build().code, 0);
    EXPECT_TRUE(elsewhere.list().empty());
    write_mip("../../r.dds");
    const Ran ran = build();
    EXPECT_EQ(ran.code, 2);
    EXPECT_NE(ran.err.find("leads out of the folder of the manifest"), std::string::npos) << ran.err;
    // Here, too, {dir} and {stem} are those of the rule's input, whatever steps are before.
    write_rule(
        "match = \"art/*.png\"\nname = \"{dir}/{stem}.dds\"\nsteps = [ { bake = {} }, { mip = { roughness-out = "
        "\"{dir}/{stem}_{format}.ktx2\" } } ]");
    ASSERT_EQ(build().code, 0);
    EXPECT_TRUE(scratch_.has("out/art/wall_h_bc5.ktx2"));
    const Ran again = run(scratch_, "build-normals", {scratch_.path("normals.toml"), "--no-sync"});
    ASSERT_TRUE(again.out.starts_with("0 made, 1 up to date")) << again.out;
}

TEST_F(WrittenFiles, BelongToTheFirstOfSeveralOutputs) {
    write_mip("r_{level}.png\", mips = \"2", "outputs = [ {}, { name = \"{stem}_ue.ktx2\" } ]");
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    const auto bytes = outputs();
    ASSERT_EQ(run(scratch_, "mip-normals",
                  {"n.png", "-o", "n.dds", "--mips", "2", "--roughness-out", "hand_{level}.png", "--no-sync"})
                  .code,
              0);
    EXPECT_EQ(made(), (std::set<std::string>{"out/n.dds", "out/n_ue.ktx2", "out/r_0.png", "out/r_1.png"}));
    EXPECT_EQ(scratch_.read("out/n.dds"), scratch_.read("n.dds"));
    EXPECT_EQ(scratch_.read("out/r_1.png"), scratch_.read("hand_1.png"));
    fs::remove(scratch_.path("out/n_ue.ktx2"));
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(outputs(), bytes);
    fs::remove_all(scratch_.path("out"));
    ASSERT_EQ(build({"--cache", "cache"}).code, 0);
    EXPECT_EQ(count("cached"), 1u);
    EXPECT_EQ(outputs(), bytes);
}

TEST_F(WrittenFiles, WaitForTheCheck) {
    write_mip("r.dds", "check = { require = \"y=down\" }");
    EXPECT_EQ(build().code, 1);
    EXPECT_TRUE(outputs().empty());
    write_mip("r.dds", "check = { require = \"mips=full\" }");
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(outputs().size(), 2u);
    ASSERT_EQ(build().code, 0);
    EXPECT_EQ(count("current"), 1u);
    write_mip("r_{level}.png", "check = { require = \"mips=full\" }");
    EXPECT_EQ(build().code, 2);
}

TEST_F(WrittenFiles, AreOfTheLastStepAlone) {
    write_rule("match = \"t.png\"\nname = \"x.dds\"\nsteps = [ { unpack = { alpha-out = \"a.png\" } }, { mip = {} } ]");
    const Ran ran = build();
    EXPECT_EQ(ran.code, 2);
    EXPECT_NE(ran.err.find("alpha-out: only the last step can have it"), std::string::npos) << ran.err;
    EXPECT_EQ(run(scratch_, "unpack-normals", {"t.png", "-o", "u.png", "--alpha-out", "a_{level}.png"}).code, 2);
}

TEST_F(WrittenFiles, AreNoFilesThatTheRunReads) {
    for (const std::string victim : {"../n.png", "../t.png"}) {
        const std::string before = scratch_.read(victim.substr(3));
        write_rule("match = \"{n,t}.png\"\nname = \"{stem}.dds\"\nsteps = [ { mip = { roughness-out = \"" + victim +
                   "\" } } ]");
        EXPECT_NE(build().code, 0);
        EXPECT_EQ(scratch_.read(victim.substr(3)), before);
    }
}

}  // namespace tex::cli
