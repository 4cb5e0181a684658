// SPDX-License-Identifier: Apache-2.0
// What scripts and other programs depend on is a list, tests/golden/interface.txt: options and their words, exit
// statuses, rules, keys of the JSON reports. What is on it must stay until the next major version
// (normal-maps-stability(7)); what is new must be put on it:
//
//     TEX_GOLDEN_WRITE=1 build/release/cli_tests --gtest_filter='Interface.*'

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <tex/check.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {
namespace {

using nlohmann::json;

const std::filesystem::path kInterface = std::filesystem::path(TEX_SOURCE_DIR) / "tests" / "golden" / "interface.txt";

// What is depended on ("option --threads integer"), and the commands that have it.
using Facts = std::map<std::string, std::set<std::string>>;

json help_of(const Scratch& scratch, const std::string& command) {
    const Ran ran = run(scratch, command, {"--help", "--json"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    return json::parse(ran.out);
}

void add_options(const Scratch& scratch, Facts& lines) {
    for (const std::string& command : commands()) {
        const json help = help_of(scratch, command);
        for (const json& option : help["options"]) {
            const std::string name = option["names"].back();
            for (const std::string other : option["names"])
                lines[fmt::format("option {} {}", other, option["type"].get<std::string>())].insert(command);
            for (const json& word : option.value("words", json::array()))
                lines[fmt::format("word {} {}", name, word["word"].get<std::string>())].insert(command);
        }
        for (const json& status : help["exit_status"])
            lines[fmt::format("exit {}", status["status"].get<int>())].insert(command);
    }
}

// The paths of all keys: "warnings[].file".
void add_keys(const std::string& command, const std::string& place, const json& value, Facts& lines) {
    if (value.is_object()) {
        for (const auto& [key, below] : value.items())
            add_keys(command, place + (place.ends_with(' ') ? "" : ".") + key, below, lines);
    } else if (value.is_array()) {
        if (value.empty() || !value.front().is_structured()) lines[place + "[]"].insert(command);
        for (const json& below : value) {
            if (below.is_structured()) add_keys(command, place + "[]", below, lines);
        }
    } else {
        lines[place].insert(command);
    }
}

struct ReportLine {
    const char* command;
    std::vector<std::string> arguments;
};

const ReportLine kReports[] = {
    {"bake-normals", {"a.png", "-o", "a.dds", "--deband", "on", "--rdo-mean", "0.1"}},
    {"bake-normals", {"missing.png", "-o", "b.dds"}},
    {"mip-normals", {"n.png", "-o", "m.dds"}},
    {"mip-normals", {"n.png", "-o", "m2.dds", "--roughness-out", "r.dds"}},
    {"pack-normals", {"n.png", "-o", "p.ktx2", "--mips", "keep"}},
    {"unpack-normals", {"a.dds", "-o", "u.png"}},
    {"unpack-normals", {"a.dds", "--out-dir", ".", "--name", "u{level}.png", "--level", "all"}},
    {"scale-normals", {"n.png", "-o", "s.png", "--scale", "2"}},
    {"blend-normals", {"n.png", "n.png", "-o", "l.png"}},
    {"check-normals", {"n.png", "bad.png"}},
    {"repair-normals", {"bad.png", "-o", "rb.png", "--likely"}},
    {"repair-normals", {"blue.png", "-o", "rc.png", "--likely"}},
    {"repair-normals", {"half.png", "-o", "rd.png", "--dry-run", "--only", "N402", "--likely"}},
    {"compare-normals", {"n.png", "s.png"}},
    {"compare-normals", {"n.png", "--rdo-means", "0,1"}},
    {"preview-normals", {"n.png", "-o", "v.png"}},
    {"integrate-normals", {"n.png", "-o", "h.png", "--curl-out", "c.png", "--horizon-out", "hor.png"}},
    {"convert-normals", {"n.png", "-o", "o.png", "--mesh", "sheet.obj", "--decoder-in", "godot"}},
    {"transfer-normals", {"low.glb", "-o", "t.png", "--high", "high.glb", "--extent", "16"}},
    {"build-normals", {}},
};

void add_reports(const Scratch& scratch, Facts& lines) {
    scratch.add_sample("bricks.png", "a.png");
    scratch.add_sample("broken/N201-not-unit-length.png", "bad.png");
    scratch.add_sample("broken/N220-blue-inverted.png", "blue.png");
    scratch.add_sample("broken/N402-mixed-y.png", "half.png");
    scratch.add_sample("crate_low.glb", "low.glb");
    scratch.add_sample("crate_high.glb", "high.glb");
    scratch.write("sheet.obj",
                  "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
                  "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\n");
    scratch.write("normals.toml",
                  "version = 1\n[defaults]\nout-dir = \"out\"\n[[rule]]\nmatch = \"a.png\"\n"
                  "name = \"a.dds\"\nsteps = [ { bake = { bumpiness = 2 } } ]\n");
    EXPECT_EQ(run(scratch, "bake-normals", {"a.png", "-o", "n.png", "--bumpiness", "4"}).code, 0);
    for (const ReportLine& report : kReports) {
        std::vector<std::string> arguments = report.arguments;
        arguments.insert(arguments.end(), {"--json", "--quiet"});
        const Ran ran = run(scratch, report.command, arguments);
        std::string text = ran.out;
        EXPECT_FALSE(text.empty()) << report.command << " " << ran.err;
        for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
            const json line = json::parse(text.substr(0, end));
            text.erase(0, end + 1);
            EXPECT_EQ(line.value("schema", 0), 1) << report.command;
            add_keys(report.command, "json ", line, lines);
        }
    }
    for (const std::string& command : commands()) {
        json version = json::parse(run(scratch, command, {"--version", "--json"}).out);
        version.erase("dependencies");
        add_keys(command, "version ", version, lines);
    }
    add_keys("all", "help ", help_of(scratch, "bake-normals"), lines);
}

// A fact with its commands, one in each line.
std::set<std::string> listed_facts() {
    std::ifstream file(kInterface);
    std::set<std::string> listed;
    for (std::string line; std::getline(file, line);) {
        const std::size_t colon = line.rfind(": ");
        std::istringstream commands_of(line.substr(colon + 2));
        for (std::string command; commands_of >> command;) listed.insert(line.substr(0, colon) + ": " + command);
    }
    return listed;
}

TEST(Interface, NothingIsRemovedAndWhatIsNewIsListed) {
    const Scratch scratch;
    Facts facts;
    add_options(scratch, facts);
    add_reports(scratch, facts);
    for (const Rule& rule : rules()) facts[fmt::format("rule {} {}", rule.id, rule.name)].insert("check-normals");
    if (std::getenv("TEX_GOLDEN_WRITE") != nullptr) {
        std::ofstream file(kInterface);
        for (const auto& [fact, with] : facts) file << fact << ": " << fmt::format("{}", fmt::join(with, " ")) << "\n";
        return;
    }
    std::set<std::string> found;
    for (const auto& [fact, with] : facts) {
        for (const std::string& command : with) found.insert(fact + ": " + command);
    }
    const std::set<std::string> listed = listed_facts();
    ASSERT_GT(listed.size(), 1000u) << kInterface;
    for (const std::string& line : listed)
        EXPECT_TRUE(found.contains(line)) << "removed: " << line << "\nusers depend on it (normal-maps-stability(7))";
    for (const std::string& line : found)
        EXPECT_TRUE(listed.contains(line)) << "new: " << line << "\nput it on the list with TEX_GOLDEN_WRITE=1";
}

// What --help --json says about a value is what the command accepts: judged by the command itself.
TEST(HelpJson, RangesAreThoseThatTheCommandChecks) {
    const Scratch scratch;
    scratch.add_sample("ramp.png", "a.png");
    int tried = 0;
    for (const std::string command : {"bake-normals", "scale-normals", "preview-normals"}) {
        const json help = help_of(scratch, command);
        for (const json& option : help["options"]) {
            const bool is_integer = option["type"] == "integer";
            if (option["type"] != "number" && !is_integer) continue;
            const std::string name = option["names"].back();
            const auto refuses = [&](double value) {
                const std::string text =
                    is_integer ? fmt::format("{}", static_cast<long long>(value)) : fmt::format("{}", value);
                std::vector<std::string> arguments = {"a.png", "-o", "a.dds", name + "=" + text};
                if (command == "scale-normals" && name != "--scale")
                    arguments.insert(arguments.end(), {"--scale", "1"});
                const Ran ran = run(scratch, command, arguments);
                return ran.code == 2 && ran.err.find("error: " + name + ": ") != std::string::npos;
            };
            const double step = is_integer ? 1.0 : 0.5;
            for (const auto& [key, beyond] : {std::pair("minimum", -step), std::pair("exclusiveMinimum", 0.0)}) {
                if (!option.contains(key)) continue;
                EXPECT_TRUE(refuses(option[key].get<double>() + beyond)) << name;
            }
            if (!option.contains("maximum")) continue;
            EXPECT_TRUE(refuses(option["maximum"].get<double>() * 1.5)) << name;
            ++tried;
        }
    }
    EXPECT_GE(tried, 5);
}

TEST(HelpJson, HasTheOptionsOfTheHelpWithTheirTexts) {
    const Scratch scratch;
    for (const std::string& command : commands()) {
        const json help = help_of(scratch, command);
        const std::string text = run(scratch, command, {"--help"}).out;
        EXPECT_EQ(help["program"], command);
        EXPECT_FALSE(help["usage"].empty());
        for (const json& option : help["options"]) {
            EXPECT_NE(text.find(option["names"].back().get<std::string>()), std::string::npos);
            EXPECT_FALSE(option["text"].get<std::string>().empty());
        }
    }
}

}  // namespace
}  // namespace tex::cli
