// SPDX-License-Identifier: Apache-2.0
// samples/broken: every rule has a file that triggers this rule and no other.

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {

class CheckNormalsBroken : public testing::Test {
protected:
    CheckNormalsBroken() {
        EXPECT_EQ(
            shell(scratch_, "cp -r " TEX_SOURCE_DIR "/samples/broken . && cp " TEX_SOURCE_DIR "/samples/waves.png .")
                .code,
            0);
        for (const std::string& line : lines_of(scratch_.read("broken/options.txt")))
            options_[line.substr(0, 4)] = line.substr(5);
        for (const auto& entry : std::filesystem::directory_iterator(scratch_.path("broken"))) {
            const std::string name = entry.path().filename().string();
            if (name != "options.txt" && !entry.is_directory()) names_.push_back(name);
        }
    }
    // Checks a file with the options that its rule needs.
    Ran check(const std::string& id, const std::string& name) {
        return shell(scratch_, "cd broken && check-normals --json " + options_[id] + " " + name);
    }
    Scratch scratch_;
    std::map<std::string, std::string> options_;
    std::vector<std::string> names_;
};

TEST_F(CheckNormalsBroken, EveryRuleHasAFileThatTriggersItAlone) {
    std::set<std::string> seen;
    for (const std::string& name : names_) {
        const std::string id = name.substr(0, 4);
        const Ran ran = check(id, name);
        const auto report = nlohmann::json::parse(ran.out);
        ASSERT_GE(report["findings"].size(), 1u) << name << ": " << ran.out;
        for (const auto& finding : report["findings"]) EXPECT_EQ(finding["id"], id) << name << ": " << ran.out;
        ASSERT_NE(find_rule(id), nullptr);
        const bool unreadable = id == "N101";
        EXPECT_EQ(ran.code, unreadable ? 4 : find_rule(id)->severity == Severity::error ? 1 : 0) << name;
        EXPECT_TRUE(name.starts_with(id + "-" + std::string(find_rule(id)->name) + ".")) << name;
        seen.insert(id);
    }
    EXPECT_EQ(seen.size(), rules().size());
}

}  // namespace tex::cli
