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
            if (name != "options.txt") names_.push_back(name);
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
        EXPECT_EQ(ran.code, id == "N101" ? 4 : find_rule(id)->severity == Severity::error ? 1 : 0) << name;
        EXPECT_TRUE(name.starts_with(id + "-" + std::string(find_rule(id)->name) + ".")) << name;
        seen.insert(id);
    }
    EXPECT_EQ(seen.size(), rules().size());
}

std::string with(std::string text, const std::string& word, const std::string& by) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size()))
        text.replace(at, word.size(), by);
    return text;
}

// Runs the command that a finding suggests, as printed (with its placeholders for other files and numbers filled in).
// Its output must no longer have the finding.
TEST_F(CheckNormalsBroken, EveryFixRepairsItsFinding) {
    ASSERT_EQ(run(scratch_, "bake-normals", {"waves.png", "-o", "source.exr", "--bumpiness", "8", "--no-sync"}).code,
              0);
    std::size_t repaired = 0;
    for (const std::string& name : names_) {
        const std::string id = name.substr(0, 4);
        if (find_rule(id)->fix.empty()) continue;
        const auto report = nlohmann::json::parse(check(id, name).out);
        std::string fix = report["findings"][0].value("fix", "");
        const auto output = fix.find("FIXED.");
        ASSERT_NE(output, std::string::npos) << id << ": " << fix;
        const std::string fixed = fix.substr(output);
        fix = with(with(with(fix, "HEIGHT", "../waves.png"), "SOURCE", "../source.exr"), "FIRST,LAST", "0,3");
        const Ran ran = shell(scratch_, "cd broken && " + fix + " --no-sync");
        EXPECT_EQ(ran.code, 0) << fix << ran.err;
        const auto after = nlohmann::json::parse(check(id, fixed).out);
        for (const auto& finding : after["findings"]) {
            EXPECT_NE(finding["id"], id) << fix << finding;
            EXPECT_NE(finding["severity"], "error") << fix << finding;
        }
        ++repaired;
    }
    const auto has_fix = [](const Rule& rule) { return !rule.fix.empty(); };
    EXPECT_EQ(repaired, static_cast<std::size_t>(std::count_if(rules().begin(), rules().end(), has_fix)));
}

}  // namespace tex::cli
