// SPDX-License-Identifier: Apache-2.0
// Warnings: each names its file, on standard error and in the JSON of every command.

#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/meshes.h"
#include "cli/program.h"

namespace tex::cli {
namespace {

using nlohmann::json;

}  // namespace

// a.png and b.png do not state their layout, and it is not that of a picture; srgb.dds declares sRGB colours.
class Warnings : public testing::Test {
protected:
    Warnings() {
        scratch_.add_sample("waves.png", "waves.png");
        scratch_.write("sheet.obj", kSheetObj);
        scratch_.add_sample("broken/N111-srgb-format.dds", "srgb.dds");
        const Ran made = shell(scratch_,
                               "bake-normals waves.png -o ag.png --format ag8 --bumpiness 6 --no-sync && "
                               "convert ag.png -strip -define png:color-type=6 a.png && cp a.png b.png && "
                               "bake-normals waves.png -o plain.exr --bumpiness 6 --no-sync && "
                               "convert waves.png -depth 8 -fill red -colorize 30 color.png");
        EXPECT_EQ(made.code, 0) << made.err;
    }

    // The lines of JSON that a command prints with --json --quiet, which must be silent on standard error.
    std::vector<json> quiet(const std::string& command, std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"--json", "--quiet"});
        const Ran ran = run(scratch_, command, arguments);
        EXPECT_EQ(ran.err, "") << command;
        std::vector<json> lines;
        for (const std::string& line : lines_of(ran.out)) lines.push_back(json::parse(line));
        return lines;
    }

    static void expect_warning(const json& line, const std::string& file, const std::string& part) {
        ASSERT_TRUE(line.contains("warnings")) << line;
        ASSERT_EQ(line["warnings"].size(), 1u) << line;
        EXPECT_EQ(line["warnings"][0]["file"], file) << line;
        EXPECT_NE(line["warnings"][0]["message"].get<std::string>().find(part), std::string::npos) << line;
    }
    Scratch scratch_;
};

TEST_F(Warnings, AreInTheJsonOfEveryCommandThatReadsNormals) {
    for (const char* command : {"mip-normals", "pack-normals", "unpack-normals", "scale-normals", "preview-normals",
                                "blend-normals", "convert-normals", "integrate-normals"}) {
        std::vector<std::string> arguments = {"srgb.dds", "plain.exr", "--out-dir", command, "--no-sync"};
        if (std::string_view(command) == "pack-normals") arguments.insert(arguments.end(), {"--mips", "keep"});
        if (std::string_view(command) == "pack-normals" || std::string_view(command) == "mip-normals")
            arguments.insert(arguments.end(), {"--format", "dxt5nm"});
        if (std::string_view(command) == "scale-normals") arguments.insert(arguments.end(), {"--scale", "2"});
        if (std::string_view(command) == "blend-normals") arguments.insert(arguments.end(), {"--detail", "plain.exr"});
        if (std::string_view(command) == "convert-normals")
            arguments.insert(arguments.end(), {"--mesh", "sheet.obj", "--decoder-in", "godot"});
        const auto lines = quiet(command, arguments);
        ASSERT_EQ(lines.size(), 2u) << command;
        expect_warning(lines[0], "srgb.dds", "declares sRGB colours");
        EXPECT_EQ(lines[1]["warnings"], json::array()) << command;
    }
}

TEST_F(Warnings, SayThatTexelsBecomeBlocksUnasked) {
    const auto lines = quiet("pack-normals", {"srgb.dds", "-o", "x.dds", "--mips", "keep", "--no-sync"});
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines[0]["warnings"].dump().find("rgba8 becomes dxt5nm, the default; --format keep keeps it"),
              std::string::npos)
        << lines[0];
}

// Standard error sums up what concerns many files; the JSON does not.
TEST_F(Warnings, AboutGuessesAreInTheLineOfEachFile) {
    const auto lines =
        quiet("pack-normals", {"a.png", "plain.exr", "b.png", "--out-dir", "out", "--mips", "keep", "--no-sync"});
    ASSERT_EQ(lines.size(), 3u);
    expect_warning(lines[0], "a.png", "layout not stated; guessed ");
    EXPECT_EQ(lines[1]["warnings"], json::array());
    expect_warning(lines[2], "b.png", "layout not stated; guessed ");
    const Ran spoken =
        run(scratch_, "pack-normals", {"b.png", "a.png", "--out-dir", "out", "--mips", "keep", "--no-sync"});
    ASSERT_EQ(lines_of(spoken.err).size(), 1u) << spoken.err;
    EXPECT_NE(spoken.err.find("a.png and 1 more: layout not stated"), std::string::npos) << spoken.err;
}

TEST_F(Warnings, NameTheFileThatIsNotTheInput) {
    const auto lines = quiet("blend-normals", {"plain.exr", "--detail", "srgb.dds", "-o", "x.dds", "--no-sync"});
    ASSERT_EQ(lines.size(), 1u);
    expect_warning(lines[0], "srgb.dds", "declares sRGB colours");
    const Ran spoken =
        run(scratch_, "blend-normals", {"plain.exr", "--detail", "srgb.dds", "-o", "x.dds", "--no-sync"});
    EXPECT_NE(spoken.err.find("warning: plain.exr: srgb.dds: declares sRGB"), std::string::npos) << spoken.err;
}

TEST_F(Warnings, AboutHeightsAndComparisonsAreInTheJsonToo) {
    const auto baked =
        quiet("bake-normals", {"color.png", "waves.png", "--out-dir", "out", "--bumpiness", "20", "--no-sync"});
    ASSERT_EQ(baked.size(), 2u);
    expect_warning(baked[0], "color.png", "R, G and B differ in ");
    EXPECT_EQ(baked[1]["warnings"], json::array());
    const auto compared = quiet("compare-normals", {"a.png", "plain.exr"});
    ASSERT_EQ(compared.size(), 1u);
    expect_warning(compared[0], "a.png", "layout not stated; guessed ");
    const auto failed = quiet("check-normals", {"plain.exr"});
    ASSERT_EQ(failed.size(), 1u);
    EXPECT_EQ(failed[0]["warnings"], json::array());
}

// With --drop, too, which silences warnings of channels alone.
TEST_F(Warnings, CountNormalsThatAreNotFinite) {
    constexpr Extent kExtent{4, 4};
    float texels[16][3] = {};
    for (auto& texel : texels) texel[2] = 1.0f;
    texels[0][0] = std::numeric_limits<float>::quiet_NaN();
    texels[5][1] = std::numeric_limits<float>::infinity();
    Texture texture;
    texture.format = Format::rgb32_float;
    texture.levels.push_back({kExtent, std::vector<std::byte>(sizeof texels)});
    std::memcpy(texture.levels[0].bytes.data(), texels, sizeof texels);
    ASSERT_TRUE(write_texture(scratch_.path("bad.exr"), texture));
    for (const std::string command : {"mip-normals", "pack-normals", "unpack-normals"}) {
        const auto lines =
            quiet(command, {"bad.exr", "-o", command == "pack-normals" ? "bad.png" : "bad.dds", "--drop", "--no-sync"});
        expect_warning(lines[0], "bad.exr", "2 texels are NaN or infinite, and become flat");
    }
    const auto blended = quiet("blend-normals", {"plain.exr", "bad.exr", "-o", "blend.dds", "--no-sync"});
    expect_warning(blended[0], "bad.exr", "2 texels are NaN or infinite, and become flat");
}

TEST_F(Warnings, StandBesideAnError) {
    const Ran ran =
        run(scratch_, "pack-normals", {"srgb.dds", "gone.dds", "--name", "{stem}_n.dds", "--json", "--no-sync"});
    EXPECT_EQ(ran.code, 3);
    const auto lines = lines_of(ran.out);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(json::parse(lines[1])["warnings"], json::array());
    EXPECT_TRUE(json::parse(lines[1]).contains("error"));
}

TEST_F(Warnings, EveryLineHasItsTimeAtItsEnd) {
    for (const json& line :
         {quiet("pack-normals", {"plain.exr", "-o", "x.dds", "--no-sync"})[0], quiet("check-normals", {"plain.exr"})[0],
          quiet("compare-normals", {"plain.exr", "plain.exr"})[0]}) {
        EXPECT_GT(line["seconds"].get<double>(), 0.0) << line;
        EXPECT_LT(line["seconds"].get<double>(), 600.0) << line;
    }
    const Ran ran = run(scratch_, "check-normals", {"gone.png", "plain.exr", "--json"});
    for (const std::string& line : lines_of(ran.out))
        EXPECT_NE(without_seconds(line).rfind("\"warnings\":[]}"), std::string::npos) << line;
}

}  // namespace tex::cli
