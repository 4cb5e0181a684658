// SPDX-License-Identifier: Apache-2.0
// What every command has: help, version, completions, and a man page that lists the same options.

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {

class EveryCommand : public testing::TestWithParam<std::string> {
protected:
    Scratch scratch_;
};
INSTANTIATE_TEST_SUITE_P(Cli, EveryCommand, testing::ValuesIn(commands()), [](const auto& instance) {
    std::string name = instance.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

TEST_P(EveryCommand, HelpGoesToStandardOutputIn80Columns) {
    const Ran help = run(scratch_, GetParam(), {"--help"});
    EXPECT_EQ(help.code, 0);
    EXPECT_EQ(help.err, "");
    bool examples = false;
    for (const std::string& line : lines_of(help.out)) {
        examples = examples || line == "Examples:";
        if (!line.starts_with("  " + GetParam())) {
            EXPECT_LE(line.size(), 80u) << line;
        }
    }
    EXPECT_TRUE(examples);
    EXPECT_NE(help.out.find("Exit status:"), std::string::npos);
    // --help works even if another option is wrong.
    EXPECT_EQ(run(scratch_, GetParam(), {"--threads", "x", "--help"}).out, help.out);
    EXPECT_EQ(run(scratch_, GetParam(), {"--nonsense", "--help"}).out, help.out);
}

TEST_P(EveryCommand, VersionIsOneLineOrJson) {
    const Ran plain = run(scratch_, GetParam(), {"--version"});
    EXPECT_EQ(plain.code, 0);
    EXPECT_EQ(plain.out, GetParam() + " " TEX_VERSION "\n");
    const auto json = nlohmann::json::parse(run(scratch_, GetParam(), {"--version", "--json"}).out);
    EXPECT_EQ(json["program"], GetParam());
    EXPECT_EQ(json["version"], TEX_VERSION);
    EXPECT_EQ(json["libtex"], TEX_VERSION);
    for (const char* name : {"fmt", "highway", "libdeflate", "libisal", "libpng", "libzstd", "nlohmann-json", "onetbb",
                             "opencolorio", "openexr", "openimageio"}) {
        EXPECT_TRUE(json["dependencies"].contains(name) &&
                    std::isdigit(static_cast<unsigned char>(json["dependencies"][name].get<std::string>().at(0))) != 0)
            << name;
    }
    EXPECT_EQ(json["reader"]["system_calls"], "filtered");
    EXPECT_EQ(json["reader"]["files"], json["reader"]["landlock"].get<int>() > 0 ? "restricted" : "not restricted");
    EXPECT_TRUE(std::filesystem::exists(json["reader"]["program"].get<std::string>()));
    EXPECT_FALSE(json["instruction_set"].get<std::string>().empty());
}

// See kernels/target.cpp: half of the time of `--version`.
TEST_P(EveryCommand, StartsWithoutMeasuringTheClock) {
    Setting bindings;
    bindings.environment = {"LD_DEBUG=bindings"};
    for (const std::string& line : lines_of(run(scratch_, GetParam(), {"--version"}, bindings).err)) {
        if (line.find("libhwy") == std::string::npos || line.find("TimerResolution") == std::string::npos) continue;
        EXPECT_EQ(line.substr(line.find(" to ")).find("libhwy"), std::string::npos) << line;
    }
}

TEST_P(EveryCommand, AFullDiskBehindStandardOutputIsAnError) {
    Setting full;
    full.stdout_path = "/dev/full";
    const Ran help = run(scratch_, GetParam(), {"--help"}, full);
    EXPECT_EQ(help.code, 3);
    EXPECT_NE(help.err.find("no space left on the disk"), std::string::npos);
}

TEST_P(EveryCommand, CompletionsAreSoundInTheirShells) {
    for (const std::string name : {"bash", "zsh", "fish"}) {
        const Ran script = run(scratch_, GetParam(), {"--completion", name});
        EXPECT_EQ(script.code, 0);
        EXPECT_NE(script.out.find(GetParam()), std::string::npos);
        scratch_.write("script." + name, script.out);
        if (!is_installed(name)) continue;
        const Ran checked = shell(scratch_, name + " -n script." + name);
        EXPECT_EQ(checked.code, 0) << name << ": " << checked.err;
    }
    EXPECT_EQ(run(scratch_, GetParam(), {"--completion", "tcsh"}).code, 2);
}

TEST_P(EveryCommand, BashCompletesOptionsAndTheirWords) {
    const std::string function = std::regex_replace("_" + GetParam(), std::regex("-"), "_");
    const std::string prelude = "compopt() { :; }; source <(" + GetParam() + " --completion bash); ";
    const Ran options = shell(
        scratch_, prelude + "COMP_WORDS=(x --qui); COMP_CWORD=1; " + function + "; printf '%s\\n' \"${COMPREPLY[@]}\"");
    EXPECT_EQ(options.out, "--quiet\n") << options.err;
    const Ran words = shell(scratch_, prelude + "COMP_WORDS=(x --progress a); COMP_CWORD=2; " + function +
                                          "; printf '%s\\n' \"${COMPREPLY[@]}\"");
    EXPECT_EQ(words.out, "auto\nalways\n") << words.err;
    const Ran equals = shell(scratch_, prelude + "COMP_WORDS=(x --progress = n); COMP_CWORD=3; " + function +
                                           "; printf '%s\\n' \"${COMPREPLY[@]}\"");
    EXPECT_EQ(equals.out, "never\n") << equals.err;
}

TEST_P(EveryCommand, ManPageHasTheOptionsOfTheTableInItsOrder) {
    const Ran listed = run(scratch_, GetParam(), {"--list-options"});
    ASSERT_EQ(listed.code, 0);
    std::ifstream page(TEX_BINARY_DIR "/man/" + GetParam() + ".1");
    const std::string text{std::istreambuf_iterator<char>(page), {}};
    ASSERT_NE(text, "") << "no man page";
    // ".It Fl o Ar FILE , Fl -output Ar FILE", ".It Fl -json": the long names, with or without a value.
    std::vector<std::pair<std::string, bool>> in_page, in_table;
    const std::regex item(R"(\.It (?:Fl ([a-z]) (?:Ar \S+ )?, )?Fl -([a-z0-9-]+)( .*)?)");
    for (const std::string& line : lines_of(text)) {
        std::smatch match;
        if (!std::regex_match(line, match, item)) continue;
        const std::string name = (match[1].matched ? "-" + match[1].str() + "," : "") + "--" + match[2].str();
        in_page.emplace_back(name, match[3].matched);
    }
    for (const std::string& line : lines_of(listed.out)) {
        const std::size_t tab = line.find('\t');
        in_table.emplace_back(line.substr(0, tab), line[tab + 1] != '\t');
    }
    std::stable_partition(in_table.begin(), in_table.end(), [](const auto& row) {  // in the order of the help
        return row.first != "-h,--help" && row.first != "--version";
    });
    EXPECT_EQ(in_page, in_table);
}

TEST_P(EveryCommand, ManPageNamesEveryWordThatAnOptionTakes) {
    std::ifstream page(TEX_BINARY_DIR "/man/" + GetParam() + ".1");
    const std::string text{std::istreambuf_iterator<char>(page), {}};
    std::set<std::string> bold;  // "Cm word" of mdoc
    const std::regex word(R"(Cm ([^ \n]+))");
    for (std::sregex_iterator it(text.begin(), text.end(), word), end; it != end; ++it) bold.insert((*it)[1]);
    for (const std::string& line : lines_of(run(scratch_, GetParam(), {"--list-options"}).out)) {
        std::string words = line.substr(line.rfind('\t') + 1);
        std::replace(words.begin(), words.end(), ',', '\n');
        for (const std::string& name : lines_of(words)) {
            EXPECT_TRUE(bold.contains(name)) << line.substr(0, line.find('\t')) << " takes " << name;
        }
    }
}

}  // namespace tex::cli
