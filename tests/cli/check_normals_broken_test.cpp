// SPDX-License-Identifier: Apache-2.0
// samples/broken: every rule has a file that makes this rule fire, and no other.

#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <tex/tex.h>

#include "cli/program.h"

namespace tex::cli {

TEST(CheckNormalsBroken, EveryRuleHasAFileThatTriggersItAlone) {
    const Scratch scratch;
    ASSERT_EQ(shell(scratch, "cp -r " TEX_SOURCE_DIR "/samples/broken . && cp " TEX_SOURCE_DIR "/samples/waves.png .").code, 0);
    std::map<std::string, std::string> options;
    for (const std::string& line : lines_of(scratch.read("broken/options.txt"))) options[line.substr(0, 4)] = line.substr(5);
    std::set<std::string> seen;
    for (const auto& entry : std::filesystem::directory_iterator(scratch.path("broken"))) {
        const std::string name = entry.path().filename().string();
        if (name == "options.txt") continue;
        const std::string id = name.substr(0, 4);
        const Ran ran = shell(scratch, "cd broken && check-normals --json " + options[id] + " " + name);
        const auto report = nlohmann::json::parse(ran.out);
        ASSERT_GE(report["findings"].size(), 1u) << name << ": " << ran.out;
        for (const auto& finding : report["findings"]) EXPECT_EQ(finding["id"], id) << name << ": " << ran.out;
        ASSERT_NE(find_rule(id), nullptr);
        EXPECT_EQ(ran.code, id == "N101" ? 4 : find_rule(id)->severity == Severity::error ? 1 : 0) << name;
        EXPECT_TRUE(name.starts_with(id + "-" + std::string(find_rule(id)->name) + ".")) << name;
        seen.insert(id);
    }
    EXPECT_EQ(seen.size(), rules().size());
}

}  // namespace tex::cli
