// SPDX-License-Identifier: Apache-2.0
// --format bc7: what the commands make of it.

#include <string>

#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {

class Bc7 : public testing::Test {
protected:
    Bc7() {
        scratch_.add_sample("bricks.png", "bricks.png");
        does("bake-normals bricks.png -o b.png --bumpiness 8");
    }
    Ran does(const std::string& script) {
        Ran ran = shell(scratch_, "set -e; " + script);
        EXPECT_EQ(ran.code, 0) << script << ": " << ran.out << ran.err;
        return ran;
    }
    Scratch scratch_;
};

// Encoders of BC7 leave the lengths of vectors as they come: that is no finding, in no level.
TEST_F(Bc7, WhatIsWrittenHasNoFindings) {
    for (const std::string effort : {"fast", "normal"}) {
        for (const std::string name : {"a.dds", "a.ktx2"}) {
            does("bake-normals bricks.png -o " + name + " --format bc7 --bumpiness 8 --effort " + effort +
                 "; check-normals " + name + " --fail-on warning --require format=bc7; compare-normals b.png " + name +
                 " --max-mean 0.7");
        }
    }
}

TEST_F(Bc7, GetsSmallerWithinAPromisedAngle) {
    does(
        "pack-normals b.png -o p.ktx2 --format bc7 --effort fast --supercompress zstd; "
        "pack-normals b.png -o s.ktx2 --format bc7 --effort fast --supercompress zstd --rdo-mean 0.2; "
        "check-normals s.ktx2 --fail-on warning; compare-normals b.png p.ktx2 --max-mean 0.7; "
        "compare-normals b.png s.ktx2 --max-mean 0.9");
    EXPECT_LT(scratch_.read("s.ktx2").size(), 0.9 * static_cast<double>(scratch_.read("p.ktx2").size()));
}

// Levels and their roughness, as for other encodings.
TEST_F(Bc7, LevelsHaveRoughnessBesideThem) {
    for (const std::string format : {"bc7", "uastc"}) {
        does("mip-normals b.png -o " + format + ".ktx2 --format " + format + " --roughness-out r.ktx2; check-normals " +
             format + ".ktx2 --fail-on warning --require format=" + format + " --require mips=full");
    }
}

// x in alpha: Doom 3. Files of DDS do not say so: the texels do.
TEST_F(Bc7, PutsXInAlpha) {
    for (const std::string name : {"x.dds", "x.ktx2"}) {
        does("pack-normals b.png -o " + name + " --format bc7-rxgb --mips all; check-normals " + name +
             " --fail-on warning --require format=bc7-rxgb; compare-normals b.png " + name +
             " --max-mean 0.8; unpack-normals " + name +
             " -o n.png --level 0; compare-normals b.png n.png --max-mean "
             "0.9; pack-normals " +
             name + " -o plain.dds --format bc7; compare-normals b.png plain.dds --max-mean 1");
    }
    does(
        "pack-normals b.png -o s.ktx2 --format bc7-rxgb --effort fast --rdo-mean 0.2 --supercompress zstd; "
        "pack-normals b.png -o p.ktx2 --format bc7-rxgb --effort fast --supercompress zstd; "
        "compare-normals b.png s.ktx2 --max-mean 1");
    EXPECT_LT(scratch_.read("s.ktx2").size(), 0.9 * static_cast<double>(scratch_.read("p.ktx2").size()));
}

TEST_F(Bc7, KeepsAlphaAndRefusesWhatItCannotHold) {
    does(
        "bake-normals bricks.png -o a.dds --format bc7 --alpha bricks.png --bumpiness 8; "
        "unpack-normals a.dds -o n.png --alpha-out h.png; compare-normals b.png n.png --max-mean 1; "
        "pack-normals b.png -o c.dds --format bc7 --alpha bricks.png --mips all; check-normals c.dds --fail-on "
        "warning");
    EXPECT_EQ(does("unpack-normals c.dds -o c.png --level 0 --alpha-out h.png").err, "") << "lengths are free";
    const auto fails = [&](const std::string& line, const std::string& reason) {
        const Ran ran = shell(scratch_, line);
        EXPECT_EQ(ran.code, 2) << ran.err;
        EXPECT_NE(ran.err.find(reason), std::string::npos) << ran.err;
    };
    fails("pack-normals b.png -o x.png --format bc7", "bc7 goes into .dds, .ktx2");
    fails("pack-normals b.png -o x.dds --format bc7 --blue bricks.png", "blue");
}

}  // namespace tex::cli
