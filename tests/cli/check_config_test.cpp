// SPDX-License-Identifier: Apache-2.0
// The configuration of check-normals, with rules for files that match patterns.

#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "cli/usage_error.h"
#include "options/check_config.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

std::string mistake_in(const std::string& text) {
    try {
        static_cast<void>(parse_check_config("checks.toml", text));
    } catch (const UsageError& error) {
        return error.what();
    }
    return {};
}

}  // namespace

TEST(CheckConfig, RulesBeginWithTheTopLevel) {
    const CheckConfig config = parse_check_config("checks.toml", R"(require = ["mips=full", "y=up"]
disable = ["N208", "seam"]
fail-on = "warning"
[severity]
constant = "error"
[[rule]]
match = ["ui/**", "gr\u00f6\u00dfe_*.dds"]
exclude = "ui/old/**"
require = ["mips=none"]
enable = ["N307"]
disable = ["N206"]
fail-on = "error"
severity = { constant = "note" }
[[rule]]
match = "**"
)");
    EXPECT_EQ(config.settings.options.require.levels, 0);
    EXPECT_EQ(config.settings.fail_on, Severity::warning);
    ASSERT_EQ(config.rules.size(), 2u);
    const CheckRule& rule = config.rules.front();
    EXPECT_EQ(rule.settings.options.require.levels, 1);
    EXPECT_EQ(rule.settings.options.require.y, YAxis::up);
    EXPECT_EQ(rule.settings.options.disable, (std::vector<std::string>{"N208", "N206"}));
    EXPECT_EQ(rule.settings.options.severity.back().second, Severity::note);
    EXPECT_EQ(rule.settings.fail_on, Severity::error);
    EXPECT_TRUE(rule.takes("ui/deep/a.dds"));
    EXPECT_TRUE(rule.takes("gr\u00f6\u00dfe_1.dds"));
    EXPECT_FALSE(rule.takes("ui/old/a.dds"));
    EXPECT_FALSE(rule.takes("other/a.dds"));
    EXPECT_EQ(config.rules.back().settings.fail_on, Severity::warning) << "not what another rule says";
}

TEST(CheckConfig, MistakesHaveAPlace) {
    const struct {
        const char* text;
        const char* message;
    } mistakes[] = {
        {"require = [\"pow2\",\n  \"mip=full\"]\n", "checks.toml: line 2, column 3: 'mip' cannot be required; "},
        {"[[rule]]\nrequire = []\n", "checks.toml: line 1, column 1: a rule needs match, a pattern of files"},
        {"[[rule]]\nmatch = \"a[\"\n", "checks.toml: line 2, column 9: match: "},
        {"[[rule]]\nmatch = [\"a\", \"/b\"]\n", "checks.toml: line 2, column 15: match: "},
        {"[[rule]]\nmatch = \"a\"\nexclud = \"b\"\n",
         "checks.toml: line 3, column 10: unknown key 'exclud'; did you mean exclude?"},
        {"match = \"a\"\n", "checks.toml: line 1, column 9: unknown key 'match'"},
        {"[rule]\nmatch = \"a\"\n", "checks.toml: line 1, column 1: a rule begins with [[rule]]"},
        {"rule = [1]\n", "checks.toml: line 1, column 9: a rule begins with [[rule]]"},
        {"[[rule]]\nmatch = 1\n", "checks.toml: line 2, column 9: match must be a "},
        {"[[rule]]\nmatch = \"a\"\n[rule.severity]\nN999 = \"error\"\n",
         "checks.toml: line 4, column 8: there is no rule 'N999'"},
        {"fail-on = \"warning\n", "checks.toml: line 1, column "},
    };
    for (const auto& mistake : mistakes)
        EXPECT_TRUE(mistake_in(mistake.text).starts_with(mistake.message)) << mistake_in(mistake.text);
}

class CheckConfigFiles : public testing::Test {
protected:
    CheckConfigFiles() {
        fs::create_directories(scratch_.path("art/ui/old"));
        scratch_.add_sample("bricks.png", "h.png");
        for (const char* name : {"art/a.dds", "art/ui/b.dds", "art/ui/old/c.dds"})
            EXPECT_EQ(run(scratch_, "bake-normals", {"h.png", "-o", name, "--no-sync"}).code, 0);
        scratch_.write("art/checks.toml",
                       "require = [\"format=dxt5nm\"]\n[[rule]]\nmatch = \"ui/**/*.dds\"\nexclude = \"ui/old/**\"\n"
                       "require = [\"format=bc5\"]\nseverity = { N108 = \"warning\" }\n");
    }
    // The findings of each file: "N108 warning".
    std::string check(const std::vector<std::string>& more, int code, const std::string& folder = "art/") {
        std::vector<std::string> arguments = {"--json", "--config", "art/checks.toml"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        for (const char* name : {"a.dds", "ui/b.dds", "ui/old/c.dds"}) arguments.push_back(folder + name);
        const Ran ran = run(scratch_, "check-normals", arguments);
        EXPECT_EQ(ran.code, code) << ran.err;
        std::string all;
        for (const std::string& line : lines_of(ran.out)) {
            const auto report = nlohmann::json::parse(line);
            for (const auto& finding : report["findings"])
                all += report.value("input", "") + " " + finding.value("id", "") + " " + finding.value("severity", "") +
                       "\n";
        }
        return all;
    }
    Scratch scratch_;
};

TEST_F(CheckConfigFiles, TheFirstRuleThatMatchesWins) {
    EXPECT_EQ(check({}, 0), "art/ui/b.dds N108 warning\n");
    EXPECT_EQ(check({"--fail-on", "warning"}, 1), "art/ui/b.dds N108 warning\n");
    EXPECT_EQ(check({"--require", "format=dxt5nm"}, 0), "") << "the command line takes precedence";
    EXPECT_EQ(check({"--disable", "N108"}, 0), "");
    // Whatever the names of the files are.
    const std::string folder = scratch_.path("art") + "/";
    EXPECT_EQ(check({}, 0, folder), folder + "ui/b.dds N108 warning\n");
    fs::create_directory_symlink("art", scratch_.path("link"));
    EXPECT_EQ(check({}, 0, "link/"), "link/ui/b.dds N108 warning\n");
}

TEST_F(CheckConfigFiles, DocumentsKnowWhatIsDemandedOfEachFile) {
    scratch_.write("art/checks.toml",
                   "fail-on = \"note\"\n[[rule]]\nmatch = \"ui/*\"\nrequire = [\"format=bc5\"]\nseverity = { N108 = "
                   "\"warning\" }\nfail-on = \"error\"\n[[rule]]\nmatch = \"ui/old/*\"\nrequire = [\"format=bc5\"]\n");
    EXPECT_EQ(check({"--junit", "j.xml", "--sarif", "s.json"}, 1),
              "art/ui/b.dds N108 warning\nart/ui/old/c.dds N108 error\n");
    const std::string junit = scratch_.read("j.xml");
    EXPECT_NE(junit.find("tests=\"3\" failures=\"1\""), std::string::npos) << junit;
    EXPECT_NE(scratch_.read("s.json").find("--format bc5"), std::string::npos) << "the fix";
}

}  // namespace tex::cli
