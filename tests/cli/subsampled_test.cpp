// SPDX-License-Identifier: Apache-2.0
// Good maps that became JPEG or WebP with colours at half the resolution, and pictures whose colours an editor changed.

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {

class Subsampled : public testing::Test {
protected:
    Subsampled() {
        scratch_.add_sample("bricks.png", "bricks.png");
        // Bumps of two texels: "photographed" stone.
        does(
            "convert -size 256x256 xc:gray50 -seed 5 +noise Random -channel G -separate -blur 0x0.7 -auto-level h.png; "
            "bake-normals h.png -o fine.png --bumpiness 2 --no-sync --quiet");
    }
    std::string does(const std::string& script) {
        const Ran ran = shell(scratch_, "set -e; " + script);
        EXPECT_EQ(ran.code, 0) << script << ": " << ran.err;
        return ran.out + ran.err;
    }
    std::string found(const std::string& file) {
        return shell(scratch_, "check-normals " + file + " 2>&1 | grep -oE ': (error|warning|note) N[0-9]+' || true")
            .out;
    }
    Scratch scratch_;
};

TEST_F(Subsampled, JpegOfFineBumpsIsNamedAndStaysANormalMap) {
    EXPECT_EQ(found("fine.png"), "");
    does(
        "convert fine.png -sampling-factor 2x2 -quality 92 half.jpg; convert fine.png -sampling-factor 1x1 -quality 92 "
        "whole.jpg; convert fine.png -sampling-factor 2x1 -quality 92 wide.jpg; convert fine.png -sampling-factor 2x2 "
        "-quality 30 poor.jpg; convert half.jpg PNG24:half.png");
    EXPECT_EQ(found("half.jpg"), ": warning N316\n");
    EXPECT_EQ(found("half.png"), ": warning N316\n") << "the file type does not matter";
    EXPECT_EQ(found("wide.jpg"), ": warning N316\n") << "4:2:2";
    EXPECT_EQ(found("whole.jpg").find("N316"), std::string::npos);
    EXPECT_EQ(found("poor.jpg"), ": warning N304\n: warning N316\n") << "and no picture of colours";
    const std::string said = does("pack-normals half.jpg -o half.dds --no-sync");
    EXPECT_NE(said.find("its colours have half the resolution of lightness"), std::string::npos) << said;
    EXPECT_EQ(said.find("other data"), std::string::npos) << said;
}

// Their own colours are at half the resolution, too.
TEST_F(Subsampled, PicturesOfColoursAreStillNone) {
    does(
        "convert -size 256x256 plasma:tan-black -seed 3 -attenuate 0.4 +noise Gaussian -sampling-factor 2x2 -quality "
        "80 "
        "photo.jpg");
    EXPECT_NE(found("photo.jpg").find("N214"), std::string::npos) << found("photo.jpg");
}

TEST_F(Subsampled, RealMapsAreNotCalledColours) {
    const std::string wild = TEX_SOURCE_DIR "/../shared/data/wild4/normal/";
    if (!std::filesystem::exists(wild)) GTEST_SKIP() << "no ../shared/data/wild4";
    for (const char* name :
         {"godotdemos_floortiles_normal", "castle_floortiles_normalmap", "ogre_Panels_Normal_Tangent"}) {
        for (const char* quality : {"30", "60", "85"}) {
            const std::string file = wild + name + ".png";
            if (!std::filesystem::exists(file)) continue;
            does("convert " + file + " -alpha off -quality " + quality + " real.jpg");
            const std::string ids = found("real.jpg");
            EXPECT_EQ(ids.find("N214"), std::string::npos) << name << " " << quality << ids;
            EXPECT_EQ(ids.find("N219"), std::string::npos) << name << " " << quality << ids;
        }
    }
}

// A hue that was turned is no picture that was turned.
TEST_F(Subsampled, AHueThatWasTurnedIsNoTurnedPicture) {
    does("bake-normals bricks.png -o n.png --bumpiness 3 --no-sync; convert n.png -modulate 100,100,90 PNG24:hue.png");
    const std::string ids = found("hue.png");
    EXPECT_NE(ids, "");
    EXPECT_EQ(ids.find("N309"), std::string::npos) << ids;
}

}  // namespace tex::cli
