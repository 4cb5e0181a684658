// SPDX-License-Identifier: Apache-2.0
// build-normals on farms: a plan, shards of it, and the reports of the shards.

#include <csignal>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/farm_tree.h"

namespace tex::cli {

class BuildNormalsFarm : public FarmTree {};

TEST_F(BuildNormalsFarm, APlanListsTexturesWithTheirCosts) {
    const Ran ran = build({"--plan", "plan.jsonl"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_TRUE(ran.out.starts_with("9 textures, ")) << ran.out;
    EXPECT_FALSE(scratch_.has("out"));
    EXPECT_FALSE(scratch_.has(".normals.toml.state"));
    const auto lines = lines_of(scratch_.read("plan.jsonl"));
    ASSERT_EQ(lines.size(), 10u);
    const auto head = nlohmann::json::parse(lines[0]);
    EXPECT_EQ(head["plan"], 1);
    EXPECT_EQ(head["tool"], TEX_VERSION);
    EXPECT_EQ(head["output-version"], 2);
    EXPECT_EQ(head["manifest"], "normals.toml");
    EXPECT_EQ(head["textures"], 9);
    EXPECT_EQ(head["manifest-sha256"].get<std::string>().size(), 64u);
    const auto wall = nlohmann::json::parse(lines[1]);
    EXPECT_EQ(wall["input"], "art/s0/m.png");
    EXPECT_EQ(wall["rule"], 3);
    EXPECT_EQ(wall["outputs"], nlohmann::json::parse(R"(["out/art/s0/m_n.dds", "out/art/s0/m_ue.ktx2"])"));
    EXPECT_EQ(wall["needs"], nlohmann::json::parse(R"(["shared/grain.png"])"));
    EXPECT_EQ(wall["bytes"], fs::file_size(scratch_.path("art/s0/m.png")));
    const Ran extent = run(scratch_, "bake-normals", {"art/s0/m.png", "-o", "m.dds", "--json", "--no-sync"});
    const auto texels = nlohmann::json::parse(extent.out)["extent"];
    EXPECT_EQ(wall["cost"], texels[0].get<int>() * texels[1].get<int>() * 2) << "once for each output";
    // It depends on nothing else.
    ASSERT_EQ(build({"--plan", "again.jsonl", "--threads", "1"}).code, 0);
    EXPECT_EQ(scratch_.read("again.jsonl"), scratch_.read("plan.jsonl"));
    EXPECT_EQ(build({"--plan", "-"}).out, scratch_.read("plan.jsonl"));
}

TEST_F(BuildNormalsFarm, ShardsTogetherMakeWhatOneRunMakes) {
    ASSERT_EQ(build().code, 0);
    const Files expected = outputs();
    ASSERT_EQ(expected.size(), 15u);
    for (const int shards : {1, 3, 7, 20}) {
        forget();
        plan_and_run(shards);
        EXPECT_EQ(outputs(), expected) << shards;
        EXPECT_FALSE(scratch_.has(".normals.toml.state")) << "shards share the state, so they do not write it";
        EXPECT_FALSE(scratch_.has("r/.1.jsonl.state"));
        const Ran merged = merge();
        EXPECT_EQ(merged.code, 0) << merged.err;
        EXPECT_EQ(merged.out + merged.err, "");
        EXPECT_EQ(build().out, "0 made, 9 up to date\n") << "the merge has recorded everything";
    }
}

TEST_F(BuildNormalsFarm, ShardsNeedNoSharedFolder) {
    ASSERT_EQ(build().code, 0);
    const Files expected = outputs();
    forget();
    ASSERT_EQ(build({"--plan", "plan.jsonl"}).code, 0);
    const Ran ran =
        shell(scratch_,
              "set -e; for k in 1 2 3; do mkdir -p m$k; cp -r art plain shared normals.toml plan.jsonl m$k\n"
              "(cd m$k; build-normals --plan plan.jsonl --shard $k/3 --report out/r/$k.jsonl --no-sync "
              "--quiet); cp -r m$k/out .; done; rm -r m?; mv out/r .");
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(outputs(), expected);
    EXPECT_EQ(merge().code, 0);
}

TEST_F(BuildNormalsFarm, MergeFindsWhatIsMissing) {
    plan_and_run(3);
    const Files expected = outputs();
    const int lost = shard_of("plain/bricks.png", 3);
    fs::remove(scratch_.path(fmt::format("r/{}.jsonl", lost)));
    const Ran missing = merge();
    EXPECT_EQ(missing.code, 1) << missing.err;
    EXPECT_EQ(missing.out, fmt::format("{}\n", lost));
    EXPECT_NE(missing.err.find(fmt::format("shard {} has not reported", lost)), std::string::npos) << missing.err;
    EXPECT_NE(missing.err.find(fmt::format("send these shards again: {}\n", lost)), std::string::npos) << missing.err;
    // A report that the shell's pattern does not find is one that is missing.
    EXPECT_EQ(merge({"none/*.jsonl"}).code, 3);
    // What is there already is not made again: the merge has recorded the rest.
    ASSERT_EQ(shard(lost, 3).code, 0);
    EXPECT_EQ(merge().code, 0);
    EXPECT_EQ(outputs(), expected);
    // An output that was lost or changed.
    scratch_.write("out/plain/bricks.dds", "changed");
    fs::remove(scratch_.path("out/art/s1/m_ue.ktx2"));
    const Ran changed = merge();
    EXPECT_EQ(changed.code, 1);
    EXPECT_NE(changed.err.find("plain/bricks.png: out/plain/bricks.dds is not what r/"), std::string::npos)
        << changed.err;
    EXPECT_NE(changed.err.find("out/art/s1/m_ue.ktx2 cannot be read: no such file"), std::string::npos) << changed.err;
    for (int k = 1; k <= 3; ++k) {
        if (fmt::format(",{},", changed.out.substr(0, changed.out.size() - 1)).find(fmt::format(",{},", k)) !=
            std::string::npos) {
            ASSERT_EQ(shard(k, 3).code, 0);
        }
    }
    EXPECT_EQ(merge().code, 0);
    EXPECT_EQ(outputs(), expected);
}

TEST_F(BuildNormalsFarm, MergeTellsWhatCanSucceedFromWhatCannot) {
    scratch_.write("plain/broken.png", "no picture");
    fs::create_symlink("nowhere", scratch_.path("plain/gone.png"));
    ASSERT_EQ(build({"--plan", "plan.jsonl"}).code, 0);
    for (int k = 1; k <= 2; ++k) static_cast<void>(shard(k, 2));
    const Ran ran = merge({"--json", "r/1.jsonl", "r/2.jsonl"});
    EXPECT_EQ(ran.code, 4) << ran.err;
    const auto lines = lines_of(ran.out);
    ASSERT_EQ(lines.size(), 3u) << ran.out;
    const auto broken = nlohmann::json::parse(lines[0]), gone = nlohmann::json::parse(lines[1]);
    EXPECT_EQ(broken["input"], "plain/broken.png");
    EXPECT_EQ(broken["status"], "failed");
    EXPECT_EQ(broken["again"], false);
    EXPECT_EQ(gone["input"], "plain/gone.png");
    EXPECT_EQ(gone["again"], true);
    const auto all = nlohmann::json::parse(lines[2]);
    EXPECT_EQ(all["done"], 9);
    EXPECT_EQ(all["textures"], 11);
    EXPECT_EQ(all["again"], nlohmann::json::array({gone["shard"]}));
    EXPECT_EQ(all["repeated"], 1) << "both shards needed the detail map";
    // What a report says cannot control the terminal.
    for (int k = 1; k <= 2; ++k) {
        std::string report = scratch_.read(fmt::format("r/{}.jsonl", k));
        const std::size_t at = report.find("\"reason\":\"");
        if (at == std::string::npos) continue;
        report.insert(at + 10, "\\u001b[2J");
        scratch_.write(fmt::format("r/{}.jsonl", k), report);
    }
    const Ran hostile = merge();
    EXPECT_EQ(hostile.err.find('\x1b'), std::string::npos);
    EXPECT_NE(hostile.err.find("[2J"), std::string::npos) << hostile.err;
    // What needs another texture fails with it, and is sent again with it.
    fs::remove(scratch_.path("plain/broken.png"));
    fs::remove(scratch_.path("plain/gone.png"));
    forget();
    ASSERT_EQ(build({"--plan", "plan.jsonl"}).code, 0);
    fs::rename(scratch_.path("shared/grain.png"), scratch_.path("aside.png"));
    for (int k = 1; k <= 2; ++k) EXPECT_EQ(shard(k, 2).code, 3);
    EXPECT_EQ(merge().out, "1,2\n");
    fs::rename(scratch_.path("aside.png"), scratch_.path("shared/grain.png"));
    for (int k = 1; k <= 2; ++k) ASSERT_EQ(shard(k, 2).code, 0);
    EXPECT_EQ(merge().code, 0);
}

TEST_F(BuildNormalsFarm, MergeFindsContradictionsAndDamage) {
    plan_and_run(2);
    ASSERT_EQ(merge().code, 0);
    std::string report = scratch_.read("r/1.jsonl");
    // A texture in another report, with another digest.
    const std::size_t at = report.find("\"sha256\":\"") + 10;
    report[at] = report[at] == '0' ? '1' : '0';
    scratch_.write("r/other.jsonl", report);
    const Ran ran = merge();
    EXPECT_EQ(ran.code, 4);
    EXPECT_EQ(ran.out, "1\n");
    EXPECT_NE(ran.err.find("r/1.jsonl and r/other.jsonl contradict each other: out/"), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("was made of the same contents and has different bytes"), std::string::npos) << ran.err;
    // The next run makes it again, because nobody knows which report is right.
    EXPECT_EQ(build().out, "1 made, 8 up to date\n");
    // A report that was cut off, and one that is none, are not used.
    scratch_.write("r/other.jsonl", report.substr(0, report.rfind('\n', report.size() - 2) + 1));
    const Ran cut = merge();
    EXPECT_EQ(cut.code, 4);
    EXPECT_NE(cut.err.find("r/other.jsonl: line 1: \"textures\" is not "), std::string::npos) << cut.err;
    scratch_.write("r/other.jsonl", "{}\n");
    EXPECT_NE(merge().err.find("r/other.jsonl: line 1: is no report of a shard; the report is not used"),
              std::string::npos);
    // Reports of different numbers of shards do not fit together.
    fs::remove(scratch_.path("r/other.jsonl"));
    ASSERT_EQ(shard(3, 5).code, 0);
    const Ran mixed = merge();
    EXPECT_EQ(mixed.code, 2);
    EXPECT_NE(mixed.err.find("r/1.jsonl is one of 2 shards, but r/3.jsonl is one of 5"), std::string::npos)
        << mixed.err;
    // Reports of another plan are left out.
    scratch_.write("plain/new.png", "x");
    ASSERT_EQ(build({"--plan", "plan.jsonl"}).code, 0);
    const Ran other = merge();
    EXPECT_EQ(other.code, 3);
    EXPECT_NE(other.err.find("r/1.jsonl is of another plan and is not used"), std::string::npos) << other.err;
}

TEST_F(BuildNormalsFarm, APlanThatNoLongerFitsIsRefused) {
    ASSERT_EQ(build({"--plan", "plan.jsonl"}).code, 0);
    const std::string plan = scratch_.read("plan.jsonl");
    scratch_.write("normals.toml", std::string("# edited\n") + kFarmManifest);
    const Ran edited = shard(1, 2);
    EXPECT_EQ(edited.code, 2);
    EXPECT_NE(edited.err.find("plan.jsonl was made for another text of normals.toml; make the plan again"),
              std::string::npos)
        << edited.err;
    EXPECT_EQ(merge({"r"}).code, 2);
    scratch_.write("normals.toml", kFarmManifest);
    const auto refuses = [&](const std::string& from, const std::string& to, const std::string& error) {
        std::string damaged = plan;
        damaged.replace(damaged.find(from), from.size(), to);
        scratch_.write("plan.jsonl", damaged);
        const Ran ran = shard(1, 1);
        EXPECT_EQ(ran.code, 2) << from;
        EXPECT_NE(ran.err.find("plan.jsonl: " + error), std::string::npos) << ran.err;
        EXPECT_FALSE(scratch_.has("out"));
        EXPECT_FALSE(scratch_.has("r"));
    };
    refuses("out/art/s0/m_n.dds", "../../etc/passwd", "line 2: the manifest makes other outputs of art/s0/m.png");
    refuses("art/s0/m.png\"", "art/s0/../../m.png\"", "line 2: the manifest makes other outputs of");
    refuses("\"rule\":3", "\"rule\":99", "line 2: the manifest makes other outputs of");
    refuses("\"plan\":1", "\"plan\":2", "line 1: a later version of build-normals has made this plan");
    refuses("\"textures\":9", "\"textures\":8", "line 1: \"textures\" is not 9");
    refuses("shared/grain.png\"]", "other\"]", "art/s0/m.png needs other, which is not in the plan");
    refuses("\"cost\"", "\"costs\"", "line 2: \"cost\" is missing");
    refuses(plan, "", "is empty; make the plan again");
    // A changed input is no reason to stop.
    scratch_.write("plan.jsonl", plan);
    fs::remove(scratch_.path("art/s2/m.png"));
    add("bricks.png", "art/s2/m.png");
    const Ran changed = shard(1, 1);
    EXPECT_EQ(changed.code, 0);
    EXPECT_NE(changed.err.find("1 inputs have changed since plan.jsonl was made, such as art/s2/m.png"),
              std::string::npos)
        << changed.err;
    EXPECT_EQ(merge().code, 0);
    EXPECT_EQ(build().out, "0 made, 9 up to date\n");
}

TEST_F(BuildNormalsFarm, TexturesThatCannotBeMadeAreNamedByThePlan) {
    add("ramp.png", "plain/twin.png");
    add("ramp.png", "plain/Twin.png");
    const Ran ran = build({"--plan", "plan.jsonl"});
    EXPECT_EQ(ran.code, 4);
    EXPECT_NE(ran.err.find("differ only in the case of letters"), std::string::npos) << ran.err;
    for (int k = 1; k <= 2; ++k) ASSERT_EQ(shard(k, 2).code, 0) << "others make what can be made";
    const Ran merged = merge();
    EXPECT_EQ(merged.code, 4);
    EXPECT_EQ(merged.out, "");
    EXPECT_NE(merged.err.find("not made: 2 of 11 textures; sending shards again would not help"), std::string::npos)
        << merged.err;
}

TEST_F(BuildNormalsFarm, AShardThatWasStoppedGoesOn) {
    for (int k = 0; k < 40; ++k) add("bricks.png", fmt::format("plain/more{}.png", k));
    ASSERT_EQ(build({"--plan", "plan.jsonl"}).code, 0);
    Setting setting;
    setting.signal = SIGTERM;  // what Slurm and Kubernetes send first
    Ran ran;
    for (setting.interrupt_after_ms = 40; setting.interrupt_after_ms < 5000; setting.interrupt_after_ms *= 2) {
        ran = run(scratch_, "build-normals",
                  {"--plan", "plan.jsonl", "--shard", "1/1", "--report", "r/1.jsonl", "--no-sync", "--threads", "1"},
                  setting);
        if (scratch_.has("r/1.jsonl")) return;  // it was too fast to be interrupted
        if (scratch_.has("r/.1.jsonl.state") && scratch_.read("r/.1.jsonl.state").find("\nmade\t") != std::string::npos)
            break;
    }
    EXPECT_EQ(ran.code, 128 + SIGTERM);
    const Ran rest = shard(1, 1, {"--json"});
    EXPECT_EQ(rest.code, 0) << rest.err;
    EXPECT_NE(rest.out.find("\"status\":\"current\""), std::string::npos) << "made by the first try";
    EXPECT_FALSE(scratch_.has("r/.1.jsonl.state"));
    EXPECT_EQ(merge().code, 0);
}

TEST_F(BuildNormalsFarm, OptionsThatDoNotFitTogetherAreRefused) {
    const struct {
        std::vector<std::string> arguments;
        const char* error;
    } mistakes[] = {
        {{"--shard", "1/2"}, "--shard needs --plan"},
        {{"--merge", "r"}, "--merge needs --plan"},
        {{"--plan", "p", "--merge"}, "--merge needs the reports of the shards"},
        {{"--plan", "p", "--report", "r"}, "--report needs --shard"},
        {{"--plan", "p", "--shard", "1/2", "--merge", "r"}, "--shard and --merge exclude each other"},
        {{"--plan", "p", "--shard", "3"}, "--shard: write it as I/N, such as 3/64"},
        {{"--plan", "p", "--shard", "0/2"}, "--shard: "},
        {{"--plan", "p", "--shard", "3/2"}, "--shard: "},
        {{"--plan", "p", "--prune"}, "--prune and --plan exclude each other"},
        {{"--plan", "p", "--dry-run"}, "--dry-run and --plan exclude each other"},
    };
    for (const auto& mistake : mistakes) {
        const Ran ran = build(mistake.arguments);
        EXPECT_EQ(ran.code, 2) << mistake.error;
        EXPECT_NE(ran.err.find(mistake.error), std::string::npos) << ran.err;
    }
    EXPECT_EQ(build({"--plan", "none.jsonl", "--shard", "1/2"}).code, 3);
    EXPECT_EQ(build({"--plan", "no/folder/plan.jsonl"}).code, 3);
}

}  // namespace tex::cli
