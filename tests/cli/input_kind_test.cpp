// SPDX-License-Identifier: Apache-2.0
// What commands and manifests say of pictures that are not what they take: colours, heights, data, normal maps.

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {

class InputKind : public testing::Test {
protected:
    InputKind() {
        scratch_.add_sample("bricks.png", "bricks.png");
        go("bake-normals bricks.png -o n.png --bumpiness 3 --no-sync;"
           "convert bricks.png PNG24:grey.png; convert n.png -negate negative.png;"
           "convert -size 128x128 gradient:green-yellow PNG24:color.png;"
           "convert '(' -size 128x128 'xc:gray(95%)' ')' '(' -size 128x128 gradient:gray40-gray70 ')'"
           " '(' -size 128x128 xc:black ')' -combine -depth 8 PNG24:orm.png;"
           "convert n.png '(' -size 512x512 xc:black -fill white -draw 'circle 256,256 256,60' ')' -compose multiply "
           "-composite PNG24:round.png");
    }
    void go(const std::string& script) {
        const Ran ran = shell(scratch_, "set -e; " + script);
        EXPECT_EQ(ran.code, 0) << script << ran.err;
    }
    // What a command says of a file.
    std::string said(const std::string& command, const std::string& file, const std::string& output = "out.png") {
        const Ran ran = run(scratch_, command, {file, "-o", output, "--no-sync"});
        EXPECT_EQ(ran.code, 0) << ran.err;
        return ran.err;
    }
    static bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
    Scratch scratch_;
};

TEST_F(InputKind, PicturesThatAreNoNormalMapAreNamedAsCheckNormalsNamesThem) {
    for (const char* command : {"pack-normals", "mip-normals"}) {
        const std::string output = command[0] == 'm' ? "out.dds" : "out.png";
        EXPECT_TRUE(has(said(command, "grey.png", output), "grey.png: this is no normal map")) << command;
        EXPECT_TRUE(has(said(command, "grey.png", output), "(N210)")) << command;
        EXPECT_TRUE(has(said(command, "color.png", output), "(N214)")) << command;
        const std::string orm = said(command, "orm.png", output);
        EXPECT_TRUE(has(orm, "this is no normal map") && has(orm, "(N216)")) << orm;
        EXPECT_FALSE(has(orm, "--swizzle")) << orm;
        EXPECT_EQ(said(command, "n.png", output), "");
    }
}

// Short vectors are no occlusion in blue: the words of pack-normals and check-normals are those of one rule.
TEST_F(InputKind, UnevenAndDamagedVectorsAreCalledThat) {
    go("convert n.png '(' -size 512x512 'xc:rgb(128,128,128)' ')' '(' -size 512x512 gradient:gray30-black -colorspace "
       "gray ')' -composite PNG24:short.png; convert n.png -gamma 2.2 PNG24:light.png");
    const std::string uneven = said("pack-normals", "short.png");
    EXPECT_TRUE(has(uneven, "its vectors are not of unit length: ") && has(uneven, "(N201)")) << uneven;
    EXPECT_FALSE(has(uneven, "seems to hold other data")) << uneven;
    const std::string light = said("pack-normals", "light.png");
    EXPECT_TRUE(has(light, "(N302); repair-normals mends that") || has(light, "(N314); repair-normals mends that"))
        << light;
}

// Unity's detail maps (HDRP) have albedo in R, y in G, smoothness in B and x in A; a mask in R and nothing in B are
// common in games of the time of DXT5; X-Ray has x, y and z in A, B and G. What the advice says is then right.
TEST_F(InputKind, NormalsInOtherChannelsAreFound) {
    go("convert '(' -size 512x512 plasma:tan-black -colorspace gray ')' n.png "
       "'(' -size 512x512 gradient:gray20-gray80 ')' "
       "'(' -clone 0 ')' '(' -clone 1 -channel G -separate ')' '(' -clone 2 ')' '(' -clone 1 -channel R -separate ')' "
       "-delete 0-2 -channel RGBA -combine -depth 8 PNG32:detail.png;"
       "convert n.png '(' -clone 0 -channel B -separate ')' '(' -clone 0 -channel G -separate ')' "
       "'(' -clone 0 -channel R -separate ')' -delete 0 '(' -size 512x512 gradient:gray20-gray80 ')' "
       "+insert -channel RGBA -combine -depth 8 PNG32:xray.png; convert n.png -depth 8 n8.png");
    const std::string detail = said("pack-normals", "detail.png");
    EXPECT_TRUE(has(detail, "(--swizzle ag)")) << detail;
    const std::string xray = said("pack-normals", "xray.png");
    EXPECT_TRUE(has(xray, "--swizzle abg")) << xray;
    EXPECT_TRUE(has(run(scratch_, "check-normals", {"detail.png"}).out, "(--swizzle ag)"));
    EXPECT_TRUE(has(run(scratch_, "check-normals", {"xray.png"}).out, "--swizzle abg"));
    for (const char* line : {"detail.png --swizzle ag", "xray.png --swizzle abg"}) {
        go("pack-normals " + std::string(line) + " -o again.png --drop --no-sync");
        go("compare-normals n8.png again.png --max 1.5");
    }
}

TEST_F(InputKind, OneJudgeForBackgroundsAndInvertedPictures) {
    const std::string round = said("pack-normals", "round.png");
    EXPECT_TRUE(has(round, "--fill-background")) << round;
    EXPECT_FALSE(has(round, "object space") || has(round, "--swizzle")) << round;
    const std::string negative = said("pack-normals", "negative.png");
    EXPECT_TRUE(has(negative, "inverted")) << negative;
    EXPECT_FALSE(has(negative, "object space")) << negative;
    EXPECT_TRUE(has(run(scratch_, "check-normals", {"negative.png"}).out, "N220 blue-inverted"));
}

TEST_F(InputKind, NormalMapsHoldNoHeights) {
    const std::string normals = said("bake-normals", "n.png");
    EXPECT_TRUE(has(normals, "n.png: this is a normal map, and holds no heights; integrate-normals")) << normals;
    EXPECT_FALSE(has(normals, "luma")) << normals;
    EXPECT_TRUE(has(said("bake-normals", "color.png"), "their luma is the height"));
}

TEST_F(InputKind, ManifestsRefuseThemUnlessTheyAreToldNotTo) {
    const std::string rule =
        "version = 1\n[[rule]]\nmatch = \"{grey,n}.png\"\nname = \"{stem}.dds\"\n"
        "steps = [ { mip = {} } ]\n";
    scratch_.write("normals.toml", rule);
    const Ran refused = run(scratch_, "build-normals", {"--no-sync"});
    EXPECT_EQ(refused.code, 4) << refused.err;
    EXPECT_TRUE(has(refused.err, "grey.png: this is no normal map")) << refused.err;
    EXPECT_TRUE(has(refused.err, "check = { inputs = false }")) << refused.err;
    EXPECT_FALSE(scratch_.has("grey.dds"));
    EXPECT_TRUE(scratch_.has("n.dds"));
    scratch_.write("normals.toml", rule + "check = { inputs = false }\n");
    const Ran made = run(scratch_, "build-normals", {"--no-sync"});
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_TRUE(has(made.err, "this is no normal map")) << made.err;
    EXPECT_TRUE(scratch_.has("grey.dds"));
}

TEST_F(InputKind, ManifestsRefuseNormalMapsAsHeights) {
    for (const char* steps : {"{ bake = {} }", "{ bake = {} }, { scale = { scale = 2 } }"}) {
        scratch_.write("normals.toml", "version = 1\n[[rule]]\nmatch = \"n.png\"\nname = \"n_n.dds\"\nsteps = [ " +
                                           std::string(steps) + " ]\n");
        const Ran refused = run(scratch_, "build-normals", {"--no-sync"});
        EXPECT_EQ(refused.code, 4) << steps << refused.err;
        EXPECT_TRUE(has(refused.err, "n.png: this is a normal map")) << steps << refused.err;
        EXPECT_FALSE(scratch_.has("n_n.dds")) << steps;
    }
}

TEST_F(InputKind, StepsBeforeTheLastRefuseThem) {
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"orm.png\"\nname = \"orm.dds\"\n"
                   "steps = [ { scale = { scale = 2 } }, { mip = {} } ]\n");
    const Ran refused = run(scratch_, "build-normals", {"--no-sync"});
    EXPECT_EQ(refused.code, 4) << refused.err;
    EXPECT_TRUE(has(refused.err, "orm.png: this is no normal map")) << refused.err;
    EXPECT_FALSE(scratch_.has("orm.dds"));
}

// Nothing is demanded of the outputs: only the input is wrong.
TEST_F(InputKind, ChecksOfInputsNameTheSourceThePlaceAndTheFix) {
    scratch_.write("normals.toml",
                   "version = 1\n\n[[rule]]\nmatch = \"round.png\"\nname = \"round.dds\"\n"
                   "steps = [ { mip = { fill-background = true } } ]\n"
                   "check = { inputs = true, severity = \"background=error\" }\n");
    const Ran refused = run(scratch_, "build-normals", {"--no-sync", "--json"});
    EXPECT_EQ(refused.code, 1) << refused.err;
    EXPECT_TRUE(has(refused.err, "error: round.png (normals.toml, line 3): ")) << refused.err;
    EXPECT_TRUE(has(refused.err, "first at column 0, row 0 (background, N215); pack-normals round.png "))
        << refused.err;
    EXPECT_FALSE(scratch_.has("round.dds"));
    const auto line = nlohmann::json::parse(lines_of(refused.out).front());
    EXPECT_EQ(line["status"], "refused");
    EXPECT_EQ(line["findings"][0]["input"], "round.png");
}

TEST_F(InputKind, ErrorsOfOutputsNameTheSourceThePlaceAndTheFix) {
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"n.png\"\nname = \"n.dds\"\n"
                   "steps = [ { pack = { mips = \"none\" } } ]\ncheck = { require = [\"mips=full\"] }\n");
    const Ran refused = run(scratch_, "build-normals", {"--no-sync"});
    EXPECT_EQ(refused.code, 1) << refused.err;
    EXPECT_TRUE(has(refused.err, "n.dds, made from n.png (normals.toml, line 2): 1 level instead of 10 ("))
        << refused.err;
    EXPECT_TRUE(has(refused.err, "N109); the rule decides that, as the options of this do: mip-normals n.png "))
        << refused.err;
}

}  // namespace tex::cli
