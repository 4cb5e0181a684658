// SPDX-License-Identifier: Apache-2.0
// oiiotool, iinfo and maketx with the plug-in, beside the commands.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

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
    // Equal normals in an 8-bit picture and with signed floats.
    void add_maps() {
        scratch_.add_sample("waves.png", "waves.png");
        go("bake-normals waves.png -o n.png --bumpiness 12 --no-sync && "
           "bake-normals waves.png -o n.exr --bumpiness 12 --no-sync --mips none");
    }
    // Bakes x-ENCODING.ktx2 and, where DDS can hold the encoding, x-ENCODING.dds.
    void bake_each_encoding() {
        std::string script = ":";
        for (const auto& [format, type] : kinds()) {
            script +=
                " && bake-normals waves.png -o x-" + format + type + " --bumpiness 12 --no-sync --format " + format;
        }
        go(script);
    }
    // Each encoding with each extension whose files can hold it.
    static std::vector<std::pair<std::string, std::string>> kinds() {
        std::vector<std::pair<std::string, std::string>> kinds;
        for (const Named<Encoding>& row : kEncodingNames) {
            if (can_hold(Container::dds, row.value)) kinds.emplace_back(row.name, ".dds");
            if (can_hold(Container::ktx2, row.value)) kinds.emplace_back(row.name, ".ktx2");
        }
        return kinds;
    }
    Scratch scratch_;
};

// OpenImageIO's programs take long to start, so one start does all that it can.
TEST_F(OiioPrograms, OiiotoolWritesTheBytesOfPackNormals) {
    add_maps();
    std::string theirs = "oiiotool", ours;
    for (const std::string input : {"n.png", "n.exr"}) {
        theirs += " " + input;
        for (const auto& [format, type] : kinds()) {
            const std::string name = input + "-" + format + type;
            theirs += " --attrib tex:format " + format + " -o a-" + name;
            ours += " && pack-normals " + input + " --format " + format +
                    " --mips keep --normalize --supercompress none --no-sync -o b-" + name + " && cmp a-" + name +
                    " b-" + name;
        }
    }
    go(theirs + ours);
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
        {"--attrib tex:mips 1", "--mips none", "astc"},
        {"--attrib tex:mips 3 --attrib tex:format bc5", "--mips 3 --format bc5", "ktx2"},
        {"--attrib tex:dds-header dx10", "--dds-header dx10", "dds"},
        {"--attrib tex:dds-mark 1", "--dds-mark", "dds"},
    };
    std::string theirs = "oiiotool", ours;
    int number = 0;
    for (const auto& c : kCases) {
        const std::string name = std::to_string(number++) + "." + c.type;
        theirs += std::string(" n.png ") + c.attributes + " -o a" + name;
        ours += std::string(" && pack-normals n.png ") + c.options + " --no-sync -o b" + name + " && cmp a" + name +
                " b" + name;
    }
    go(theirs + ours);
}

TEST_F(OiioPrograms, OiiotoolReadsThePixelsOfUnpackNormals) {
    add_maps();
    bake_each_encoding();
    std::string theirs = "oiiotool", ours, diff = " && oiiotool";
    for (const auto& [format, type] : kinds()) {
        // input_test.cpp compares floats; unpack-normals writes them with signs.
        const Encoding encoding = *find_by_name(kEncodingNames, format);
        if (format_info(encoding_info(encoding).format).sample == SampleKind::floating) continue;
        const std::string name = "x-" + format + type, a = name + ".a.png", b = name + ".b.png";
        theirs.append(" ").append(name).append(type == ".dds" ? ".tex" : "").append(" -o ").append(a);
        ours += " && unpack-normals " + name + " --format rgb16 --no-sync -o " + b;
        diff += " --fail 0 --hardfail 0 " + a + " " + b + " --diff";
    }
    go(theirs + ours + diff);
}

// From file to file, what was not asked for stays: the encoding, the levels and y. Codes may differ by one, because the
// copy's vectors were given unit length and quantised again.
TEST_F(OiioPrograms, CopiesKeepEncodingLevelsAndY) {
    add_maps();
    go("bake-normals waves.png -o x.ktx2 --bumpiness 12 --no-sync --format rgb16 --y down && oiiotool x.ktx2 -o "
       "y.ktx2");
    const auto from = read_texture(scratch_.path("x.ktx2"));
    const auto copy = read_texture(scratch_.path("y.ktx2"));
    ASSERT_TRUE(from && copy);
    EXPECT_EQ(copy->format, from->format);
    EXPECT_EQ(copy->swizzle, from->swizzle);
    EXPECT_EQ(copy->y_axis, YAxis::down);
    EXPECT_TRUE(copy->y_known);
    ASSERT_EQ(copy->levels.size(), from->levels.size());
    for (std::size_t k = 0; k < from->levels.size(); ++k) {
        const auto expected = decode(*from, static_cast<int>(k)), read = decode(*copy, static_cast<int>(k));
        ASSERT_TRUE(expected && read);
        ASSERT_EQ(read->extent(), expected->extent());
        float largest = 0.0f;
        for (std::size_t c = 0; c < 3; ++c) {
            for (int j = 0; j < read->extent().height; ++j) {
                for (int i = 0; i < read->extent().width; ++i)
                    largest = std::max(largest, std::abs(read->planes[c].at(i, j) - expected->planes[c].at(i, j)));
            }
        }
        EXPECT_LT(largest, 1.5f / 65535.0f) << "level " << k;
    }
}

// What states the layout and y travels with the stored channels.
TEST_F(OiioPrograms, StoredChannelsKeepTheirLayoutInOtherFileTypes) {
    add_maps();
    go("bake-normals waves.png -o x.ktx2 --bumpiness 12 --no-sync --format rgb16 --mips none --y down && "
       "oiiotool --iconfig tex:unpack 0 x.ktx2 -o z.png && unpack-normals z.png --format rgb16 --no-sync -o a.png && "
       "unpack-normals x.ktx2 --format rgb16 --no-sync -o b.png && cmp a.png b.png");
}

TEST_F(OiioPrograms, StoredChannelsCanBePackedAgain) {
    add_maps();
    go("bake-normals waves.png -o x.ktx2 --bumpiness 12 --no-sync --mips none --format ag8 && "
       "oiiotool --iconfig tex:unpack 0 x.ktx2 -o y.ktx2 && cmp x.ktx2 y.ktx2");
}

TEST_F(OiioPrograms, IinfoListsLevelsAndStatistics) {
    add_maps();
    bake_each_encoding();
    const std::string text = go("iinfo -v --stats x-*.ktx2");
    for (const Named<Encoding>& row : kEncodingNames) {
        const std::string format(row.name);
        const std::size_t start = text.find("x-" + format + ".ktx2 ");
        ASSERT_NE(start, std::string::npos) << format << "\n" << text;
        const std::string part = text.substr(start, text.find("\nx-", start) - start);
        EXPECT_NE(part.find("MIP-map levels: 128x128 64x64 32x32 16x16 8x8 4x4 2x2 1x1"), std::string::npos) << part;
        EXPECT_NE(part.find("tex:format: \"" + oiio::read_as(format) + "\""), std::string::npos) << part;
        EXPECT_NE(part.find("NanCount: 0 0 0"), std::string::npos) << part;
    }
    EXPECT_NE(go("iinfo x-bc5.dds.tex").find("3 channel, uint16 tex"), std::string::npos);
}

TEST_F(OiioPrograms, MaketxWritesLevels) {
    add_maps();
    for (const std::string name : {"t.dds", "t.ktx2"}) {
        go("maketx n.png --attrib tex:effort fast -o " + name);
        const auto texture = read_texture(scratch_.path(name));
        ASSERT_TRUE(texture) << texture.error().message();
        EXPECT_EQ(texture->levels.size(), 8u);
        EXPECT_EQ(texture->format, Format::bc3_unorm);
        // maketx averages colours; levels of both are the same map.
        go("bake-normals waves.png -o own.dds --bumpiness 12 --no-sync && compare-normals " + name +
           " own.dds --max-mean 2");
    }
}

// OpenImageIO's own reader of DDS returns the stored channels. What is in A is x, and nothing was multiplied by it.
TEST_F(OiioPrograms, StoredChannelsOfOpenImageIOsReaderAreNormals) {
    add_maps();
    std::string theirs = "oiiotool", ours;
    for (const std::string format : {"dxt5nm", "ag8", "rgba8", "rgb8", "bc5"}) {
        theirs += " x-" + format + ".dds -o y-" + format + ".ktx2";
        ours += " && compare-normals x-" + format + ".dds y-" + format + ".ktx2 --max-mean 1.5";
    }
    bake_each_encoding();
    go(theirs + ours);
}

// A program that only changes the type of a picture of colours does not make components of them.
TEST_F(OiioPrograms, SignedIntegersAreColours) {
    add_maps();
    std::string theirs = "oiiotool", ours;
    for (const std::string type : {"int8", "int16", "int32"}) {
        theirs += " n.png -d " + type + " --attrib tex:format rgb16 -o " + type + ".ktx2";
        ours += " && compare-normals n.png " + type + ".ktx2 --max-mean 0.6";
    }
    go(theirs + ours);
}

TEST_F(OiioPrograms, YTravelsThroughTiffAndJpeg) {
    add_maps();
    go("bake-normals waves.png -o x.dds --bumpiness 12 --no-sync --y down --mips none");
    for (const std::string type : {"tif", "jpg", "png"}) {
        go("oiiotool x.dds.tex -o x." + type + " && oiiotool x." + type +
           " -o y.dds && "
           "compare-normals x.dds y.dds --max-mean 3 && compare-normals x.dds x." +
           type + " --max-mean 3");
        const auto copy = read_texture(scratch_.path("y.dds"));
        ASSERT_TRUE(copy);
        EXPECT_TRUE(copy->y_known && copy->y_axis == YAxis::down) << type;
    }
}

TEST_F(OiioPrograms, MaketxReadsDdsThroughALink) {
    add_maps();
    go("bake-normals waves.png -o x.dds --bumpiness 12 --no-sync && ln -s x.dds x.dds.tex && "
       "maketx x.dds.tex -o t.dds && compare-normals x.dds t.dds --max-mean 1.5");
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
    // oiiotool 2.4 asks for readers that need no file, and would crash if one cannot open what it has offered.
    for (const char* bytes : {"DDS ", "DDS |", "none"}) {
        go(std::string("printf '") + bytes + "' > bad.dds");
        EXPECT_NE(error("oiiotool bad.dds.tex -o x.png").find("bad.dds"), std::string::npos) << bytes;
        EXPECT_NE(error("iinfo bad.dds.tex").find("bad.dds"), std::string::npos) << bytes;
    }
    EXPECT_NE(error("oiiotool n.png --attrib tex:mips all -o x.astc").find("holds one level"), std::string::npos);
    EXPECT_FALSE(scratch_.has("x.astc"));
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
