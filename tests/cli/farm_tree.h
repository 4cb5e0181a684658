// SPDX-License-Identifier: Apache-2.0
// farm_tree.h: a folder with a manifest, and the shards and merges of its plan, for tests of build-normals on farms.

#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {

namespace fs = std::filesystem;

inline constexpr const char* kFarmManifest = R"(version = 1
[defaults]
out-dir = "out"
[[rule]]
match = "shared/*.png"
steps = [ { bake = { bumpiness = 2 } } ]
[[rule]]
match = "plain/*.png"
steps = [ { bake = {} } ]
[[rule]]
match = "art/**/*.png"
steps = [ { bake = { bumpiness = 4 } }, { blend = { detail = "out/shared/grain.dds", tiling = 3 } } ]
outputs = [ { name = "{dir}/{stem}_n.dds" }, { format = "bc5", name = "{dir}/{stem}_ue.ktx2" } ]
)";

class FarmTree : public testing::Test {
protected:
    using Files = std::map<std::string, std::string>;

    FarmTree() {
        scratch_.write("normals.toml", kFarmManifest);
        add("waves.png", "shared/grain.png");
        add("bricks.png", "plain/bricks.png");
        add("ramp.png", "plain/b\xff\n.png");
        for (int k = 0; k < 6; ++k) add(k % 2 == 0 ? "ramp.png" : "hemisphere.png", fmt::format("art/s{}/m.png", k));
    }
    void add(const std::string& sample, const std::string& name) const {
        fs::create_directories(fs::path(scratch_.path(name)).parent_path());
        scratch_.add_sample(sample, name);
    }
    Ran build(std::vector<std::string> arguments = {}) const {
        arguments.emplace_back("--no-sync");
        return run(scratch_, "build-normals", arguments);
    }
    Ran shard(int shard, int shards, std::vector<std::string> more = {}) const {
        std::vector<std::string> arguments = {"--plan",   "plan.jsonl",
                                              "--shard",  fmt::format("{}/{}", shard, shards),
                                              "--report", fmt::format("r/{}.jsonl", shard)};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return build(arguments);
    }
    Ran merge(std::vector<std::string> more = {}) const {
        std::vector<std::string> arguments = {"--plan", "plan.jsonl", "--merge"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        if (more.empty()) {
            for (const std::string& name : scratch_.list()) {
                if (name.starts_with("r/") && name.ends_with(".jsonl")) arguments.push_back(name);
            }
        }
        return build(arguments);
    }
    void plan_and_run(int shards) const {
        ASSERT_EQ(build({"--plan", "plan.jsonl"}).code, 0);
        for (int k = 1; k <= shards; ++k) ASSERT_EQ(shard(k, shards).code, 0);
    }
    // All outputs and their contents.
    [[nodiscard]] Files outputs() const {
        Files all;
        for (const std::string& name : scratch_.list()) {
            if (name.starts_with("out/") && fs::is_regular_file(scratch_.path(name))) all[name] = scratch_.read(name);
        }
        return all;
    }
    void forget() const {
        for (const char* name : {"out", "r", ".normals.toml.state"}) fs::remove_all(scratch_.path(name));
    }
    // The number of the first shard whose report has this input.
    [[nodiscard]] int shard_of(const std::string& input, int shards) const {
        for (int k = 1; k <= shards; ++k) {
            if (scratch_.read(fmt::format("r/{}.jsonl", k)).find("\"" + input + "\"") != std::string::npos) return k;
        }
        return 0;
    }

    Scratch scratch_;
};

}  // namespace tex::cli
