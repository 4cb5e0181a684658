// SPDX-License-Identifier: Apache-2.0
// What build-normals --merge makes of textures that several shards need, and of failures.

#include <filesystem>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/farm_tree.h"

namespace tex::cli {

class BuildMerge : public FarmTree {};

// Both shards need shared/grain.png. It was missing for the first one alone.
TEST_F(BuildMerge, WhatOneReportLacksAnotherMayHave) {
    ASSERT_EQ(build({"--plan", "plan.jsonl"}).code, 0);
    fs::rename(scratch_.path("shared/grain.png"), scratch_.path("aside.png"));
    EXPECT_EQ(shard(1, 2).code, 3);
    fs::rename(scratch_.path("aside.png"), scratch_.path("shared/grain.png"));
    ASSERT_EQ(shard(2, 2).code, 0);
    for (const auto& [first, second] : {std::pair{"r/1.jsonl", "r/2.jsonl"}, {"r/2.jsonl", "r/1.jsonl"}}) {
        const Ran ran = merge({"--json", first, second});
        EXPECT_EQ(ran.code, 1) << ran.err;
        EXPECT_EQ(ran.out.find("\"input\":\"shared/grain.png\""), std::string::npos) << ran.out;
        EXPECT_EQ(nlohmann::json::parse(lines_of(ran.out).back())["again"], nlohmann::json::parse("[1]"));
    }
    ASSERT_EQ(shard(1, 2).code, 0);
    EXPECT_EQ(merge().code, 0);
}

// What needs a texture that was made fails for its own reason: sending it again would not help.
TEST_F(BuildMerge, WhatFailsBesideWhatItNeedsIsNotSentAgain) {
    scratch_.write("art/s0/broken.png", "no picture");
    ASSERT_EQ(build({"--plan", "plan.jsonl"}).code, 0);
    for (int k = 1; k <= 2; ++k) static_cast<void>(shard(k, 2));
    const Ran ran = merge({"--json", "r/1.jsonl", "r/2.jsonl"});
    EXPECT_EQ(ran.code, 4) << ran.err;
    const auto lines = lines_of(ran.out);
    ASSERT_EQ(lines.size(), 2u) << ran.out;
    const auto broken = nlohmann::json::parse(lines[0]);
    EXPECT_EQ(broken["input"], "art/s0/broken.png");
    EXPECT_EQ(broken["again"], false);
    EXPECT_EQ(nlohmann::json::parse(lines[1])["again"], nlohmann::json::array());
}

// A texture that several shards need is sent again once.
TEST_F(BuildMerge, AnOutputOfSeveralShardsIsSentAgainWithTheFirst) {
    plan_and_run(2);
    for (int k = 1; k <= 2; ++k)
        ASSERT_NE(scratch_.read(fmt::format("r/{}.jsonl", k)).find("\"shared/grain.png\""), std::string::npos);
    fs::remove(scratch_.path("out/shared/grain.dds"));
    EXPECT_EQ(merge().out, "1\n");
    ASSERT_EQ(shard(1, 2).code, 0);
    EXPECT_EQ(merge().code, 0);
}

}  // namespace tex::cli
