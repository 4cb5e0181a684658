// SPDX-License-Identifier: Apache-2.0
// What commands say where a user would otherwise find out too late: warnings, and commands that mend what they name.

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {
namespace {

class Advice : public testing::Test {
protected:
    Advice() {
        scratch_.add_sample("bricks.png", "bricks.png");
        done("bake-normals", {"bricks.png", "-o", "up.png", "--bumpiness", "12"});
        done("pack-normals", {"up.png", "-o", "down.png", "--y", "down"});
    }
    Ran done(const std::string& program, const std::vector<std::string>& arguments) {
        const Ran ran = run(scratch_, program, arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        return ran;
    }
    // Writes a picture without marks. `change` gets each texel's place and its three codes.
    template <class Change>
    void paint(const std::string& from, const std::string& to, const Change& change) {
        auto texture = read_texture(scratch_.path(from));
        ASSERT_TRUE(texture);
        texture->swizzle_known = texture->y_known = false;
        const Extent extent = texture->extent();
        for (int k = 0; k < extent.texels(); ++k) {
            auto* const codes = reinterpret_cast<unsigned char*>(&texture->levels[0].bytes[3 * std::size_t(k)]);
            change(k % extent.width, k / extent.width, codes);
        }
        ASSERT_TRUE(write_texture(scratch_.path(to), *texture));
    }
    Scratch scratch_;
};

TEST_F(Advice, NearlyFlatBakesNameTheStrengthThatUsesTheRange) {
    const Ran flat = done("bake-normals", {"bricks.png", "-o", "flat.png", "--bumpiness", "0.05"});
    const std::size_t at = flat.err.find("nearly flat: 99 % of the slopes are below ");
    ASSERT_NE(at, std::string::npos) << flat.err;
    const std::size_t word = flat.err.find("auto would be --bumpiness ", at);
    ASSERT_NE(word, std::string::npos) << flat.err;
    const std::string strength = flat.err.substr(word + 26, flat.err.find('\n', word) - word - 26);
    EXPECT_EQ(done("bake-normals", {"bricks.png", "-o", "steep.png", "--bumpiness", strength}).err, "");
    // In any file, at any strength below 5 degrees; and the number is the same each time.
    for (const char* bumpiness : {"0.001", "0.1", "-0.3"}) {
        const Ran faint = done("bake-normals", {"bricks.png", "-o", "deep.exr", "--bumpiness", bumpiness});
        EXPECT_NE(faint.err.find("auto would be --bumpiness " + strength + "\n"), std::string::npos) << faint.err;
    }
    EXPECT_EQ(done("bake-normals", {"bricks.png", "-o", "none.png", "--bumpiness", "0"}).err, "") << "as asked for";

    // One figure, without asking twice; and 45 degrees is what it promises.
    const Ran automatic =
        done("bake-normals", {"bricks.png", "-o", "auto.exr", "--bumpiness", "auto", "--format", "float"});
    ASSERT_TRUE(automatic.out.starts_with("bricks.png: --bumpiness auto is ")) << automatic.out;
    EXPECT_EQ(automatic.out.substr(automatic.out.rfind(' ') + 1), strength + "\n");
    const auto source = read_normals(scratch_.path("auto.exr"));
    ASSERT_TRUE(source);
    const NormalMap& map = source->chain.levels[0];
    std::int64_t steep = 0;
    for (int k = 0; k < map.extent().texels(); ++k)
        steep += map.z.at(k % map.extent().width, k / map.extent().width) < std::sqrt(0.5f) ? 1 : 0;
    const double share = static_cast<double>(steep) / static_cast<double>(map.extent().texels());
    EXPECT_GT(share, 0.005);
    EXPECT_LT(share, 0.015);
}

TEST_F(Advice, AutomaticStrengthIsTheSameInABatchAndFromAPipe) {
    done("bake-normals", {"bricks.png", "-o", "file.png", "--bumpiness", "auto"});
    const Ran piped = shell(scratch_, "cat bricks.png | bake-normals - -o piped.png --bumpiness auto --threads 1");
    EXPECT_EQ(piped.code, 0) << piped.err;
    EXPECT_EQ(scratch_.read("file.png"), scratch_.read("piped.png"));
    EXPECT_EQ(run(scratch_, "integrate-normals", {"up.png", "-o", "h.png", "--bumpiness", "auto"}).code, 2);
}

// Joints at equal distances: of every second row, one phase would be seen.
TEST_F(Advice, AutomaticStrengthDoesNotDependOnThePhaseOfAPattern) {
    for (const char* side : {"600", "1400"}) {
        const std::string size = std::string(side) + "x" + side;
        const Ran made = shell(scratch_, "convert -size " + size + " pattern:HORIZONTAL2 -crop " + size +
                                             "+0+0 +repage -blur 0x0.5 -resize " + side + "x" + side +
                                             "! a.png && convert a.png -roll +0+1 b.png");
        ASSERT_EQ(made.code, 0) << made.err;
        const auto strength = [&](const char* name) {
            const Ran ran = done("bake-normals", {name, "-o", "o.dds", "--bumpiness", "auto"});
            return std::stod(ran.out.substr(ran.out.rfind(' ') + 1));
        };
        const double a = strength("a.png"), b = strength("b.png");
        EXPECT_NEAR(a / b, 1.0, 0.02) << side;
    }
}

TEST_F(Advice, BuildsPrintTheStrengthThatTheyFound) {
    const Ran alone = done("bake-normals", {"bricks.png", "-o", "alone.dds", "--bumpiness", "auto"});
    const std::string number = alone.out.substr(alone.out.rfind(' ') + 1);
    const std::string rule = "version = 1\n[[rule]]\nmatch = \"bricks.png\"\n";
    const std::string bake = "{ bake = { bumpiness = \"auto\" } }";
    scratch_.write("one.toml", rule + "name = \"out/a.dds\"\nsteps = [ " + bake + " ]\n");
    scratch_.write("two.toml", rule + "name = \"out/b.dds\"\nsteps = [ " + bake + ", { mip = {} } ]\n");
    for (const char* manifest : {"one.toml", "two.toml"}) {
        const Ran text = done("build-normals", {manifest});
        EXPECT_NE(text.out.find("bricks.png: --bumpiness auto is " + number), std::string::npos) << text.out;
        std::filesystem::remove_all(scratch_.path("out"));
        const Ran json = done("build-normals", {manifest, "--json"});
        const auto line = nlohmann::json::parse(lines_of(json.out)[0]);
        EXPECT_FLOAT_EQ(line["bumpiness"][0].get<float>(), std::stof(number)) << json.out;
        EXPECT_EQ(json.out.find("auto is"), std::string::npos) << json.out;
    }
}

// What is said about a map that went through the sRGB curve, by a command of others.
TEST_F(Advice, ColourCurvesAreTurnedBack) {
    for (const auto& [id, damage] : {std::pair("N301", "-set colorspace sRGB -colorspace RGB -set colorspace sRGB"),
                                     std::pair("N302", "-set colorspace RGB -colorspace sRGB")}) {
        ASSERT_EQ(shell(scratch_, std::string("convert up.png -depth 8 ") + damage + " bad.png").code, 0);
        const auto report = nlohmann::json::parse(run(scratch_, "check-normals", {"bad.png", "--json"}).out);
        ASSERT_EQ(report["findings"][0]["id"], id) << report;
        const std::string command = report["findings"][0]["fix"];
        ASSERT_EQ(shell(scratch_, command + " && mv FIXED.png mended.png").code, 0) << command;
        const Ran after = run(scratch_, "check-normals", {"mended.png"});
        EXPECT_EQ(after.out.find(id), std::string::npos) << after.out;
        done("compare-normals", {"up.png", "mended.png", "--max-mean", "1.5"});
    }
}

TEST_F(Advice, HeightsNameTheBakeThatMakesTheMapAgain) {
    const Ran ran = done("integrate-normals", {"up.png", "-o", "h.exr"});
    const std::size_t at = ran.out.find("h.exr: bake-normals --bumpiness ");
    ASSERT_NE(at, std::string::npos) << ran.out;
    const std::string strength = ran.out.substr(at + 32, ran.out.find(' ', at + 32) - at - 32);
    done("bake-normals", {"h.exr", "-o", "again.png", "--bumpiness", strength});
    EXPECT_EQ(done("compare-normals", {"up.png", "again.png", "--max-mean", "0.5"}).err, "");
}

TEST_F(Advice, ObjectSpaceIsDoubtedByEveryReader) {
    paint("up.png", "object.png", [](int, int j, unsigned char* c) {
        if (j % 2 == 0) c[2] = static_cast<unsigned char>(255 - c[2]);
    });
    const std::string doubt = "object.png: its vectors face all directions, as in object space";
    for (const std::vector<std::string>& call :
         std::vector<std::vector<std::string>>{{"pack-normals", "object.png", "-o", "o.dds"},
                                               {"mip-normals", "object.png", "-o", "o.dds"},
                                               {"scale-normals", "object.png", "-o", "o.png", "--scale", "2"},
                                               {"unpack-normals", "object.png", "-o", "o.png"},
                                               {"preview-normals", "object.png", "-o", "o.png"},
                                               {"blend-normals", "up.png", "--detail", "object.png", "-o", "o.png"},
                                               {"compare-normals", "up.png", "object.png"}}) {
        const Ran ran = run(scratch_, call[0], {call.begin() + 1, call.end()});
        EXPECT_NE(ran.err.find(doubt), std::string::npos) << call[0] << ": " << ran.err;
        EXPECT_EQ(without_notes(run(scratch_, "pack-normals", {"up.png", "-o", "o.dds"}).err), "");
    }
}

TEST_F(Advice, ComparisonsDoubtGreen) {
    paint("up.png", "gl.png", [](int, int, unsigned char*) {});
    paint("down.png", "dx.png", [](int, int, unsigned char*) {});
    const Ran ran = run(scratch_, "compare-normals", {"gl.png", "dx.png"});
    EXPECT_NE(ran.err.find("dx.png: green is taken to point up, but the texels show the other direction: --y-b down"),
              std::string::npos)
        << ran.err;
    EXPECT_EQ(done("compare-normals", {"gl.png", "dx.png", "--y-b", "down", "--max", "0.5"}).err, "");
    EXPECT_EQ(done("compare-normals", {"dx.png", "dx.png", "--max", "0"}).err, "") << "both are in the same direction";
}

TEST_F(Advice, BackgroundIsFilled) {
    const auto inside = [](int i, int j) { return (i - 240) * (i - 240) + (j - 256) * (j - 256) < 200 * 200; };
    for (const int shade : {0, 128, 255}) {
        paint("up.png", "chart.png", [&](int i, int j, unsigned char* c) {
            if (!inside(i, j)) c[0] = c[1] = c[2] = static_cast<unsigned char>(shade);
        });
        const Ran plain = done("pack-normals", {"chart.png", "-o", "plain.dds", "--format", "rgb8"});
        EXPECT_NE(plain.err.find("--fill-background fills it"), std::string::npos) << plain.err;
        for (const char* type : {"filled.png", "filled.dds"}) {
            const Ran ran = done("pack-normals", {"chart.png", "-o", type, "--format", "rgb8", "--fill-background"});
            EXPECT_EQ(ran.err, "");
            const auto before = read_normals(scratch_.path("up.png")), after = read_normals(scratch_.path(type));
            ASSERT_TRUE(before && after);
            const NormalMap &from = before->chain.levels[0], &to = after->chain.levels[0];
            for (int k = 0; k < to.extent().texels(); ++k) {
                const int i = k % to.extent().width, j = k / to.extent().width;
                if (inside(i, j)) {
                    ASSERT_NEAR(to.x.at(i, j), from.x.at(i, j), 0.01) << i << ", " << j;
                    ASSERT_NEAR(to.y.at(i, j), from.y.at(i, j), 0.01) << i << ", " << j;
                }
                ASSERT_GT(to.z.at(i, j), 0.0f) << i << ", " << j;
            }
            // The nearest texel of a disc lies towards its centre.
            EXPECT_NEAR(to.x.at(240 + 220, 256), from.x.at(240 + 199, 256), 0.01);
        }
    }
    EXPECT_NE(
        done("pack-normals", {"up.png", "-o", "o.dds", "--fill-background"}).err.find("has no background to fill"),
        std::string::npos);
}

TEST_F(Advice, OneCommandFixesWhatItCan) {
    paint("down.png", "bad.png", [](int i, int j, unsigned char* c) {  // green down, vectors too short, a background
        for (int k = 0; k < 3; ++k) c[k] = static_cast<unsigned char>(128 + (c[k] - 128) * 85 / 100);
        if (i < 60 && j < 60) c[0] = c[1] = c[2] = 0;
    });
    const Ran before = run(scratch_, "check-normals", {"bad.png", "--require", "y=up", "--json"});
    const auto report = nlohmann::json::parse(before.out);
    std::vector<std::string> ids;
    for (const auto& finding : report["findings"]) ids.push_back(finding["id"]);
    ASSERT_EQ(ids, (std::vector<std::string>{"N201", "N215", "N401"})) << before.out;
    const std::string fix = report["findings"][0]["fix"];
    for (const auto& finding : report["findings"]) EXPECT_EQ(finding["fix"], fix);
    ASSERT_EQ(shell(scratch_, fix + " --quiet").code, 0) << fix;
    const Ran after = run(scratch_, "check-normals", {"FIXED.png", "--require", "y=up", "--fail-on", "note"});
    EXPECT_EQ(after.code, 0) << fix << "\n" << after.out;
    EXPECT_EQ(run(scratch_, "check-normals", {"bad.png", "--require", "y=up"}).out.find(fix),
              run(scratch_, "check-normals", {"bad.png", "--require", "y=up"}).out.rfind(fix))
        << "it is printed once";
}

TEST_F(Advice, DebandingMendsBanding) {
    const auto has_banding = [&](const std::string& file) {
        return run(scratch_, "check-normals", {file, "--enable", "N305"}).out.find("N305") != std::string::npos;
    };
    scratch_.add_sample("waves.png", "waves.png");
    ASSERT_EQ(shell(scratch_,
                    "/usr/bin/python3 -c 'from PIL import Image as I; i = I.open(\"waves.png\").convert(\"I\"); "
                    "i.point(lambda h: h / 257 if i.getextrema()[1] > 255 else h).convert(\"L\").save(\"w8.png\")'")
                  .code,
              0);
    done("bake-normals", {"w8.png", "-o", "w8_n.png", "--bumpiness", "30"});
    if (!has_banding("w8_n.png")) GTEST_SKIP() << "these heights show no steps";
    done("bake-normals", {"w8.png", "-o", "w16_n.png", "--bumpiness", "30", "--deband", "on"});
    EXPECT_FALSE(has_banding("w16_n.png"));
}

TEST_F(Advice, AnImportersPresetInAnEnginesFileIsDoubted) {
    const Ran ran = done("pack-normals", {"up.png", "-o", "x.dds", "--for", "unity"});
    EXPECT_NE(ran.err.find("--for unity is meant for .png files; this .dds file holds rgb8"), std::string::npos)
        << ran.err;
    EXPECT_EQ(done("pack-normals", {"up.png", "-o", "x.png", "--for", "unity"}).err, "");
    EXPECT_EQ(done("pack-normals", {"up.png", "-o", "x.dds", "--for", "unity", "--format", "dxt5nm"}).err, "");
}

TEST_F(Advice, PatternsThatTheShellLeftAloneAreExpanded) {
    ASSERT_EQ(shell(scratch_,
                    "mkdir -p art/a/b && cp up.png art/x_n.png && cp up.png art/a/y_n.png && "
                    "cp up.png art/a/b/z_n.png && cp up.png 'odd[1].png'")
                  .code,
              0);
    EXPECT_NE(run(scratch_, "check-normals", {"art/**/*_n.png"}).out.find("3 files: "), std::string::npos);
    EXPECT_NE(run(scratch_, "check-normals", {scratch_.path("art") + "/*/*_n.png"}).out.find("1 file: "),
              std::string::npos);
    EXPECT_NE(run(scratch_, "check-normals", {"odd[1].png"}).out.find("1 file: "), std::string::npos) << "it exists";
    done("mip-normals", {"art/**/*_n.png", "--out-dir", "out"});
    EXPECT_TRUE(scratch_.has("out/z_n.dds"));
    const Ran none = run(scratch_, "check-normals", {"art/**/*_d.png"});
    EXPECT_EQ(none.code, 3);
    EXPECT_NE(none.err.find("art/**/*_d.png: no file matches this pattern"), std::string::npos) << none.err;
}

TEST_F(Advice, TheBaselineLeavesMissingFilesAndShowsWhatItWaives) {
    const Ran written =
        run(scratch_, "check-normals", {"down.png", "gone.png", "--require", "y=up", "--baseline-write", "k"});
    EXPECT_EQ(written.code, 3);
    EXPECT_EQ(scratch_.read("k").find("gone.png"), std::string::npos);
    EXPECT_EQ(run(scratch_, "check-normals", {"down.png", "gone.png", "--require", "y=up", "--baseline", "k"}).code, 3);
    const Ran waived =
        run(scratch_, "check-normals", {"down.png", "--require", "y=up", "--baseline", "k", "--sarif", "s"});
    EXPECT_EQ(waived.code, 0) << waived.out;
    const auto results = nlohmann::json::parse(scratch_.read("s"))["runs"][0]["results"];
    ASSERT_GE(results.size(), 1u);
    for (const auto& result : results) EXPECT_EQ(result["suppressions"][0]["kind"], "external");
}

}  // namespace
// Heights of a terrain, baked as if they repeated, have a wall along their border.
TEST_F(Advice, HeightsThatDoNotRepeatGetAWall) {
    scratch_.add_sample("dunes.png", "dunes.png");
    scratch_.add_sample("waves.png", "waves.png");
    const Ran wall = shell(scratch_, "bake-normals dunes.png -o d.png --bumpiness 30 --no-sync");
    EXPECT_EQ(wall.code, 0);
    EXPECT_NE(wall.err.find("dunes.png: a wall along the border"), std::string::npos) << wall.err;
    const Ran checked = shell(scratch_, "check-normals d.png --require tiles");
    EXPECT_NE(checked.out.find("N307"), std::string::npos) << checked.out;
    for (const char* quiet : {"bake-normals dunes.png -o d.png --bumpiness 30 --wrap clamp --no-sync",
                              "bake-normals dunes.png -o d.png --bumpiness 30 --wrap repeat --no-sync",
                              "bake-normals waves.png -o w.png --bumpiness 30 --no-sync",
                              "bake-normals bricks.png -o b.png --bumpiness 30 --no-sync"}) {
        const Ran ran = shell(scratch_, quiet);
        EXPECT_EQ(ran.err, "") << quiet;
    }
    const Ran tiles = shell(scratch_, "check-normals w.png b.png --require tiles");
    EXPECT_EQ(tiles.out.find("N307"), std::string::npos) << tiles.out;
}

TEST_F(Advice, AStatementThatTheTexelsContradictIsDoubted) {
    const auto says = [&](const std::string& line) { return shell(scratch_, line + " --no-sync").err; };
    ASSERT_EQ(says("bake-normals bricks.png -o up.png --bumpiness 3"), "");
    const std::string wrong = says("pack-normals up.png -o down.png --y-in down --y up");
    EXPECT_NE(wrong.find("up.png: green is stated to point down, but the texels show the other"), std::string::npos);
    EXPECT_EQ(says("pack-normals up.png -o down.png --y-in up --y down"), "");
    EXPECT_EQ(says("pack-normals up.png -o down.png --y-in measured --y down"), "");
}

TEST_F(Advice, RoughnessWithoutTheMaterialsOwnIsAMirror) {
    const auto says = [&](const std::string& line) { return shell(scratch_, line + " --no-sync").err; };
    ASSERT_EQ(says("bake-normals bricks.png -o n.png --bumpiness 3"), "");
    const std::string one = says("mip-normals n.png -o x.png --mips none --roughness-out r.png");
    EXPECT_NE(one.find("r.png: without --roughness-in, the material's own roughness is 0, a mirror; the only level"),
              std::string::npos)
        << one;
    const std::string kept = says("mip-normals n.png -o x.png --mips none --roughness-out r.png --roughness-in 0.5");
    EXPECT_NE(kept.find("one level loses no variance"), std::string::npos) << kept;
    EXPECT_EQ(says("mip-normals n.png -o x.dds --roughness-out r.dds --roughness-in 0.5"), "");
}

TEST_F(Advice, AnInvertedPictureIsNotMendedInSilence) {
    const auto says = [&](const std::string& line) { return shell(scratch_, line); };
    ASSERT_EQ(says("bake-normals bricks.png -o n.png --bumpiness 3 --no-sync; convert n.png -negate x.png").err, "");
    EXPECT_NE(says("check-normals x.png")
                  .out.find("advice: That inverts blue alone. If bumps look like dents after that, the whole picture "
                            "was inverted: then also scale-normals FIXED.png --scale -1 --format rgb8 -o TURNED.png\n"),
              std::string::npos);
    EXPECT_NE(says("repair-normals x.png --likely -o FIXED.png --no-sync").err.find("if bumps look like dents now"),
              std::string::npos);
    EXPECT_EQ(says("scale-normals FIXED.png --scale -1 --format rgb8 -o TURNED.png --no-sync;"
                   "compare-normals n.png TURNED.png --max 0.9")
                  .code,
              0)
        << "255 - code is 128 where n has 127";
}

// What cannot be told is asked for, and the command that undoes a change is printed in place of one that hides it.
TEST_F(Advice, FixesOfTurnedAndStretchedPicturesAreThoseThatHelp) {
    const auto says = [&](const std::string& line) { return shell(scratch_, line); };
    ASSERT_EQ(says("bake-normals bricks.png -o n.png --bumpiness 3 --no-sync; convert n.png -level 10%,90% l.png;"
                   "convert n.png -rotate 90 t.png; convert n.png -gamma 2.2 g.png")
                  .err,
              "");
    EXPECT_NE(says("check-normals l.png").out.find("fix: repair-normals l.png --likely -o FIXED.png"),
              std::string::npos)
        << says("check-normals l.png").out;
    EXPECT_EQ(
        says("repair-normals l.png --likely -o FIXED.png --no-sync && compare-normals n.png FIXED.png --max-mean 1")
            .code,
        0);
    const std::string turned = says("check-normals t.png --require y=up").out;
    EXPECT_NE(turned.find("fix: repair-normals t.png --turned left -o FIXED.png"), std::string::npos) << turned;
    EXPECT_NE(turned.find("--turned right"), std::string::npos) << turned;
    EXPECT_EQ(says("repair-normals t.png --turned left -o FIXED.png --no-sync").code, 0);
    // ImageMagick exchanges the channels of a file without a statement.
    ASSERT_EQ(
        says("convert n.png -strip -separate -swap 0,1 -combine -colorspace sRGB -define png:color-type=2 e.png").code,
        0);
    EXPECT_NE(says("check-normals e.png").out.find("in it, x and y were exchanged: --likely --y up instead"),
              std::string::npos)
        << says("check-normals e.png").out;
    EXPECT_EQ(
        says("repair-normals e.png --likely --y up -o E.png --no-sync && compare-normals n.png E.png --max 0.01").code,
        0);
    EXPECT_NE(says("check-normals g.png").out.find("gamma 2.2 fits better than the curve of sRGB"), std::string::npos);
}

TEST_F(Advice, JpegThatNobodyChoseIsNamed) {
    const auto says = [&](const std::string& line) { return shell(scratch_, line + " --no-sync").err; };
    ASSERT_EQ(says("bake-normals bricks.png -o a_n.jpg --bumpiness 3"), "");
    EXPECT_NE(says("pack-normals a_n.jpg --out-dir o --format rgb8 --y-in up --y down").find("JPEG is lossy"),
              std::string::npos);
    EXPECT_EQ(says("pack-normals a_n.jpg --out-dir o --y-in up --y down --container jpeg"), "");
    EXPECT_EQ(says("pack-normals a_n.jpg -o b_n.jpg --y-in up --y down"), "");
}

TEST_F(Advice, HeightsInAlphaOfANormalMapAreNamed) {
    const auto says = [&](const std::string& line) { return shell(scratch_, line + " --no-sync").err; };
    ASSERT_EQ(says("bake-normals bricks.png -o n.png --bumpiness 3 --format rgba8 --alpha height"), "");
    EXPECT_NE(says("bake-normals n.png -o x.png").find("--channel a takes its alpha as heights"), std::string::npos);
    EXPECT_EQ(says("bake-normals n.png -o x.png --channel a --bumpiness 3"), "");
}

}  // namespace tex::cli
