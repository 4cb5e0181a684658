// SPDX-License-Identifier: Apache-2.0
// oiiotool, iinfo and maketx with the plug-in, beside the commands.

#include <filesystem>

#include <gtest/gtest.h>

#include "oiio/plugin.h"

namespace tex::oiio {
namespace {

class OiioPrograms : public testing::Test {
protected:
    // Runs a script that must succeed.
    std::string go(const std::string& script) {
        const cli::Ran ran = oiio::shell(scratch_, script);
        EXPECT_EQ(ran.code, 0) << script << "\n" << ran.out << ran.err;
        return ran.out;
    }
    // The same normals in an 8-bit picture and with signed floats.
    void add_maps() {
        scratch_.add_sample("bricks.png", "bricks.png");
        go("bake-normals bricks.png -o n.png --bumpiness 12 --no-sync && "
           "bake-normals bricks.png -o n.exr --bumpiness 12 --no-sync --mips none");
    }
    cli::Scratch scratch_;
};

TEST_F(OiioPrograms, OiiotoolWritesTheBytesOfPackNormals) {
    add_maps();
    for (const std::string input : {"n.png", "n.exr"}) {
        for (const Named<Encoding>& row : kEncodingNames) {
            const std::string format(row.name);
            for (const std::string type : {"dds", "ktx2"}) {
                if (!can_hold(type == "dds" ? Container::dds : Container::ktx2, row.value)) continue;
                const std::string out = "." + type;
                go("oiiotool " + input + " --attrib tex:format " + format + " -o a" + out + " && pack-normals " +
                   input + " --format " + format + " --mips keep --no-sync -o b" + out + " && cmp a" + out + " b" +
                   out);
            }
        }
    }
}

TEST_F(OiioPrograms, AttributesAreTheOptionsOfTheCommands) {
    add_maps();
    const struct {
        const char* attributes;
        const char* options;
        const char* type;
    } kCases[] = {
        {"", "", "dds"},
        {"", "", "ktx2"},
        {"", "", "astc"},
        {"--attrib tex:effort best --attrib tex:metric angle", "--effort best --metric angle", "dds"},
        {"--attrib tex:effort FAST", "--effort fast", "dds"},
        {"--attrib tex:y down", "--y down", "dds"},
        {"--attrib normalYAxis down", "--y-in down", "dds"},
        {"--attrib normalYAxis down --attrib tex:y up", "--y-in down --y up", "ktx2"},
        {"--attrib tex:mips all", "--mips all", "dds"},
        {"--attrib tex:mips 3 --attrib tex:format bc5", "--mips 3 --format bc5", "ktx2"},
        {"--attrib tex:dds-header dx10", "--dds-header dx10", "dds"},
        {"--attrib tex:dds-mark 1", "--dds-mark", "dds"},
    };
    for (const auto& c : kCases) {
        const std::string type = c.type;
        go(std::string("oiiotool n.png ") + c.attributes + " -o a." + type + " && pack-normals n.png " + c.options +
           " --no-sync -o b." + type + " && cmp a." + type + " b." + type);
    }
}

TEST_F(OiioPrograms, OiiotoolReadsThePixelsOfUnpackNormals) {
    add_maps();
    for (const Named<Encoding>& row : kEncodingNames) {
        const std::string format(row.name);
        const bool floats = row.value == Encoding::half || row.value == Encoding::float_;
        go("bake-normals bricks.png -o x.ktx2 --bumpiness 12 --no-sync --format " + format);
        if (floats) continue;  // input_test.cpp compares them; unpack-normals writes them with signs
        go("oiiotool x.ktx2 -o a.png && unpack-normals x.ktx2 --format rgb16 --no-sync -o b.png && idiff a.png b.png");
        if (!can_hold(Container::dds, row.value)) continue;
        go("bake-normals bricks.png -o x.dds --bumpiness 12 --no-sync --format " + format +
           " && oiiotool x.dds.tex -o a.png && unpack-normals x.dds --format rgb16 --no-sync -o b.png && "
           "idiff a.png b.png");
    }
}

// From file to file, what was not asked for stays: the encoding, the levels and y.
TEST_F(OiioPrograms, CopiesKeepEncodingLevelsAndY) {
    add_maps();
    go("bake-normals bricks.png -o x.ktx2 --bumpiness 12 --no-sync --format rgb16 --y down && oiiotool x.ktx2 -o "
       "y.ktx2");
    EXPECT_EQ(scratch_.read("x.ktx2"), scratch_.read("y.ktx2"));
    go("oiiotool --iconfig tex:unpack 0 x.ktx2 -o z.exr && unpack-normals z.exr --format rgb16 --no-sync -o z.png && "
       "unpack-normals x.ktx2 --format rgb16 --no-sync -o w.png && idiff z.png w.png");
}

TEST_F(OiioPrograms, StoredChannelsCanBePackedAgain) {
    add_maps();
    go("bake-normals bricks.png -o x.ktx2 --bumpiness 12 --no-sync --mips none --format ag8 && "
       "oiiotool --iconfig tex:unpack 0 x.ktx2 -o y.ktx2 && cmp x.ktx2 y.ktx2");
}

TEST_F(OiioPrograms, IinfoListsLevelsAndStatistics) {
    add_maps();
    for (const Named<Encoding>& row : kEncodingNames) {
        go("bake-normals bricks.png -o x.ktx2 --bumpiness 12 --no-sync --format " + std::string(row.name));
        const std::string text = go("iinfo -v --stats x.ktx2");
        EXPECT_NE(text.find("MIP-map levels: 512x512 256x256 128x128 64x64 32x32 16x16 8x8 4x4 2x2 1x1"),
                  std::string::npos)
            << text;
        EXPECT_NE(text.find("tex:format: \"" + std::string(row.name) + "\""), std::string::npos) << text;
        EXPECT_NE(text.find("NanCount: 0 0 0"), std::string::npos) << text;
    }
    EXPECT_NE(go("oiiotool --help").find("tex"), std::string::npos);
    go("bake-normals bricks.png -o x.dds --no-sync && iinfo x.dds.tex | grep -q '3 channel, uint16 tex'");
}

TEST_F(OiioPrograms, MaketxWritesLevels) {
    add_maps();
    for (const std::string name : {"t.dds", "t.ktx2"}) {
        go("maketx n.png --attrib tex:effort fast -o " + name);
        const auto texture = read_texture(scratch_.path(name));
        ASSERT_TRUE(texture) << texture.error().message();
        EXPECT_EQ(texture->levels.size(), 10u);
        EXPECT_EQ(texture->format, Format::bc3_unorm);
        // maketx averages colours; levels of both are the same map.
        go("bake-normals bricks.png -o own.dds --bumpiness 12 --no-sync && compare-normals " + name +
           " own.dds --max-mean 2");
    }
}

TEST_F(OiioPrograms, ErrorsAreReportedAndNoFileIsLeft) {
    add_maps();
    const auto error = [&](const std::string& script) {
        const cli::Ran ran = oiio::shell(scratch_, script);
        EXPECT_NE(ran.code, 0);
        EXPECT_LT(ran.code, 128) << ran.err;
        return ran.out + ran.err;
    };
    EXPECT_NE(error("oiiotool n.png --attrib tex:format dxt9 -o x.dds").find("tex:format is \"dxt9\""),
              std::string::npos);
    EXPECT_NE(error("oiiotool n.png --ch R -o x.dds").find("2 to 4 channels, not 1"), std::string::npos);
    EXPECT_NE(error("oiiotool n.png -o none/x.dds").find("none/x.dds"), std::string::npos);
    EXPECT_NE(error("oiiotool none.dds.tex -o x.png").find("none.dds"), std::string::npos);
    EXPECT_FALSE(scratch_.has("x.dds"));
    EXPECT_FALSE(scratch_.has("x.png"));
}

// All hostile files in one process, which must end by itself: the plug-in and its threads leave it sound.
TEST_F(OiioPrograms, IinfoSurvivesHostileFiles) {
    std::filesystem::create_directory(scratch_.path("bad"));
    int count = 0;
    for (const std::string folder :
         {"/tests/fuzz/corpus/dds", "/tests/fuzz/corpus/ktx2", "/tests/fuzz/corpus/astc", "/../shared/data/bad"}) {
        if (!std::filesystem::exists(TEX_SOURCE_DIR + folder)) continue;
        for (const auto& entry : std::filesystem::directory_iterator(TEX_SOURCE_DIR + folder)) {
            std::filesystem::copy_file(entry.path(), scratch_.path("bad/" + std::to_string(count++) + ".ktx2"));
        }
    }
    const std::string run = "timeout 300 iinfo --stats bad/*.ktx2";
    const cli::Ran ran = oiio::shell(scratch_, "OPENIMAGEIO_OPTIONS=try_all_readers=0 " + run);
    EXPECT_LT(ran.code, 124) << ran.err;
    const std::string text = ran.out + ran.err;
    std::size_t errors = 0;
    for (std::size_t at = 0; (at = text.find("iinfo ERROR", at)) != std::string::npos; ++at) ++errors;
    EXPECT_GE(errors, 20u) << text;
    EXPECT_LT(ran.peak_bytes, std::int64_t{1} << 30);
}

// The commands read strangers' files in a process that OpenImageIO's environment does not reach.
TEST_F(OiioPrograms, CommandsAreTheSameWithThePlugIn) {
    add_maps();
    go("oiiotool n.png -o n.tif && pack-normals n.tif --no-sync -o a.dds");
    const cli::Ran ran = cli::shell(scratch_, "pack-normals n.tif --no-sync -o b.dds && cmp a.dds b.dds");
    EXPECT_EQ(ran.code, 0) << ran.err;
}

}  // namespace
}  // namespace tex::oiio
