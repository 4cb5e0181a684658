// SPDX-License-Identifier: Apache-2.0
// --for: what each engine gets, what overrides it, and the recipes of normal-maps-engines(7).

#include <algorithm>
#include <fstream>
#include <utility>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {
namespace {

struct WantedFile {
    const char* engine;
    const char* file;
    const char* format;
    const char* y;
    int levels;
};

// Written out again, so that a slip in the table of the commands shows.
constexpr WantedFile kWanted[] = {
    {"unity", "rock.png", "rgb8", "up", 1},         {"unreal", "rock.png", "rgb8", "down", 1},
    {"godot", "rock.png", "rgb8", "up", 1},         {"gltf", "rock.png", "rgb8", "up", 1},
    {"three", "rock.png", "rgb8", "up", 1},         {"three-packed", "rock.ktx2", "bc5", "up", 10},
    {"babylon", "rock.png", "rgb8", "up", 1},       {"playcanvas", "rock.png", "rgb8", "up", 1},
    {"phaser", "rock.png", "rgb8", "up", 1},        {"blender", "rock.png", "rgb16", "up", 1},
    {"bevy", "rock.ktx2", "bc5", "up", 10},         {"o3de", "rock_normal.png", "rgb8", "down", 1},
    {"android", "rock.ktx2", "eac-rg11", "up", 10}, {"ios", "rock.ktx2", "eac-rg11", "up", 10},
    {"gltf-ktx2", "rock.ktx2", "uastc", "up", 10},  {"cesium", "rock.png", "rgb8", "up", 1},
    {"filament", "rock.png", "rgb8", "up", 1},
};

std::string all_engines() {
    std::string names;
    for (const WantedFile& wanted : kWanted) names += (names.empty() ? "" : ",") + std::string(wanted.engine);
    return names;
}

class Engines : public testing::Test {
protected:
    Engines() { scratch_.add_sample("bricks.png", "rock.png"); }
    Ran sh(const std::string& line) { return shell(scratch_, line + " --no-sync"); }
    void does(const std::string& line) {
        const Ran ran = sh(line);
        EXPECT_EQ(ran.code, 0) << line << ": " << ran.err;
        EXPECT_EQ(ran.err, "") << line;
    }
    void fails(const std::string& line, const std::string& reason) {
        const Ran ran = sh(line);
        EXPECT_EQ(ran.code, 2) << line;
        EXPECT_NE(ran.err.find(reason), std::string::npos) << line << ": " << ran.err;
    }
    // The first bytes say the file type, the texels say the format, the levels and y, and so does the mark.
    void expect_fits(const WantedFile& wanted, const std::string& file) {
        SCOPED_TRACE(file);
        const bool is_png = file.ends_with(".png");
        EXPECT_EQ(scratch_.read(file).substr(1, 3), is_png ? "PNG" : "KTX");
        const Ran checked =
            shell(scratch_, "check-normals " + file + " --require format=" + wanted.format +
                                " --require y=" + wanted.y + " --require mips=" + std::to_string(wanted.levels));
        EXPECT_EQ(checked.code, 0) << checked.out;
        const auto texture = read_texture(scratch_.path(file));
        ASSERT_TRUE(texture);
        EXPECT_TRUE(texture->y_known);
        EXPECT_EQ(texture->y_axis, std::string(wanted.y) == "up" ? YAxis::up : YAxis::down);
        EXPECT_TRUE(texture->swizzle_known);
        EXPECT_FALSE(texture->srgb);
        const auto found = probe(scratch_.path(file));
        ASSERT_TRUE(found);
        EXPECT_EQ(found->width, 512);
    }

    Scratch scratch_;
};

TEST_F(Engines, EachGetsItsFileTypeFormatLevelsAndDirection) {
    const Ran ran = sh("bake-normals rock.png --out-dir out --bumpiness 8 --json --for " + all_engines());
    EXPECT_EQ(ran.code, 0) << ran.err;
    const std::vector<std::string> lines = lines_of(ran.out);
    ASSERT_EQ(lines.size(), std::size(kWanted));
    for (std::size_t k = 0; k < lines.size(); ++k) {
        const WantedFile& wanted = kWanted[k];
        const auto line = nlohmann::json::parse(lines[k]);
        EXPECT_EQ(line["for"], wanted.engine);
        EXPECT_EQ(line["output"], std::string("out/") + wanted.engine + "/" + wanted.file);
        EXPECT_EQ(line["format"], wanted.format);
        expect_fits(wanted, line["output"].get<std::string>());
    }
}

TEST_F(Engines, OneEngineWritesTheBytesOfItsOptions) {
    does("bake-normals rock.png --bumpiness 1 -o a.png --for unreal");
    does("bake-normals rock.png --bumpiness 1 -o b.png --format rgb8 --y down");
    EXPECT_TRUE(scratch_.read("a.png") == scratch_.read("b.png"));
    does("bake-normals rock.png --bumpiness 1 -o - --for ios | cat > a.ktx2; true");
    does("bake-normals rock.png --bumpiness 1 -o b.ktx2 --format eac-rg11 --mips all");
    EXPECT_TRUE(scratch_.read("a.ktx2") == scratch_.read("b.ktx2"));
}

TEST_F(Engines, OptionsOverrideThePresetInAnyOrder) {
    for (const std::string order : {"--for bevy --y down --mips 2", "--mips 2 --y down --for bevy"}) {
        does("bake-normals rock.png --bumpiness 1 -o x.ktx2 " + order);
        const WantedFile wanted{"bevy", "x.ktx2", "bc5", "down", 2};
        expect_fits(wanted, "x.ktx2");
    }
    does("bake-normals rock.png --bumpiness 1 -o x.dds --for unity --format dxt5nm --mips all");
    EXPECT_EQ(shell(scratch_, "check-normals x.dds --require format=dxt5nm --require mips=full").code, 0);
    does("bake-normals rock.png --bumpiness 1 --out-dir out --container ktx2 --for unity --quiet");
    EXPECT_TRUE(scratch_.has("out/rock.ktx2"));
    fails("bake-normals rock.png -o x.png --for bevy", "png files cannot hold bc5");
}

TEST_F(Engines, NormalMapsGetTheDirectionAndTheLevelsOfTheEngine) {
    does("bake-normals rock.png -o n.png --bumpiness 8");
    does("pack-normals n.png --out-dir packed --for unreal,bevy");
    expect_fits({"unreal", "", "rgb8", "down", 1}, "packed/unreal/n.png");
    expect_fits({"bevy", "", "bc5", "up", 10}, "packed/bevy/n.ktx2");
    EXPECT_EQ(shell(scratch_, "compare-normals n.png packed/unreal/n.png --max 0.6").code, 0);
    does("pack-normals packed/bevy/n.ktx2 -o kept.ktx2 --for android --mips keep");
    does("mip-normals n.png --out-dir mips --for android");
    expect_fits({"android", "", "eac-rg11", "up", 10}, "mips/n.ktx2");
    does("blend-normals n.png n.png -o blend.png --for o3de");
    expect_fits({"o3de", "", "rgb8", "down", 1}, "blend.png");
    does("pack-normals n.png --out-dir sharp --for bevy --mip-filter kaiser");
    fails("pack-normals n.png -o x.ktx2 --for bevy --mips keep --mip-filter kaiser", "does nothing if levels are kept");
}

TEST_F(Engines, NamesSeparateTheFilesOfSeveralEngines) {
    does("bake-normals rock.png --bumpiness 1 --name '{stem}_{engine}_{format}.{type}' --for unity,bevy");
    EXPECT_TRUE(scratch_.has("rock_unity_rgb8.png"));
    EXPECT_TRUE(scratch_.has("rock_bevy_bc5.ktx2"));
    does("bake-normals rock.png --bumpiness 1 --name '{engine}/{stem}_n.{type}' --for unity,bevy");
    EXPECT_TRUE(scratch_.has("bevy/rock_n.ktx2"));
    does("bake-normals rock.png --bumpiness 1 --root . --out-dir rooted --for unity,o3de");
    EXPECT_TRUE(scratch_.has("rooted/o3de/rock_normal.png"));
    does("bake-normals rock.png --bumpiness 1 --name x_normal.png");
    does("pack-normals x_normal.png --out-dir once --for o3de");
    EXPECT_TRUE(scratch_.has("once/x_normal.png"));
    does("bake-normals rock.png --bumpiness 1 --name '{stem}.{type}' --container dds");
    EXPECT_TRUE(scratch_.has("rock.dds"));
}

TEST_F(Engines, MistakesSayWhatIsWrong) {
    fails("bake-normals rock.png -o x.png --for unitty",
          "--for: must be one of unity, unreal, godot, gltf, gltf-ktx2, three, three-packed, babylon, playcanvas, "
          "cesium, filament, phaser, blender, bevy, o3de, android, ios, not 'unitty'; did you mean unity?");
    fails("bake-normals rock.png -o x.png --for unity,unity", "unity is named twice");
    fails("bake-normals rock.png -o x.png --for unity,list", "not 'list'");
    fails("bake-normals rock.png -o x.png --for unity,unreal", "-o takes one engine of --for, 2 are given");
    fails("bake-normals rock.png --bumpiness 1 --name 'n.png' --for unity,unreal",
          "rock.png for unity and for unreal have the same output n.png; {engine} in --name separates them");
    fails("bake-normals - --out-dir out --for unity,unreal < rock.png", "standard input can only be read once");
    fails("bake-normals rock.png --bumpiness 1 --name '{engine}.png'", "{engine} needs --for");
    fails("bake-normals rock.png --bumpiness 1 --name '{stem}.{type}'", "{type} needs --for or --container");
    EXPECT_EQ(scratch_.list(), std::vector<std::string>{"rock.png"});
}

TEST_F(Engines, ListPrintsEveryEngineWithItsReasonAndNeedsNoInput) {
    for (const std::string command :
         {"bake-normals", "pack-normals", "mip-normals", "blend-normals", "convert-normals"}) {
        const Ran ran = shell(scratch_, command + " --for list");
        EXPECT_EQ(ran.code, 0) << command << ran.err;
        for (const WantedFile& wanted : kWanted)
            EXPECT_NE(ran.out.find("\n" + std::string(wanted.engine) + " "), std::string::npos) << ran.out;
        for (const std::string& line : lines_of(ran.out)) EXPECT_LE(line.size(), 80) << line;
    }
    EXPECT_EQ(scratch_.list(), std::vector<std::string>{"rock.png"});
}

TEST_F(Engines, ManifestsTakeOneEngineForEachOutput) {
    const auto manifest = [](const std::string& outputs) {
        return "version = 1\n[[rule]]\nmatch = \"*.png\"\nout-dir = \"out\"\nsteps = [ { bake = {} } ]\noutputs = [ " +
               outputs + " ]\n";
    };
    scratch_.write("normals.toml", manifest("{ for = \"unreal\", name = \"{engine}/{stem}.png\" }, { for = \"bevy\", "
                                            "name = \"{engine}/{stem}_{format}.ktx2\" }"));
    const Ran built = shell(scratch_, "build-normals normals.toml");
    EXPECT_EQ(built.code, 0) << built.err;
    expect_fits({"unreal", "", "rgb8", "down", 1}, "out/unreal/rock.png");
    expect_fits({"bevy", "", "bc5", "up", 10}, "out/bevy/rock_bc5.ktx2");
    const std::pair<const char*, const char*> wrong[] = {
        {"{ for = \"list\" }", "for"},
        {"{ for = [\"unity\", \"bevy\"], name = \"{stem}.dds\" }", "an output is for one engine"},
        {"{ name = \"{engine}.dds\" }", "{engine} needs the key for"},
        {"{ for = \"unity\", name = \"{stem}.{type}\" }", "{type} cannot be used here"},
    };
    for (const auto& [outputs, reason] : wrong) {
        scratch_.write("normals.toml", manifest(outputs));
        const Ran ran = shell(scratch_, "build-normals normals.toml");
        EXPECT_EQ(ran.code, 2) << outputs;
        EXPECT_EQ(ran.out, "") << outputs;
        EXPECT_NE(ran.err.find("line 6, column"), std::string::npos) << ran.err;
        EXPECT_NE(ran.err.find(reason), std::string::npos) << ran.err;
    }
}

TEST_F(Engines, CheckNormalsAcceptsWhatForMakesAndNamesWhatDoesNotFit) {
    does("bake-normals rock.png --out-dir out --bumpiness 8 --for " + all_engines());
    for (const WantedFile& wanted : kWanted) {
        const std::string file = std::string("out/") + wanted.engine + "/" + wanted.file;
        const Ran ran = shell(scratch_, std::string("check-normals --for ") + wanted.engine + " " + file);
        EXPECT_EQ(ran.code, 0) << wanted.engine << ran.out << ran.err;
        // The mark is wrong, and so are the texels.
        const std::string flipped = file + (file.ends_with("png") ? ".png" : ".ktx2");
        does("pack-normals " + file + " -o " + flipped + " --y " + (std::string(wanted.y) == "up" ? "down" : "up") +
             " --format " + wanted.format);
        const Ran wrong = shell(scratch_, std::string("check-normals --for ") + wanted.engine + " " + flipped);
        EXPECT_EQ(wrong.code, 1) << wanted.engine;
        EXPECT_NE(wrong.out.find("N401"), std::string::npos) << wrong.out;
    }
    const auto says = [&](const std::string& engine, const std::string& file, const std::string& reason) {
        const Ran ran = shell(scratch_, "check-normals --for " + engine + " " + file);
        EXPECT_EQ(ran.code, 1) << ran.out;
        EXPECT_NE(ran.out.find("N113"), std::string::npos) << ran.out;
        EXPECT_NE(ran.out.find(reason), std::string::npos) << ran.out;
    };
    says("gltf", "out/bevy/rock.ktx2", "gltf does not read ktx2 but png, jpeg");
    says("gltf", "out/bevy/rock.ktx2", "it does not read normals from bc5-unorm, rg but from rgb8, rgba8, rgb16");
    does("bake-normals rock.png --bumpiness 1 -o astc.ktx2 --for ios --format astc-8x6 --effort fast");
    EXPECT_EQ(shell(scratch_, "check-normals --for ios astc.ktx2").code, 0);
    EXPECT_EQ(shell(scratch_, "check-normals --for android astc.ktx2").code, 0);
    says("bevy", "astc.ktx2", "does not read normals from astc-8x6-unorm, ra");
    says("three-packed", "astc.ktx2",
         "does not read normals from astc-8x6-unorm, ra but from bc5, eac-rg11, rg8, rgba8");
    says("three-packed", "out/three/rock.png", "three-packed does not read png but ktx2");
    says("three", "out/three-packed/rock.ktx2", "three does not read normals from bc5-unorm, rg");
    does(
        "bake-normals rock.png --bumpiness 1 -o rgb.ktx2 --format rgb8; bake-normals rock.png --bumpiness 1 -o "
        "rgba.ktx2 --format rgba8");
    says("three", "rgb.ktx2",
         "three does not read normals from rgb8-unorm, rgb but from rgba8, rgba16f, rgba32f, bc7, uastc");
    EXPECT_EQ(shell(scratch_, "check-normals --for three rgba.ktx2").code, 0);
    // three.js 0.187 draws the file for bevy as it must (tests/engines).
    EXPECT_EQ(scratch_.read("out/three-packed/rock.ktx2"), scratch_.read("out/bevy/rock.ktx2"));
    // Engines treat floats as other pictures (three.js 0.187 draws an EXR file of vectors flat and black).
    does(
        "bake-normals rock.png --bumpiness 1 -o vectors.exr; convert out/unity/rock.png -strip codes.png; "
        "oiiotool codes.png --colorconvert linear linear -d float -o codes.exr 2>/dev/null || "
        "convert codes.png -set colorspace RGB -define quantum:format=floating-point codes.exr");
    says("blender", "vectors.exr", "blender decodes 2c - 1, and the file holds x, y and z themselves");
    EXPECT_EQ(shell(scratch_, "check-normals --for blender codes.exr").code, 0);
    fails("bake-normals rock.png -o vectors.exr --for three --format half", "and three decodes 2c - 1");
    fails("pack-normals out/unity/rock.png -o a.ktx2 --for bevy --format rgba16f", "and bevy decodes 2c - 1");
    says("bevy", "out/godot/rock.png", "bevy needs all 10 levels, and the file has 1");
    does("bake-normals rock.png --bumpiness 1 -o one.dds --mips none");
    says("unity", "one.dds", "unity needs all 10 levels, and the file has 1");
    does("bake-normals rock.png --bumpiness 1 -o unity.dds");
    EXPECT_EQ(shell(scratch_, "check-normals --for unity unity.dds").code, 0);
    EXPECT_EQ(shell(scratch_, "check-normals --for gltf unity.dds --disable N113").code, 0);
    fails("check-normals rock.png --for unity,unreal #", "unity and unreal read green the other way round");
    const Ran both = shell(scratch_, "check-normals --for unity,gltf out/bevy/rock.ktx2");
    EXPECT_NE(both.out.find("unity does not read ktx2"), std::string::npos) << both.out;
    EXPECT_NE(both.out.find("gltf does not read ktx2"), std::string::npos) << both.out;
    fails("check-normals rock.png --for list #", "must be one of unity");
}

// Every command of the page runs, in the order of the page; the checks have no finding.
TEST(EnginesPage, EveryCommandOfTheRecipesRuns) {
    const Scratch scratch;
    scratch.add_sample("bricks.png", "bricks.png");
    scratch.add_sample("broken/N805-double-sided-tangents.glb", "scene.glb");
    std::ifstream page(TEX_BINARY_DIR "/man/normal-maps-engines.7");
    const std::string text{std::istreambuf_iterator<char>(page), {}};
    ASSERT_NE(text, "");
    std::size_t count = 0;
    for (const std::string& line : lines_of(text)) {
        if (!line.starts_with(".Dl ")) continue;
        const Ran ran = shell(scratch, line.substr(4));
        EXPECT_EQ(ran.code, 0) << line << "\n" << ran.out << ran.err;
        ++count;
    }
    EXPECT_GE(count, 2 * std::size(kWanted));
    for (const WantedFile& wanted : kWanted)
        EXPECT_NE(text.find(std::string("--for ") + wanted.engine + " "), std::string::npos) << wanted.engine;
}

// Each line of another program has ours below it, or words that say why not.
TEST(MigrationPage, EveryCommandOfOursRuns) {
    const Scratch scratch;
    for (const auto& [sample, name] : {std::pair("bricks.png", "rock_h.png"), std::pair("crate_low.glb", "low.glb"),
                                       std::pair("crate_high.glb", "high.glb")})
        scratch.add_sample(sample, name);
    ASSERT_EQ(shell(scratch, "bake-normals rock_h.png -o rock_n.png --bumpiness 8 --no-sync").code, 0);
    std::ifstream page(TEX_BINARY_DIR "/man/normal-maps-migrate.7");
    const std::string text{std::istreambuf_iterator<char>(page), {}};
    ASSERT_NE(text, "");
    std::size_t count = 0;
    for (const std::string& line : lines_of(text)) {
        if (!line.starts_with(".Dl ")) continue;
        const Ran ran = shell(scratch, line.substr(4));
        EXPECT_EQ(ran.code, 0) << line << "\n" << ran.out << ran.err;
        ++count;
    }
    EXPECT_GE(count, 30u);
    for (const char* program : {"nvcompress", "texconv", "CompressonatorCLI", "toktx", "ktx create", "oiiotool",
                                "maketx", "convert", "gegl", "crunch", "XNORMAL", "sbsbaker", "BLENDER"})
        EXPECT_NE(text.find(program), std::string::npos) << program;
}

// Viewers of glTF read its UASTC, also as files of their own; not x and y alone.
TEST_F(Engines, ViewersReadUastc) {
    does("bake-normals rock.png --bumpiness 1 -o u.ktx2 --for gltf-ktx2 --effort fast");
    does("bake-normals rock.png --bumpiness 1 -o x.ktx2 --format uastc-rrrg --mips all --effort fast");
    for (const std::string engine : {"three", "babylon", "playcanvas", "cesium", "gltf-ktx2"}) {
        EXPECT_EQ(shell(scratch_, "check-normals --for " + engine + " u.ktx2").code, 0) << engine;
        EXPECT_EQ(shell(scratch_, "check-normals --for " + engine + " x.ktx2").code, 1) << engine;
    }
}

}  // namespace
}  // namespace tex::cli
