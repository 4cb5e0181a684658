// SPDX-License-Identifier: Apache-2.0
// What users of other programs type gets an answer that is true, and no wrong neighbour.

#include "cli/foreign_words.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/file.h>
#include <tex/format.h>

#include "cli/program.h"
#include "cli/programs.h"
#include "cli/text.h"
#include "cli/value.h"
#include "tasks/engines.h"

namespace tex::cli {
namespace {

std::set<std::string> options_of(const ProgramRow& program) {
    const std::unique_ptr<Program> command = program.make(program);
    std::set<std::string> names;
    for (const Option& row : command->command.options()) {
        if (!row.hidden) names.insert(row.names.begin(), row.names.end());
    }
    return names;
}

std::string answer_on(const std::set<std::string>& options, const std::string& name) {
    return foreign_option_answer(name, [&](std::string_view option) { return options.contains(std::string(option)); });
}

// The options in an answer, and whose they are.
std::vector<std::string> options_in(const std::string& answer) {
    const std::regex option("--[a-z0-9-]+");
    std::vector<std::string> found;
    for (std::sregex_iterator it(answer.begin(), answer.end(), option), end; it != end; ++it)
        found.push_back(it->str());
    return found;
}

TEST(ForeignOptions, EveryAnswerNamesOptionsThatTheCommandHas) {
    std::set<std::string_view> used;
    for (const ProgramRow& program : programs()) {
        const std::set<std::string> options = options_of(program);
        for (const ForeignOption& row : foreign_options()) {
            for (const std::string& name : split(row.names, ' ')) {
                EXPECT_TRUE(name.starts_with("-")) << row.names;
                if (options.contains(name)) continue;  // it is this command's own
                const std::string answer = answer_on(options, name);
                if (!row.answer.empty() && answer.ends_with(row.answer)) used.insert(row.answer);
                std::smatch other;
                const bool is_other = std::regex_search(answer, other, std::regex("[a-z]+-normals"));
                const std::set<std::string> its = is_other ? options_of(*find_program(other.str())) : options;
                for (const std::string& option : options_in(answer))
                    EXPECT_TRUE(its.contains(option)) << program.name << ' ' << name << answer;
            }
        }
    }
    for (const ForeignOption& row : foreign_options())
        EXPECT_TRUE(row.answer.empty() || used.contains(row.answer)) << "no command gives it: " << row.answer;
}

// Words of other tools: no answer may be a guess from the spelling.
TEST(ForeignOptions, HaveNoWrongNeighbours) {
    const char* const kTyped[] = {"--size",
                                  "--resize",
                                  "--scale",
                                  "--strength",
                                  "--ext",
                                  "-r",
                                  "-v",
                                  "-q",
                                  "-j",
                                  "--margin",
                                  "--dilation",
                                  "--extrusion",
                                  "--cage-extrusion",
                                  "--ray-distance",
                                  "--max-distance",
                                  "--samples",
                                  "--ao",
                                  "--ao-out",
                                  "--gamma",
                                  "--srgb",
                                  "--quality"};
    for (const ProgramRow& program : programs()) {
        for (const char* name : kTyped) {
            if (options_of(program).contains(name)) continue;
            EXPECT_TRUE(is_foreign_option(name)) << name;
            const char* const arguments[] = {name};
            MemoryHost host;
            EXPECT_EQ(run(program, arguments, host), ExitCode::usage);
            EXPECT_EQ(host.err().find("did you mean"), std::string::npos) << host.err();
        }
    }
    EXPECT_EQ(did_you_mean("--ao-out", {"--id-out", "--height-out"}), "");
    EXPECT_EQ(did_you_mean("--y-ni", {"--y", "--y-in"}), "; did you mean --y-in?");
    EXPECT_EQ(did_you_mean("--mip-fliter", {"--mip-domain", "--mip-filter"}), "; did you mean --mip-filter?");
}

TEST(ForeignOptions, AreAnswered) {
    const Scratch scratch;
    const auto says = [&](const std::string& command, const std::string& option, const std::string& answer) {
        const Ran ran = run(scratch, command, {"a.png", option});
        EXPECT_EQ(ran.code, 2) << option;
        EXPECT_NE(ran.err.find("unknown option " + answer), std::string::npos) << ran.err;
    };
    says("bake-normals", "--strength=3", "--strength; here it is --bumpiness\n");
    says("bake-normals", "--scale", "--scale; here it is --bumpiness\n");
    says("bake-normals", "--roughness-out",
         "--roughness-out; here it is mip-normals --roughness-out, which makes roughness follow from the normals that "
         "levels average\n");
    says("blend-normals", "--method", "--method; here it is --mode\n");
    says("scale-normals", "--strength", "--strength; here it is --scale\n");
    says("pack-normals", "--size", "--size; here it is --max-size, which leaves out larger levels\n");
    says("transfer-normals", "--size", "--size; here it is --extent\n");
    says("transfer-normals", "--ao-out", "--ao-out; here it is --occlusion-out\n");
    says("transfer-normals", "--max-distance", "--max-distance; here it is --front and --back\n");
    says("transfer-normals", "--samples", "--samples; here it is --subsamples\n");
    says("convert-normals", "--margin", "--margin; here it is --padding\n");
    says("check-normals", "-j8", "-j; here it is --threads\n");
    says("check-normals", "-r", "-r; here it is --files-from, or a pattern such as 'art/**/*.png'\n");
    says("mip-normals", "--srgb", "--srgb; normals are not colours, and are never converted\n");
    says("bake-normals", "--srgb", "--srgb; here it is --color-space, of heights\n");
    says("compare-normals", "--samples", "--samples\n");
    const Ran tiles = run(scratch, "bake-normals", {"a.png", "--heights", "terrain-rgb"});
    EXPECT_NE(tiles.err.find("; --channel terrain-rgb reads it"), std::string::npos) << tiles.err;
}

TEST(ForeignWords, NameWordsThatAreAccepted) {
    std::set<std::string> encodings, containers, engines;
    for (const auto& row : kEncodingNames) encodings.emplace(row.name);
    for (const auto& row : kContainerNames) containers.emplace(row.name);
    for (const Word& row : engine_words()) engines.insert(row.name);
    const std::set<std::string> tables[] = {encodings, containers, engines, {"up", "down"}, {"repeat", "clamp"}};
    for (const ForeignWord& row : foreign_words()) {
        const auto* const table = std::find_if(std::begin(tables), std::end(tables), [&](const auto& words) {
            return words.contains(std::string(row.word));
        });
        ASSERT_NE(table, std::end(tables)) << row.word;
        for (const std::string& name : split(row.names, ' ')) EXPECT_FALSE(table->contains(name)) << name;
    }
    for (const UnwrittenType& row : unwritten_types()) {
        for (const std::string& name : split(row.names, ' ')) {
            EXPECT_FALSE(encodings.contains(name) || containers.contains(name)) << name << " is written";
            EXPECT_FALSE(container_of("n." + name)) << name;
        }
    }
}

TEST(ForeignWords, AreAnswered) {
    const Scratch scratch;
    scratch.add_sample("ramp.png", "a.png");
    const auto says = [&](const std::vector<std::string>& arguments, const std::string& answer) {
        const Ran ran = run(scratch, "bake-normals", arguments);
        EXPECT_EQ(ran.code, 2);
        EXPECT_NE(ran.err.find(answer), std::string::npos) << ran.err;
        EXPECT_EQ(ran.err.find("did you mean"), std::string::npos) << ran.err;
    };
    says({"a.png", "-o", "a.dds", "--format", "dxt5"}, "not 'dxt5'; here it is dxt5nm\n");
    says({"a.png", "-o", "a.dds", "--format", "BC5_UNORM"}, "; here it is bc5\n");
    says({"a.png", "-o", "a.ktx2", "--format", "etc1s"},
         "; etc1s is not written: make n.png, then run basisu -ktx2 -normal_map n.png\n");
    says({"a.png", "-o", "a.png", "--for", "ue5"}, "; here it is unreal\n");
    says({"a.png", "-o", "a.png", "--for", "LabPBR"}, "; LabPBR is a layout of channels: ");
    says({"a.png", "-o", "a.png", "--for", "skyrim"}, "; that is a layout of channels: pack-normals --layout skyrim");
    says({"a.png", "-o", "a.webp", "--format", "webp"},
         "; webp is a file type: the name of the output ends in .webp, or --container webp\n");
    says({"a.png", "-o", "a.dds", "--quality", "90"}, "of blocks it is --effort");
    for (const char* same : {"bc3n", "bc3nm", "3DC", "ATI2"})
        EXPECT_EQ(run(scratch, "bake-normals", {"a.png", "-o", "a.dds", "--format", same}).code, 0) << same;
}

// The commands in these answers are other people's. Each is run if it is installed.
TEST(ForeignWords, CommandsForWhatIsNotWrittenWork) {
    const Scratch scratch;
    scratch.add_sample("ramp.png", "a.png");
    ASSERT_EQ(run(scratch, "bake-normals", {"a.png", "-o", "n.png"}).code, 0);
    for (const UnwrittenType& row : unwritten_types()) {
        const std::string line(row.command);
        if (!is_installed(line.substr(0, line.find(' ')))) continue;
        const std::vector<std::string> before = scratch.list();
        const Ran ran = shell(scratch, line);
        EXPECT_EQ(ran.code, 0) << line << ": " << ran.err;
        EXPECT_NE(scratch.list(), before) << line;
    }
}

}  // namespace
}  // namespace tex::cli
