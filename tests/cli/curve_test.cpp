// SPDX-License-Identifier: Apache-2.0
// The curve of compare-normals: its figures beside those of the commands that it saves, and its picture.

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {
namespace {

class Curve : public testing::Test {
protected:
    Curve() {
        scratch_.add_sample("bricks.png", "a.png");
        EXPECT_EQ(shell(scratch_, "bake-normals a.png -o n.exr --mips none --no-sync").code, 0);
    }
    [[nodiscard]] Ran curve(const std::string& arguments) const {
        return shell(scratch_, "compare-normals n.exr " + arguments);
    }
    Scratch scratch_;
};

TEST_F(Curve, FiguresAreThoseOfPackedFiles) {
    const Ran ran = curve("--rdo-means 0,0.25 --rdo-window 512 --json");
    ASSERT_EQ(ran.code, 0) << ran.err;
    const std::vector<std::string> lines = lines_of(ran.out);
    ASSERT_EQ(lines.size(), 2u);
    const std::string options[] = {"", " --rdo-mean 0.25 --rdo-window 512"};
    double bytes[2];
    for (std::size_t k = 0; k < 2; ++k) {
        const Ran packed = shell(scratch_,
                                 "pack-normals n.exr -o n.ktx2 --format bc5 --mips none --no-sync "
                                 "--supercompress zstd:19 --json" +
                                     options[k]);
        ASSERT_EQ(packed.code, 0) << packed.err;
        const auto point = nlohmann::json::parse(lines[k]);
        bytes[k] = point["bytes"];
        EXPECT_EQ(point["bytes"], nlohmann::json::parse(packed.out)["bytes"]);
        EXPECT_NEAR(point["change"].get<double>(), bytes[k] / bytes[0] - 1.0, 1e-6);
        EXPECT_EQ(point["format"], "bc5");
        const auto compared = nlohmann::json::parse(shell(scratch_, "compare-normals n.exr n.ktx2 --json").out);
        for (const char* figure : {"mean", "p99.9", "max"})
            EXPECT_EQ(point["degrees"][figure], compared["degrees"][figure]) << figure;
    }
    EXPECT_LT(bytes[1], bytes[0]);
}

TEST_F(Curve, ThePictureHasAPointForEverySettingInEveryPanel) {
    const Ran ran = curve("--rdo-means 0,0.2,0.5 --rdo-window 256 --format eac-rg11 --plot 'a<b.svg'");
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(ran.err, "");
    EXPECT_EQ(lines_of(ran.out).size(), 4u);
    EXPECT_NE(ran.out.find("rdo-mean"), std::string::npos);
    const std::string svg = scratch_.read("a<b.svg");
    EXPECT_TRUE(svg.starts_with("<svg "));
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
    EXPECT_NE(svg.find("prefers-color-scheme: dark"), std::string::npos);
    const auto count = [&](const std::string& text) {
        std::size_t found = 0;
        for (std::size_t at = svg.find(text); at != std::string::npos; at = svg.find(text, at + 1)) ++found;
        return found;
    };
    EXPECT_EQ(count("<circle "), 9u);
    EXPECT_EQ(count("class=\"line\""), 3u);
    EXPECT_EQ(count("--rdo-mean 0.2: "), 3u);
    EXPECT_EQ(count("nan") + count("inf"), 0u);
}

// All figures are equal: the axes still have an extent.
TEST_F(Curve, OnePointIsACurve) {
    ASSERT_EQ(curve("--rdo-means 0 --plot one.svg").code, 0);
    const std::string svg = scratch_.read("one.svg");
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_NE(svg.find("<circle "), std::string::npos);
}

TEST_F(Curve, WhatDoesNotFitIsAUsageError) {
    const std::pair<const char*, const char*> cases[] = {
        {"--plot c.svg", "--plot needs --rdo-means"},
        {"n.exr --rdo-window 64", "--rdo-window needs --rdo-means"},
        {"n.exr --rdo-means 0,0.1", "--rdo-means takes one file: A"},
        {"--rdo-means 0 --max-mean 1", "--max-mean and --rdo-means contradict each other"},
        {"--rdo-means 0.2,0.1", "--rdo-means: its angles must rise"},
        {"--rdo-means 0,,1", "--rdo-means: '' is not a number"},
        {"--rdo-means 0,nan", "--rdo-means: nan is not a finite number"},
        {"--rdo-means 0 --format rgba8",
         "--format: must be one of dxt5nm, bc5, bc5-snorm, eac-rg11, eac-rg11-snorm, astc-4x4, astc-5x4, astc-5x5, "
         "astc-6x5, astc-6x6, astc-8x5, astc-8x6, astc-8x8, bc7, uastc, uastc-rrrg, bc7-rxgb, not 'rgba8'"},
        {"--rdo-means 0 --plot n.exr", "--plot: n.exr is the input n.exr"},
    };
    for (const auto& [arguments, message] : cases) {
        const Ran ran = curve(arguments);
        EXPECT_EQ(ran.code, 2) << arguments;
        EXPECT_EQ(ran.err, std::string("compare-normals: error: ") + message + "\n");
    }
    EXPECT_FALSE(scratch_.has("c.svg"));
    const Ran missing = shell(scratch_, "compare-normals none.exr --rdo-means 0 --plot c.svg");
    EXPECT_EQ(missing.code, 3);
    EXPECT_FALSE(scratch_.has("c.svg"));
}

}  // namespace
}  // namespace tex::cli
