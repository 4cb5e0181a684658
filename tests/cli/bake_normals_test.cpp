// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {

class BakeNormals : public testing::Test {
protected:
    BakeNormals() {
        scratch_.add_sample("bricks.png", "bricks.png");
        scratch_.add_sample("ramp.png", "ramp.png");
    }
    Ran bake(std::vector<std::string> arguments, const Setting& setting = {}) {
        arguments.push_back("--no-sync");
        return run(scratch_, "bake-normals", arguments, setting);
    }
    std::string bytes_of(std::vector<std::string> arguments, const std::string& output = "bytes.dds") {
        arguments.insert(arguments.end(), {"-o", output, "--effort", "fast"});
        const Ran ran = bake(arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        return scratch_.read(output);
    }
    void refuses(std::vector<std::string> arguments, const std::string& part) {
        arguments.insert(arguments.begin(), "bricks.png");
        arguments.insert(arguments.end(), {"-o", "x.dds"});
        const Ran ran = bake(arguments);
        EXPECT_EQ(ran.code, 2) << part;
        EXPECT_EQ(lines_of(ran.err).size(), 1u) << ran.err;
        EXPECT_NE(ran.err.find(part), std::string::npos) << ran.err;
        EXPECT_FALSE(scratch_.has("x.dds"));
    }
    Scratch scratch_;
};

TEST_F(BakeNormals, MakesTheMipMappedDxt5nmOfTheReadme) {
    const Ran ran = bake({"bricks.png", "-o", "bricks.dds", "--bumpiness", "12", "--json"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    auto report = nlohmann::json::parse(ran.out);
    EXPECT_EQ(report["input"], "bricks.png");
    EXPECT_EQ(report["output"], "bricks.dds");
    EXPECT_EQ(report["extent"], (std::vector<int>{512, 512}));
    EXPECT_EQ(report["levels"], 10);
    EXPECT_EQ(report["format"], "dxt5nm");
    EXPECT_EQ(report["y"], "up");
    EXPECT_EQ(report["bytes"], scratch_.read("bricks.dds").size());
    EXPECT_LT(report["slopes"]["x"][0], report["slopes"]["x"][1]);
    const auto texture = read_texture(scratch_.path("bricks.dds"));
    ASSERT_TRUE(texture);
    EXPECT_EQ(texture->format, Format::bc3_unorm);
    EXPECT_EQ(texture->levels.size(), 10u);
    EXPECT_EQ(texture->levels.back().extent, (Extent{1, 1}));
}

TEST_F(BakeNormals, MakesThePictureOfTheReadme) {
    ASSERT_EQ(bake({"bricks.png", "-o", "normals.png", "--bumpiness", "12"}).code, 0);
    const auto picture = read_image(scratch_.path("normals.png"));
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->planes.size(), 3u);
    EXPECT_EQ(picture->bits, 8);
}

TEST_F(BakeNormals, TheExtensionDecidesTheEncoding) {
    const std::pair<const char*, const char*> expected[] = {{"ktx2", "dxt5nm"}, {"png", "rgb8"}, {"exr", "half"},
                                                            {"tif", "rgb16"},   {"tga", "rgb8"}, {"bmp", "rgb8"},
                                                            {"jpg", "rgb8"},    {"PNG", "rgb8"}};
    for (const auto& [extension, encoding] : expected) {
        const Ran ran = bake({"ramp.png", "-o", std::string("x.") + extension, "--json"});
        ASSERT_EQ(ran.code, 0) << extension << ": " << ran.err;
        auto report = nlohmann::json::parse(ran.out);
        EXPECT_EQ(report["format"], encoding);
        EXPECT_EQ(report["levels"], report["format"] == "dxt5nm" ? 7 : 1) << extension;
        EXPECT_TRUE(read_texture(scratch_.path(std::string("x.") + extension))) << extension;
    }
}

// DDS has no number for EAC, ASTC and UASTC.
TEST_F(BakeNormals, EveryEncodingGoesIntoDdsAndKtx2) {
    for (const Named<Encoding>& row : kEncodingNames) {
        for (const std::string name : {"x.dds", "x.ktx2"}) {
            const Ran ran = bake({"ramp.png", "-o", name, "--format", std::string(row.name), "--effort", "fast"});
            const bool is_held = name == "x.ktx2" || !(row.name.starts_with("eac") || row.name.starts_with("astc") ||
                                                       row.name.starts_with("uastc"));
            EXPECT_EQ(ran.code, is_held ? 0 : 2) << row.name << ": " << ran.err;
            if (!is_held) continue;
            EXPECT_TRUE(read_texture(scratch_.path(name))) << row.name;
        }
    }
}

TEST_F(BakeNormals, StrengthsAreOneOfThree) {
    refuses({"--bumpiness", "1", "--uv-height", "2"}, "--bumpiness and --uv-height contradict each other");
    refuses({"--bumpiness", "1", "--height-range", "2", "--world-size", "1"},
            "--bumpiness and --height-range contradict");
    refuses({"--world-size", "2"}, "--world-size does nothing without --height-range");
    refuses({"--height-range", "2"}, "--height-range needs --world-size");
    refuses({"--height-range", "2", "--world-size", "0"}, "--world-size: 0 is not greater than 0");
    refuses({"--height-range", "2", "--world-size", "2x"}, "--world-size: '' is not a number");
    // 512 texels that cover 64 units: 8 texels for each unit.
    const std::string direct = bytes_of({"bricks.png", "--bumpiness", "8"});
    EXPECT_TRUE(bytes_of({"bricks.png", "--height-range", "1", "--world-size", "64"}) == direct);
    EXPECT_TRUE(bytes_of({"bricks.png", "--height-range", "1", "--world-size", "64x64"}) == direct);
    EXPECT_TRUE(bytes_of({"bricks.png", "--uv-height", "0.015625"}) == direct);
    EXPECT_TRUE(bytes_of({"bricks.png", "--bumpiness", "-8"}) != direct);
}

TEST_F(BakeNormals, NumbersAreChecked) {
    for (const std::string value : {"nan", "inf", "-inf", "1e99", "eight", "8,5", ""}) {
        refuses({"--bumpiness", value}, "--bumpiness: ");
    }
    refuses({"--blur", "-1"}, "--blur: -1 is not at least 0 and at most 256");
    refuses({"--kernel", "sobbel"}, "did you mean sobel?");
    refuses({"--kernel", "gaussian:0"}, "--kernel: 0 is not greater than 0 and at most 64");
    refuses({"--kernel", "sobel:2"}, "sobel takes no sigma");
    refuses({"--wrap", "clamp,mirrro"}, "did you mean mirror?");
    refuses({"--wrap", "clamp,"}, "not ''");
    refuses({"--mips", "0"}, "must be all, none or a number of at least 1");
    refuses({"--mips", "keep"}, "must be all, none or a number of at least 1");
    refuses({"--fade", "3,3"}, "--fade: 3 is not less than 3");
    refuses({"--fade", "-1,3"}, "--fade: -1 is not at least 0");
    refuses({"--no-data", "nothing"}, "--no-data: 'nothing' is not a number");
    EXPECT_EQ(bake({"bricks.png", "-o", "y.dds", "--no-data", "none"}).code, 0);
    EXPECT_EQ(bake({"bricks.png", "-o", "y.dds", "--no-data", "-9999", "--kernel", "gaussian:1.5"}).code, 0);
}

TEST_F(BakeNormals, WarnsOfSlopesThatTheEncodingCannotHold) {
    scratch_.add_sample("waves.png", "waves.png");
    const auto steep = [&](const std::vector<std::string>& options, const std::string& output, bool warns) {
        std::vector<std::string> line = {"waves.png", "-o", output, "--json"};
        line.insert(line.end(), options.begin(), options.end());
        const Ran ran = bake(line);
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_EQ(ran.err.find("are steeper than") != std::string::npos, warns) << ran.err;
        EXPECT_EQ(nlohmann::json::parse(ran.out)["steep_texels"] > 0, warns) << ran.out;
    };
    steep({"--bumpiness", "8"}, "x.dds", false);
    steep({"--bumpiness", "1000"}, "x.dds", true);
    steep({"--bumpiness", "1000", "--format", "rgb16"}, "x.png", false);
    steep({"--bumpiness", "1e9", "--format", "rgb16"}, "x.png", true);
    steep({"--bumpiness", "1e9"}, "x.exr", false);
}

TEST_F(BakeNormals, LevelsGoOnlyWhereTheyFit) {
    const Ran png = bake({"ramp.png", "-o", "x.png", "--mips", "all"});
    EXPECT_EQ(png.code, 2);
    EXPECT_NE(png.err.find("png files hold one level"), std::string::npos) << png.err;
    EXPECT_EQ(bake({"ramp.png", "-o", "x.png", "--mips", "none"}).code, 0);
    EXPECT_EQ(bake({"ramp.png", "-o", "x.png", "--mips", "1"}).code, 0);
    EXPECT_EQ(nlohmann::json::parse(bake({"ramp.png", "-o", "x.exr", "--mips", "all", "--json"}).out)["levels"], 7);
    EXPECT_EQ(nlohmann::json::parse(bake({"ramp.png", "-o", "x.dds", "--mips", "99", "--json"}).out)["levels"], 7);
}

TEST_F(BakeNormals, OptionsChangeTheResult) {
    const std::string plain = bytes_of({"bricks.png"});
    const std::vector<std::vector<std::string>> changes = {{"--kernel", "scharr"},    {"--kernel", "gaussian:2"},
                                                           {"--wrap", "clamp"},       {"--invert"},
                                                           {"--deband", "on"},        {"--blur", "2"},
                                                           {"--y", "down"},           {"--mip-filter", "kaiser"},
                                                           {"--mip-domain", "slope"}, {"--fade", "1,3"},
                                                           {"--dds-header", "dx10"},  {"--dds-mark"},
                                                           {"--color-space", "sRGB"}, {"--mips", "2"},
                                                           {"--format", "bc5"}};
    const std::string base = bytes_of({"bricks.png", "--bumpiness", "4"});
    for (std::vector<std::string> change : changes) {
        const std::string name = change[0];
        change.insert(change.end(), {"bricks.png", "--bumpiness", "4"});
        EXPECT_TRUE(bytes_of(change) != base) << name;
    }
    EXPECT_TRUE(bytes_of({"bricks.png", "--wrap", "repeat,repeat"}) == plain);
}

TEST_F(BakeNormals, DebandSaysWhatItFound) {
    std::string text = "P5\n64 48\n255\n";
    for (int k = 0; k < 64 * 48; ++k) text += static_cast<char>(40 + k % 64 / 8);
    scratch_.write("terraces.pgm", text);
    const Ran ran = bake({"terraces.pgm", "-o", "x.dds", "--deband", "on", "--json"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    const auto report = nlohmann::json::parse(ran.out)["deband"];
    EXPECT_EQ(report["applied"], true);
    EXPECT_NEAR(report["step"], 1.0 / 255.0, 1e-6);
    EXPECT_EQ(report["codes"], 8);
    EXPECT_GT(report["terrace_texels"], 64 * 45);
    EXPECT_FALSE(nlohmann::json::parse(bake({"bricks.png", "-o", "x.dds", "--json"}).out).contains("deband"));
}

TEST_F(BakeNormals, DebandWarnsIfThereAreNoSteps) {
    std::string text = "Pf\n100 90\n-1.0\n";
    for (int k = 0; k < 9000; ++k) {
        const float height = 0.5f + 0.4f * std::sin(0.01f * static_cast<float>(k));
        text.append(reinterpret_cast<const char*>(&height), sizeof(height));
    }
    scratch_.write("fine.pfm", text);
    const Ran warned = bake({"fine.pfm", "-o", "x.dds", "--deband", "on"});
    EXPECT_EQ(warned.code, 0);
    EXPECT_EQ(without_notes(warned.err),
              "bake-normals: warning: fine.pfm: --deband on changes nothing: the heights lie on no common "
              "steps coarser than 12 bits\n");
    const std::string bytes = scratch_.read("x.dds");
    EXPECT_EQ(without_notes(bake({"fine.pfm", "-o", "x.dds", "--deband", "auto"}).err), "");
    EXPECT_TRUE(scratch_.read("x.dds") == bytes);
    EXPECT_EQ(bake({"fine.pfm", "-o", "x.dds", "--deband", "maybe"}).code, 2);
}

// There is nothing to fill here, so holding all heights must give the same bytes as holding a few rows.
TEST_F(BakeNormals, HoldingAllRowsChangesNoByte) {
    const auto baked = [&](const std::string& input, const std::string& output, std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {input, "-o", output, "--effort", "fast"});
        const Ran ran = bake(arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        return scratch_.read(output);
    };
    const auto expect_same = [&](const std::string& input, const std::string& output, std::vector<std::string> rest) {
        SCOPED_TRACE(input + " " + output);
        const std::string rows = baked(input, output, rest);
        rest.emplace_back("--fill-invalid");
        EXPECT_TRUE(baked(input, output, rest) == rows);
    };
    scratch_.add_sample("waves.png", "waves.png");
    expect_same("waves.png", "x.ktx2", {"--blur", "2", "--kernel", "scharr", "--mip-filter", "kaiser"});
    for (const std::string name : {"x.exr", "x.tif", "x.tga", "x.bmp", "x.jpg", "x.dds"}) {
        expect_same("waves.png", name, {"--bumpiness", "9"});
        expect_same(name, "again.dds", {"--channel", "g"});
    }
    // Pictures are written from the top. If heights repeat, the last rows are decoded first.
    for (const std::string name : {"ramp.exr", "ramp.tif"}) EXPECT_EQ(bake({"ramp.png", "-o", name}).code, 0);
    for (const std::string input : {"ramp.png", "ramp.exr", "ramp.tif"}) {
        for (const std::string output : {"y.png", "y.exr"}) {
            for (const std::string wrap : {"repeat", "clamp"})
                expect_same(input, output, {"--wrap", wrap, "--blur", "1"});
        }
    }
    expect_same("ramp.png", "y.exr", {"--mips", "all"});
    EXPECT_EQ(shell(scratch_, "cat waves.png | bake-normals - -o - --container png > z.png").code, 0);
    EXPECT_EQ(shell(scratch_, "bake-normals waves.png -o y.png").code, 0);
    EXPECT_TRUE(scratch_.read("y.png") == scratch_.read("z.png"));
    EXPECT_EQ(bake({"ramp.png", "--name", "x{level}.tga", "--mips", "2"}).code, 0);
    EXPECT_EQ(shell(scratch_, "cat waves.png | bake-normals - -o - --container tga > z.tga").code, 0);
    EXPECT_EQ(shell(scratch_, "bake-normals waves.png -o y.tga").code, 0);
    EXPECT_TRUE(scratch_.read("y.tga") == scratch_.read("z.tga"));
    EXPECT_EQ(bake({"waves.png", "-o", "x.dds", "--json"}).out.find("\"path\""), std::string::npos);
}

TEST_F(BakeNormals, HeightsThatAreInvalidNameTheirRemedy) {
    const auto pfm = [&](const std::string& name, const std::vector<float>& heights) {
        std::string text = fmt::format("Pf\n{} 1\n-1.0\n", heights.size());
        text.append(reinterpret_cast<const char*>(heights.data()), heights.size() * sizeof(float));
        scratch_.write(name, text);
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    pfm("some.pfm", {0.5f, 0.25f, nan, 0.75f, nan});
    pfm("all.pfm", {nan, nan});
    for (const std::string output : {"x.dds", "x.png", "x{level}.dds"}) {  // textures, pictures, levels
        SCOPED_TRACE(output);
        const std::vector<std::string> to = {"--name", output};
        const Ran some = bake({"some.pfm", to[0], to[1]}), all = bake({"all.pfm", to[0], to[1]});
        EXPECT_EQ(some.code, 4);
        EXPECT_EQ(some.err,
                  "bake-normals: error: some.pfm: 2 heights are NaN or infinite, the first at column 2, row 0; "
                  "--fill-invalid fills in the nearest valid ones\n");
        EXPECT_EQ(all.code, 4);
        EXPECT_EQ(all.err, "bake-normals: error: all.pfm: no texel has a height: all are NaN or infinite\n");
        EXPECT_EQ(bake({"some.pfm", to[0], to[1], "--fill-invalid"}).code, 0);
    }
}

TEST_F(BakeNormals, AnElevationModelIsItsHeightsInOtherFiles) {
    const int width = 5, height = 4;
    std::string grid = "ncols 5\nnrows 4\ncellsize 30\nNODATA_value -1\n", pfm = "Pf\n5 4\n-1.0\n", bil;
    const auto height_at = [](int i, int j) { return i == 2 && j == 1 ? -1 : 40 * i * i + 7 * i * j + 13 * j; };
    for (int j = 0; j < height; ++j) {
        for (int i = 0; i < width; ++i) {
            grid += fmt::format("{} ", height_at(i, j));
            bil += static_cast<char>(height_at(i, j) & 0xff);
            bil += static_cast<char>(height_at(i, j) >> 8 & 0xff);
            const auto value = static_cast<float>(height_at(i, height - 1 - j));  // PFM has its rows from the bottom
            pfm.append(reinterpret_cast<const char*>(&value), sizeof value);
        }
    }
    scratch_.write("h.asc", grid);
    scratch_.write("h.pfm", pfm);
    scratch_.write("b.bil", bil);
    scratch_.write("b.hdr", "NROWS 4\nNCOLS 5\nNBITS 16\nBYTEORDER I\nNODATA -1\n");
    const std::vector<std::string> rest = {"--height-range", "1",     "--world-size",  "150",
                                           "--wrap",         "clamp", "--fill-invalid"};
    const auto baked = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), rest.begin(), rest.end());
        arguments.insert(arguments.end(), {"-o", "x.exr", "--format", "float"});
        const Ran ran = bake(arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        return scratch_.read("x.exr");
    };
    const std::string expected = baked({"h.pfm", "--no-data", "-1"});
    EXPECT_EQ(baked({"h.asc"}), expected);
    EXPECT_EQ(baked({"b.bil"}), expected);
    EXPECT_NE(baked({"h.asc", "--no-data", "none"}), expected);
    EXPECT_EQ(baked({"b.bil", "--depfile", "d"}), expected);
    EXPECT_EQ(scratch_.read("d"), "x.exr: \\\n  b.bil \\\n  b.hdr\n");
    const Ran holes = bake({"b.bil", "-o", "x.png"});
    EXPECT_EQ(holes.code, 4);
    EXPECT_EQ(holes.err,
              "bake-normals: error: b.bil: 1 height is NaN, infinite or no-data, the first at column 2, row 1; "
              "--fill-invalid fills in the nearest valid ones\n");
}

TEST_F(BakeNormals, ThreadsDoNotChangeTheBytes) {
    const std::string one = bytes_of({"bricks.png", "--threads", "1"});
    for (const std::string count : {"2", "3", "16"}) EXPECT_TRUE(bytes_of({"bricks.png", "--threads", count}) == one);
}

TEST_F(BakeNormals, OneThreadMeansNoOther) {
    if (!is_installed("strace")) GTEST_SKIP() << "no strace";
    // The leak sanitizer uses its own thread for its check, and does not work under strace.
    const Ran ran = shell(scratch_,
                          "ASAN_OPTIONS=detect_leaks=0 strace -f -qq -e trace=clone,clone3,fork,vfork "
                          "bake-normals bricks.png -o x.dds --threads 1 --bumpiness 1");
    EXPECT_EQ(ran.code, 0);
    EXPECT_EQ(ran.err, "");
}

TEST_F(BakeNormals, OpenImageIOIsNotLoadedWhereItIsNotNeeded) {
    const Ran linked = shell(scratch_, "ldd $(command -v bake-normals)");
    EXPECT_EQ(linked.out.find("OpenImageIO"), std::string::npos) << linked.out;
    for (const std::string line : {"bake-normals --version", "bake-normals ramp.png -o ramp.dds"}) {
        const Ran traced = shell(scratch_, "LD_DEBUG=files LD_DEBUG_OUTPUT=loaded " + line + " && cat loaded.*");
        EXPECT_EQ(traced.code, 0);
        EXPECT_NE(traced.out.find("libtbb"), std::string::npos);
        EXPECT_EQ(traced.out.find("OpenImageIO"), std::string::npos) << line;
        EXPECT_EQ(traced.out.find("tex-reader"), std::string::npos) << line;
    }
}

TEST_F(BakeNormals, ColourSpacesAreCheckedBeforeAnyWork) {
    refuses({"--color-space", "chartreuse"}, "--color-space: ");
    refuses({"--ocio-config", "x.ocio"}, "--ocio-config does nothing without --color-space");
    EXPECT_EQ(bake({"ramp.png", "-o", "x.dds", "--color-space", "sRGB", "--ocio-config", "missing.ocio"}).code, 3);
    EXPECT_FALSE(scratch_.has("x.dds"));
    Setting configured;
    configured.environment = {"OCIO=" + scratch_.path("missing.ocio")};
    EXPECT_EQ(bake({"ramp.png", "-o", "x.dds", "--color-space", "sRGB"}, configured).code, 3);
    EXPECT_EQ(bake({"ramp.png", "-o", "x.dds"}, configured).code, 0);  // $OCIO does not affect raw data
}

TEST_F(BakeNormals, TheColourConfigurationIsADependency) {
    scratch_.write("c.ocio",
                   "ocio_profile_version: 2\nroles: {scene_linear: lin, default: lin}\n"
                   "displays: {d: [!<View> {name: v, colorspace: lin}]}\nactive_displays: []\nactive_views: []\n"
                   "colorspaces:\n  - !<ColorSpace> {name: lin}\n  - !<ColorSpace> {name: enc, to_scene_reference: "
                   "!<ExponentTransform> {value: [2.2, 2.2, 2.2, 1]}}\n");
    const Ran ran =
        bake({"ramp.png", "-o", "x.dds", "--color-space", "enc", "--ocio-config", "c.ocio", "--depfile", "d"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(scratch_.read("d"), "x.dds: \\\n  ramp.png \\\n  c.ocio\n");
    const std::string before = scratch_.read("c.ocio");
    EXPECT_EQ(
        bake({"ramp.png", "-o", "x.dds", "--color-space", "enc", "--ocio-config", "c.ocio", "--depfile", "c.ocio"})
            .code,
        2);
    EXPECT_EQ(scratch_.read("c.ocio"), before) << "what is read is never written";
}

TEST_F(BakeNormals, GuessedHeightsAreToldOnceWithCounts) {
    scratch_.add_sample("report.png", "colour.png");  // a picture with different channels
    std::filesystem::copy_file(scratch_.path("colour.png"), scratch_.path("more.png"));
    const Ran ran = bake({"colour.png", "bricks.png", "more.png", "--out-dir", "out"});
    EXPECT_EQ(ran.code, 0);
    ASSERT_EQ(lines_of(without_notes(ran.err)).size(), 1u) << ran.err;
    EXPECT_NE(ran.err.find(": R, G and B differ in "), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("colour.png and 1 more: "), std::string::npos) << ran.err;
    EXPECT_EQ(bake({"colour.png", "-o", "x.dds", "--quiet"}).err, "");
    EXPECT_EQ(without_notes(bake({"colour.png", "-o", "x.dds", "--channel", "luma"}).err), "");
    const Ran missing = bake({"bricks.png", "-o", "z.dds", "--channel", "a"});  // an error of the file
    EXPECT_EQ(missing.code, 4);
    EXPECT_EQ(lines_of(missing.err).size(), 1u) << missing.err;
    EXPECT_FALSE(scratch_.has("z.dds"));
}

// Textures with alpha alone, in which engines keep masks and heights: their one channel is the height, not a normal
// map.
TEST_F(BakeNormals, AlphaAloneIsAHeight) {
    ASSERT_EQ(bake({"ramp.png", "-o", "rgba.dds", "--format", "rgba8", "--mips", "none"}).code, 0);
    const auto heights = read_image(scratch_.path("ramp.png"));
    ASSERT_TRUE(heights);
    std::string alpha = scratch_.read("rgba.dds").substr(0, 128);
    alpha.replace(80, 28,
                  std::string("\x02\0\0\0"
                              "\0\0\0\0"
                              "\x08\0\0\0"
                              "\0\0\0\0"
                              "\0\0\0\0"
                              "\0\0\0\0"
                              "\xff\0\0\0",
                              28));  // DDPF_ALPHA, 8 bits
    for (int j = 0; j < heights->extent().height; ++j) {
        for (int i = 0; i < heights->extent().width; ++i)
            alpha += static_cast<char>(std::lround(heights->planes[0].at(i, j) * 255.0f));
    }
    scratch_.write("alpha.dds", alpha);
    const std::string wanted = bytes_of({"ramp.png"});
    EXPECT_TRUE(bytes_of({"alpha.dds"}) == wanted);
    EXPECT_TRUE(bytes_of({"alpha.dds", "--channel", "a"}) == wanted);
    for (const std::string command : {"pack-normals alpha.dds -o x.dds", "compare-normals alpha.dds alpha.dds",
                                      "preview-normals alpha.dds -o x.png"}) {
        const Ran ran = shell(scratch_, command);
        EXPECT_EQ(ran.code, 4) << command;
        EXPECT_NE(ran.err.find("alpha.dds: has one channel, which holds no normals (bake-normals reads heights)\n"),
                  std::string::npos)
            << ran.err;
    }
}

TEST_F(BakeNormals, FilesThatClaimTooMuchAreRefused) {
    const Ran ran = bake({"bricks.png", "-o", "x.dds", "--max-texels", "1K"});
    EXPECT_EQ(ran.code, 4);
    EXPECT_EQ(lines_of(ran.err).size(), 1u) << ran.err;
    EXPECT_EQ(bake({"bricks.png", "-o", "x.dds", "--max-texels", "256K"}).code, 0);
    // Files that are also larger than the limit allows for their bytes say why in texels.
    ASSERT_EQ(bake({"bricks.png", "-o", "big.dds", "--format", "float", "--mips", "none"}).code, 0);
    for (const std::string command : {"pack-normals", "preview-normals", "check-normals"}) {
        const Ran large =
            shell(scratch_, command + " big.dds --max-texels 1K" + (command[0] == 'c' ? "" : " -o y.png"));
        EXPECT_EQ(large.code, 4) << command;
        EXPECT_NE((large.err + large.out).find("512x512 texels are more than the limit of 1024"), std::string::npos)
            << large.err;
    }
}

}  // namespace tex::cli
