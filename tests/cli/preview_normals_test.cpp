// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "cli/unmarked.h"

namespace tex::cli {

class PreviewNormals : public testing::Test {
protected:
    PreviewNormals() {
        scratch_.add_sample("bricks.png", "height.png");
        scratch_.add_sample("hemisphere.png", "small.png");
        bake("height.png", "bricks.dds");
        bake("small.png", "small.png.dds");
    }
    void bake(const std::string& from, const std::string& to, const std::string& y = "up") {
        EXPECT_EQ(run(scratch_, "bake-normals",
                      {from, "-o", to, "--bumpiness", "12", "--y", y, "--effort", "fast", "--no-sync"})
                      .code,
                  0);
    }
    Ran preview(std::vector<std::string> arguments) {
        arguments.push_back("--no-sync");
        return run(scratch_, "preview-normals", arguments);
    }
    Extent extent_of(const std::string& name) {
        const auto image = read_image(scratch_.path(name));
        EXPECT_TRUE(image) << name;
        return image ? image->extent() : Extent{};
    }
    // Expects a refusal with a sentence that contains `part`, and no output.
    void refuses(const std::vector<std::string>& arguments, const std::string& part, int code = 2) {
        const auto before = scratch_.list();
        std::vector<std::string> quiet = arguments;
        quiet.push_back("--quiet");  // guesses of layouts are warnings
        const Ran ran = preview(quiet);
        EXPECT_EQ(ran.code, code) << part;
        EXPECT_EQ(lines_of(ran.err).size(), 1u) << ran.err;
        EXPECT_NE(ran.err.find(part), std::string::npos) << ran.err;
        EXPECT_EQ(scratch_.list(), before) << part;
    }
    Scratch scratch_;
};

TEST_F(PreviewNormals, LightsAMapInItsOwnSize) {
    const Ran ran = preview({"bricks.dds", "-o", "lit.png", "--json"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const auto report = nlohmann::json::parse(ran.out);
    EXPECT_EQ(report["input"], "bricks.dds");
    EXPECT_EQ(report["output"], "lit.png");
    EXPECT_EQ(report["extent"], (std::vector<int>{512, 512}));
    EXPECT_EQ(report["frames"], 1);
    EXPECT_EQ(report["bytes"], scratch_.read("lit.png").size());
    EXPECT_EQ(extent_of("lit.png"), (Extent{512, 512}));
}

TEST_F(PreviewNormals, ShowsEverythingThatHasAName) {
    for (const auto& row : kShowNames) {
        if (row.value == Show::tangents || row.value == Show::uv || row.value == Show::seams) continue;  // of a mesh
        const std::string name = "show_" + std::string(row.name) + ".png";
        const Ran ran = preview(
            {"bricks.dds", "-o", name, "--show", std::string(row.name), "--height", "height.png", "--size", "64"});
        ASSERT_EQ(ran.code, 0) << row.name << ": " << ran.err;
        EXPECT_GE(extent_of(name).width, 64) << row.name;
    }
}

TEST_F(PreviewNormals, PutsMapsInRowsOfASheet) {
    ASSERT_EQ(
        preview({"bricks.dds", "small.png.dds", "-o", "sheet.png", "--show", "lit,normals,plain", "--size", "50"}).code,
        0);
    EXPECT_EQ(extent_of("sheet.png"), (Extent{3 * 50 + 4 * 8, 2 * (50 + 14) + 3 * 8}));
    ASSERT_EQ(
        preview({"bricks.dds", "small.png.dds", "-o", "bare.png", "--size", "50", "--columns", "1", "--no-captions"})
            .code,
        0);
    EXPECT_EQ(extent_of("bare.png"), (Extent{50 + 16, 2 * 50 + 24}));
}

// Files of one name in the folders of two engines.
TEST_F(PreviewNormals, CaptionsTellFilesOfOneNameApart) {
    for (const char* folder : {"unity", "unreal"}) {
        std::filesystem::create_directory(scratch_.path(folder));
        std::filesystem::copy_file(scratch_.path("bricks.dds"), scratch_.path(std::string(folder) + "/bricks.dds"));
    }
    const std::string a = "unity/bricks.dds", b = "unreal/bricks.dds";
    ASSERT_EQ(preview({a, b, "-o", "ab.png", "--size", "100"}).code, 0);
    ASSERT_EQ(preview({b, a, "-o", "ba.png", "--size", "100"}).code, 0);
    EXPECT_NE(scratch_.read("ab.png"), scratch_.read("ba.png"));
    ASSERT_EQ(preview({a, b, "-o", "ab.png", "--size", "100", "--no-captions"}).code, 0);
    ASSERT_EQ(preview({b, a, "-o", "ba.png", "--size", "100", "--no-captions"}).code, 0);
    EXPECT_EQ(scratch_.read("ab.png"), scratch_.read("ba.png"));
}

TEST_F(PreviewNormals, ASheetDoesWithoutADamagedMap) {
    scratch_.write("cut.dds", scratch_.read("bricks.dds").substr(0, 3000));
    const Ran ran = preview({"bricks.dds", "cut.dds", "none.png", "small.png.dds", "-o", "sheet.png", "--show",
                             "lit,normals", "--size", "50", "--json"});
    EXPECT_EQ(ran.code, 4) << "the highest";
    const auto lines = lines_of(ran.err);
    ASSERT_EQ(lines.size(), 2u) << ran.err;
    EXPECT_TRUE(lines[0].starts_with("preview-normals: error: cut.dds: truncated")) << ran.err;
    EXPECT_EQ(lines[1], "preview-normals: error: none.png: no such file or directory");
    EXPECT_EQ(extent_of("sheet.png"), (Extent{2 * 50 + 3 * 8, 4 * (50 + 14) + 5 * 8}));
    const auto report = nlohmann::json::parse(ran.out);
    EXPECT_EQ(report["failed"][0]["file"], "cut.dds");
    EXPECT_EQ(report["failed"][1]["code"], "io");
    EXPECT_EQ(report["maps"].size(), 4u);
    EXPECT_EQ(report["show"].dump(), R"(["lit","normals"])");
    // The other maps are shown as without it.
    ASSERT_EQ(preview({"bricks.dds", "small.png.dds", "-o", "two.png", "--show", "lit,normals", "--size", "50"}).code,
              0);
    const Ran same = shell(scratch_,
                           "for y in 'sheet 0' 'two 0' 'sheet 216' 'two 72'; do set -- $y;"
                           "convert $1.png -crop 124x72+0+$2 +repage rgb:- | sha256sum; done | uniq | wc -l");
    EXPECT_EQ(same.out, "2\n") << same.err;
    // Without any map there is no sheet; two halves need both.
    const Ran none = preview({"cut.dds", "none.png", "-o", "no.png"});
    EXPECT_EQ(none.code, 4);
    EXPECT_EQ(lines_of(none.err).size(), 2u) << none.err;
    EXPECT_FALSE(scratch_.has("no.png"));
    EXPECT_EQ(preview({"bricks.dds", "cut.dds", "-o", "no.png", "--split"}).code, 4);
    EXPECT_FALSE(scratch_.has("no.png"));
}

TEST_F(PreviewNormals, WarningsOnASheetNameTheirFile) {
    bake("height.png", "down.png", "down");
    bake("height.png", "up.png");
    remove_marks(scratch_, "down.png");
    remove_marks(scratch_, "up.png");
    const Ran ran = preview({"up.png", "down.png", "-o", "sheet.png", "--size", "50"});
    EXPECT_EQ(ran.code, 0);
    EXPECT_TRUE(ran.err.starts_with("preview-normals: warning: down.png: green is taken to point up")) << ran.err;
    EXPECT_EQ(lines_of(ran.err).size(), 1u) << ran.err;
}

TEST_F(PreviewNormals, MakesAPictureOfEachMapInAFolder) {
    const Ran ran = preview({"bricks.dds", "small.png.dds", "--out-dir", "out", "--size", "40", "--depfile", "d"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(extent_of("out/bricks.png"), (Extent{40, 40}));
    EXPECT_TRUE(scratch_.has("out/small.png.png"));
    EXPECT_EQ(scratch_.read("d"), "out/bricks.png: \\\n  bricks.dds\nout/small.png.png: \\\n  small.png.dds\n");
}

TEST_F(PreviewNormals, GreenThatIsUpsideDownChangesThePictureUntilItIsTold) {
    bake("height.png", "down.png", "down");
    bake("height.png", "up.png");
    const auto bytes = [&](const std::string& map, std::vector<std::string> more) {
        more.insert(more.begin(), {map, "-o", "x.png", "--size", "96", "--shape", "sphere"});
        EXPECT_EQ(preview(more).code, 0);
        return scratch_.read("x.png");
    };
    const std::string right = bytes("up.png", {});
    EXPECT_NE(bytes("down.png", {}), right);
    // With the right --y-in, the picture is the same except for codes 127 and 128, which are not mirror images of each
    // other.
    bytes("down.png", {"--y-in", "down"});
    const auto told = read_image(scratch_.path("x.png"));
    bytes("up.png", {});
    const auto up = read_image(scratch_.path("x.png"));
    ASSERT_TRUE(told && up);
    float largest = 0.0f;
    for (int j = 0; j < 96; ++j) {
        for (int i = 0; i < 96; ++i)
            largest = std::max(largest, std::abs(told->planes[0].at(i, j) - up->planes[0].at(i, j)));
    }
    EXPECT_LE(largest, 4.5f / 255.0f);
}

TEST_F(PreviewNormals, ReadsMapsAsTheOtherCommandsDo) {
    const auto bake_as = [&](const std::string& to, const std::string& format) {
        EXPECT_EQ(
            run(scratch_, "bake-normals", {"small.png", "-o", to, "--format", format, "--bumpiness", "60", "--no-sync"})
                .code,
            0);
    };
    const auto bytes = [&](std::vector<std::string> arguments, const std::string& warning = "") {
        arguments.insert(arguments.end(), {"-o", "x.png", "--size", "48"});
        const Ran ran = preview(arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_NE(ran.err.find(warning), std::string::npos) << ran.err;
        EXPECT_EQ(ran.err.empty(), warning.empty()) << ran.err;
        return scratch_.read("x.png");
    };
    bake_as("ag.png", "ag8");
    remove_marks(scratch_, "ag.png");
    const std::string told = bytes({"ag.png", "--swizzle", "dxt5nm"});
    EXPECT_EQ(bytes({"ag.png"}, "ag.png: layout not stated; guessed dxt5nm from the texels"), told);
    EXPECT_NE(bytes({"ag.png", "--swizzle", "rgb"}), told);
    bake_as("xy.dds", "bc5");
    const std::string xy = bytes({"xy.dds"});
    EXPECT_EQ(bytes({"xy.dds", "--bc5-order", "xy"}), xy);
    EXPECT_NE(bytes({"xy.dds", "--bc5-order", "yx"}), xy);
    bake_as("n.exr", "half");
    EXPECT_NE(bytes({"n.exr", "--range", "unsigned"}, "as in object space"), bytes({"n.exr"}));
    bake_as("rgb.png", "rgb8");
    EXPECT_NE(bytes({"rgb.png", "--snap-flat", "--show", "tilt"}), bytes({"rgb.png", "--show", "tilt"}));
    // A detail is read in the same way.
    const std::string detailed =
        bytes({"rgb.png", "--detail", "ag.png"}, "ag.png: layout not stated; guessed dxt5nm from the texels");
    EXPECT_NE(bytes({"rgb.png", "--swizzle", "rgb", "--detail", "ag.png"}), detailed);
    EXPECT_EQ(preview({"ag.png", "-o", "x.png", "--swizzle", "rg_"}).code, 2);
}

TEST_F(PreviewNormals, SplitsAndComparesTwoMaps) {
    bake("height.png", "soft.png");
    ASSERT_EQ(preview({"bricks.dds", "soft.png", "-o", "split.png", "--split", "--size", "100"}).code, 0);
    EXPECT_EQ(extent_of("split.png"), (Extent{100, 118}));
    ASSERT_EQ(preview({"bricks.dds", "soft.png", "-o", "both.png", "--difference", "--size", "100"}).code, 0);
    EXPECT_GE(extent_of("both.png").width, 512);
    refuses({"bricks.dds", "-o", "x.png", "--split"}, "--split takes two maps and -o, one is given");
    refuses({"bricks.dds", "soft.png", "--out-dir", "out", "--difference"}, "--difference takes two maps");
    refuses({"bricks.dds", "small.png.dds", "-o", "x.png", "--difference"},
            "small.png.dds: is not as large as the other map", 4);
}

TEST_F(PreviewNormals, TurnsATurntable) {
    const Ran ran =
        preview({"bricks.dds", "-o", "turn.png", "--shape", "cube", "--turntable", "3", "--size", "48", "--json"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(nlohmann::json::parse(ran.out)["frames"], 3);
    const std::string file = scratch_.read("turn.png");
    EXPECT_NE(file.find("acTL"), std::string::npos);
    EXPECT_EQ(extent_of("turn.png"), (Extent{48, 48}));
    refuses({"bricks.dds", "-o", "turn.tga", "--turntable", "3"}, "turn.tga: --turntable writes PNG");
}

TEST_F(PreviewNormals, TakesTheWholeMaterial) {
    scratch_.add_sample("waves.png", "albedo.png");
    const Ran ran = preview({"bricks.dds",
                             "-o",
                             "all.png",
                             "--size",
                             "80x60",
                             "--shape",
                             "tiled:2x1",
                             "--albedo",
                             "albedo.png",
                             "--detail",
                             "small.png.dds",
                             "--detail-albedo",
                             "albedo.png",
                             "--detail-tiling",
                             "4,2",
                             "--detail-offset",
                             "0.5",
                             "--detail-scale",
                             "0.5",
                             "--height",
                             "height.png",
                             "--parallax",
                             "0.05",
                             "--parallax-steps",
                             "8",
                             "--parallax-limit",
                             "0.2",
                             "--camera",
                             "-30,20,40",
                             "--light",
                             "-1,1,2",
                             "--light-kind",
                             "point",
                             "--light-color",
                             "2,1.8,1.5",
                             "--ambient",
                             "0.1",
                             "--occlusion",
                             "height.png",
                             "--tint",
                             "1",
                             "--specular",
                             "0.1,0.2,0.3",
                             "--shininess",
                             "50",
                             "--specular-model",
                             "blinn",
                             "--bump-scale",
                             "0.8",
                             "--scale-mode",
                             "xy",
                             "--wrap",
                             "clamp,repeat",
                             "--anisotropy",
                             "16",
                             "--mirror"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(extent_of("all.png"), (Extent{80, 60}));
}

// Without other light, a picture of a white plane is its occlusion.
TEST_F(PreviewNormals, OcclusionDarkensAmbientLightAlone) {
    ASSERT_EQ(run(scratch_, "bake-normals",
                  {"height.png", "-o", "n.png", "--bumpiness", "12", "--occlusion-out", "ao.png", "--no-sync"})
                  .code,
              0);
    const auto with = [&](const std::string& name, std::vector<std::string> more) {
        more.insert(more.begin(), {"n.png", "-o", name, "--tint", "1", "--specular", "0", "--occlusion", "ao.png"});
        EXPECT_EQ(preview(more).code, 0);
        return read_image(scratch_.path(name)).value();
    };
    const Image ambient = with("ambient.png", {"--ambient", "1", "--light-color", "0"});
    const Image occlusion = read_image(scratch_.path("ao.png")).value();
    for (int i = 0; i < ambient.extent().width; i += 7) {
        const double srgb = static_cast<double>(ambient.planes[0].at(i, 100));
        const double linear = srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
        EXPECT_NEAR(linear, static_cast<double>(occlusion.planes[0].at(i, 100)), 0.006) << i;
    }
    with("direct.png", {"--ambient", "0"});
    ASSERT_EQ(preview({"n.png", "-o", "open.png", "--tint", "1", "--specular", "0", "--ambient", "0"}).code, 0);
    EXPECT_EQ(scratch_.read("direct.png"), scratch_.read("open.png"));
    refuses({"n.png", "-o", "x.png", "--occlusion", "none.png"}, "none.png", 3);
}

// The heights of a bake's normals are those of its height map.
TEST_F(PreviewNormals, TakesHeightsFromTheNormalsIfThereIsNoHeightMap) {
    ASSERT_EQ(run(scratch_, "bake-normals",
                  {"height.png", "-o", "n.exr", "--format", "float", "--bumpiness", "12", "--no-sync"})
                  .code,
              0);
    const auto picture = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {"n.exr", "-o", "x.png", "--size", "96", "--no-legend"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Ran ran = preview(arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        return std::move(read_image(scratch_.path("x.png")).value());
    };
    const auto largest_difference = [](const Image& a, const Image& b) {
        float largest = 0.0f;
        for (int k = 0; k < 96 * 96; ++k)
            largest = std::max(largest, std::abs(a.planes[0].at(k % 96, k / 96) - b.planes[0].at(k % 96, k / 96)));
        return largest;
    };
    EXPECT_LT(
        largest_difference(picture({"--show", "height"}), picture({"--show", "height", "--height", "height.png"})),
        3.0f / 255.0f);
    // Heights from a file, from 0 to 1.
    const Ran ran =
        run(scratch_, "integrate-normals", {"n.exr", "-o", "h.exr", "--heights", "fit", "--json", "--no-sync"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const double highest = nlohmann::json::parse(ran.out)["heights"]["highest"];
    const std::vector<std::string> look = {"--camera", "40,30", "--parallax-steps", "32", "--parallax"};
    const auto lit = [&](const std::string& amount, const std::vector<std::string>& more) {
        std::vector<std::string> arguments = look;
        arguments.push_back(amount);
        arguments.insert(arguments.end(), more.begin(), more.end());
        return picture(arguments);
    };
    const Image by_itself = lit("auto", {}), flat = lit("0", {}),
                told = lit(fmt::format("{}", highest / 512.0), {"--height", "h.exr"});
    EXPECT_GT(largest_difference(by_itself, flat), 0.2f);
    EXPECT_LT(largest_difference(by_itself, told), 3.0f / 255.0f);
    EXPECT_GT(largest_difference(lit("-0.02", {}), by_itself), 0.2f);
}

TEST_F(PreviewNormals, DebandsTheHeightMap) {
    std::string text = "P5\n64 48\n255\n";
    for (int k = 0; k < 64 * 48; ++k) text += static_cast<char>(40 + k % 64 / 8);
    scratch_.write("terraces.pgm", text);
    const auto shown = [&](const char* when) {
        const Ran ran = preview({"bricks.dds", "-o", "x.png", "--height", "terraces.pgm", "--deband", when,
                                 "--parallax", "0.5", "--parallax-steps", "32", "--size", "64", "--json"});
        EXPECT_EQ(ran.code, 0) << ran.err;
        return nlohmann::json::parse(ran.out);
    };
    EXPECT_FALSE(shown("off").contains("deband"));
    const std::string terraces = scratch_.read("x.png");
    EXPECT_EQ(shown("on")["deband"]["codes"], 8);
    EXPECT_NE(scratch_.read("x.png"), terraces);
    const std::string smooth = scratch_.read("x.png");
    EXPECT_EQ(shown("auto")["deband"]["applied"], true);
    EXPECT_EQ(scratch_.read("x.png"), smooth);
}

TEST_F(PreviewNormals, RefusesHeightsOfMapsWithoutSlopes) {
    scratch_.add_sample("broken/N213-object-space.png", "object.png");
    refuses({"object.png", "-o", "x.png", "--show", "height"}, "object.png: z is negative in", 4);
    EXPECT_EQ(preview({"object.png", "-o", "x.png", "--show", "curvature"}).code, 0);
}

TEST_F(PreviewNormals, RefusesMisuse) {
    const auto with = [](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"bricks.dds", "-o", "x.png"});
        return arguments;
    };
    refuses(with({"--show", "lti"}), "must be one of lit, plain");
    refuses(with({"--height", "height.png", "--parallax", "auto"}), "leave out --height");
    refuses(with({"--shape", "spere"}), "did you mean sphere?");
    refuses(with({"--shape", "tiled:0x2"}), "--shape: 0 is not at least 1");
    refuses(with({"--shape", "tiled"}), "not 'tiled'");
    refuses(with({"--size", "0"}), "--size: 0 is not at least 1");
    refuses(with({"--size", "10x"}), "--size");
    refuses(with({"--light", "0,0,0"}), "0,0,0 is neither a direction nor a place beside the surface");
    refuses(with({"--light", "1,2"}), "'1,2' is not 3 numbers");
    refuses(with({"--light", "nan,0,1"}), "--light");
    refuses(with({"--tint", "1,2"}), "neither one value nor R,G,B");
    refuses(with({"--tint", "-1"}), "--tint: -1 is not at least 0");
    refuses(with({"--camera", "0,90"}), "the pitch is -89 to 89 degrees");
    refuses(with({"--camera", "0,0,150"}), "FOV is 0 to 120 degrees");
    refuses(with({"--shininess", "0"}), "--shininess");
    refuses(with({"--parallax", "high"}), "--parallax");
    refuses(with({"--height", "height.png", "--parallax-steps", "4"}), "--parallax-steps needs --parallax");
    refuses(with({"--deband", "on"}), "--deband needs --height");
    refuses(with({"--detail-scale", "2"}), "--detail-scale needs --detail");
    refuses(with({"--anisotropy", "17"}), "--anisotropy");
    refuses({"bricks.dds", "-o", "x.exr"}, "exr files cannot hold rgb8");
    refuses({"bricks.dds", "--name", "{stem}_{level}.png"}, "{level} has no meaning");
    refuses({"bricks.dds", "-o", "height.png", "--height", "height.png"},
            "the output height.png is the input height.png");
    refuses({"bricks.dds", "small.png.dds", "-o", "small.png.dds"}, "is the input");
    refuses({"missing.dds", "-o", "x.png"}, "missing.dds: no such file", 3);
    refuses({"bricks.dds", "missing.dds", "-o", "x.png", "--split"}, "missing.dds: no such file", 3);
    refuses({"height.png", "-o", "x.png"}, "height.png: ", 4);
}

}  // namespace tex::cli
