// SPDX-License-Identifier: Apache-2.0
// --rdo-mean makes compressed files smaller, at a promised angle.

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {
namespace {

class RdoOption : public testing::Test {
protected:
    RdoOption() {
        scratch_.add_sample("bricks.png", "a.png");
        does("bake-normals a.png -o n.exr --mips none --bumpiness 1");
    }
    std::string does(const std::string& line) {
        const Ran ran = shell(scratch_, line + " --no-sync");
        EXPECT_EQ(ran.code, 0) << line << ": " << ran.err;
        EXPECT_EQ(without_notes(ran.err), "") << line;
        return ran.out;
    }

    Scratch scratch_;
};

// Whatever the level at which a file is compressed, it is never larger than without optimisation.
TEST_F(RdoOption, NoFileGrows) {
    const std::string wild = TEX_SOURCE_DIR "/../shared/data/trial3/grow_dxt5nm_0.05_9.dds";
    const auto expect_no_growth = [this](const std::string& input, const std::string& level, const std::string& mean) {
        const std::string pack = "pack-normals " + input +
                                 " --mips all --format dxt5nm --effort fast --quiet --no-sync "
                                 "--json --supercompress zstd:" +
                                 level;
        const auto plain = nlohmann::json::parse(shell(scratch_, pack + " -o plain.ktx2").out);
        const auto small =
            nlohmann::json::parse(shell(scratch_, pack + " -o small.ktx2 --rdo-window 4096 --rdo-mean " + mean).out);
        EXPECT_LE(small["bytes"], plain["bytes"]) << input << ' ' << level << ' ' << mean;
        EXPECT_LE(small["rdo"]["most_growth"].get<double>(), std::stod(mean) + 1e-6);
    };
    expect_no_growth("n.exr", "1", "0.02");
    if (!std::filesystem::exists(wild)) GTEST_SKIP() << "without shared data";
    expect_no_growth(wild, "9", "0.05");
    expect_no_growth(wild, "1", "0.05");
}

TEST_F(RdoOption, FilesAreSmallerAndTheReportShowsThePromise) {
    const std::string pack = "pack-normals n.exr --supercompress zstd:19 --format bc5 --json -o ";
    const auto plain = nlohmann::json::parse(does(pack + "plain.ktx2"));
    EXPECT_FALSE(plain.contains("rdo"));
    const auto small = nlohmann::json::parse(does(pack + "small.ktx2 --rdo-mean 0.25 --rdo-max 2 --rdo-window 4096"));
    EXPECT_LT(small["bytes"], plain["bytes"]);
    const auto& rdo = small["rdo"];
    EXPECT_LE(rdo["mean"].get<double>(), rdo["plain_mean"].get<double>() + 0.25);
    EXPECT_LE(rdo["most_growth"], 0.25);
    EXPECT_LE(rdo["most_raised"], 2.0);
    EXPECT_EQ(shell(scratch_, "check-normals small.ktx2").code, 0);
}

TEST_F(RdoOption, AstcFilesCompressBetter) {
    const std::string pack = "pack-normals n.exr --format astc-6x6 --effort fast --mips none --json -o ";
    const auto plain = nlohmann::json::parse(does(pack + "plain.ktx2 --supercompress zstd:19"));
    const auto small = nlohmann::json::parse(does(pack + "small.ktx2 --supercompress zstd:19 --rdo-mean 0.5"));
    EXPECT_LT(small["bytes"], plain["bytes"]);
    EXPECT_LE(small["rdo"]["most_growth"], 0.5);
    does(pack + "plain.astc");
    does(pack + "small.astc --rdo-mean 0.5");
    EXPECT_EQ(scratch_.read("small.astc").size(), scratch_.read("plain.astc").size());
    EXPECT_NE(scratch_.read("small.astc"), scratch_.read("plain.astc"));
}

TEST_F(RdoOption, BytesAreTheSameForAllThreads) {
    scratch_.add_sample("waves.png", "w.png");
    does("bake-normals w.png -o w.exr --mips none --bumpiness 20");
    const std::string pack = "pack-normals w.exr --mips all --effort fast --rdo-mean 0.2 --rdo-window 256 -o ";
    does(pack + "one.dds --threads 1");
    does(pack + "four.dds --threads 4");
    EXPECT_TRUE(scratch_.read("one.dds") == scratch_.read("four.dds"));
    does("pack-normals w.exr --mips 2 --rdo-mean 0.2 --rdo-window 256 --out-dir . --name level{level}.dds");
    EXPECT_TRUE(scratch_.has("level1.dds"));
}

TEST_F(RdoOption, WhatDoesNotFitIsAUsageError) {
    const std::pair<const char*, const char*> cases[] = {
        {"-o b.png --rdo-mean 1", "pack-normals: error: b.png: --rdo-mean needs a DDS, KTX2 or ASTC file\n"},
        {"-o b.dds --rdo-max 1", "pack-normals: error: --rdo-max needs --rdo-mean\n"},
        {"-o b.dds --rdo-window 1024", "pack-normals: error: --rdo-window needs --rdo-mean\n"},
        {"-o b.dds --rdo-mean 1 --format rgba8",
         "pack-normals: error: --rdo-mean needs --format to be one of dxt5nm, bc5, bc5-snorm, eac-rg11, "
         "eac-rg11-snorm, astc-4x4, astc-5x4, astc-5x5, astc-6x5, astc-6x6, astc-8x5, astc-8x6, astc-8x8, bc7, "
         "uastc, uastc-rrrg, bc7-rxgb\n"}};
    for (const auto& [arguments, message] : cases) {
        const Ran ran = shell(scratch_, std::string("pack-normals n.exr ") + arguments);
        EXPECT_EQ(ran.code, 2) << arguments;
        EXPECT_EQ(ran.err, message);
    }
    for (const char* wrong : {"--rdo-mean 0", "--rdo-mean nan", "--rdo-mean -1", "--rdo-mean 1 --rdo-max 0",
                              "--rdo-mean 1 --rdo-window 63", "--rdo-mean 1 --rdo-window 1048577"})
        EXPECT_EQ(shell(scratch_, std::string("pack-normals n.exr -o b.dds ") + wrong).code, 2) << wrong;
    EXPECT_FALSE(scratch_.has("b.dds") || scratch_.has("b.png"));
}

}  // namespace
}  // namespace tex::cli
