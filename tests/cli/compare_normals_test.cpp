// SPDX-License-Identifier: Apache-2.0

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "cli/unmarked.h"

namespace tex::cli {

class CompareNormals : public testing::Test {
protected:
    CompareNormals() {
        scratch_.add_sample("waves.png", "waves.png");
        make("up.exr", {});
        make("down.exr", {"--y", "down"});
        make("waves.dds", {});
    }
    void make(const std::string& output, std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"waves.png", "-o", output, "--bumpiness", "8", "--no-sync"});
        const Ran ran = run(scratch_, "bake-normals", arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
    }
    Ran compare(const std::vector<std::string>& arguments) { return run(scratch_, "compare-normals", arguments); }
    Scratch scratch_;
};

TEST_F(CompareNormals, OneMapInTwoConventionsIsZeroDegreesApart) {
    const Ran ran = compare({"up.exr", "down.exr", "--json"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(nlohmann::json::parse(ran.out)["degrees"]["max"], 0.0);
    EXPECT_NE(ran.err.find("down.exr: green points down here, and up in up.exr"), std::string::npos) << ran.err;
    const Ran mistaken = compare({"up.exr", "down.exr", "--y-b", "up", "--json"});
    EXPECT_GT(nlohmann::json::parse(mistaken.out)["degrees"]["mean"], 5.0);
}

// ImageMagick enlarges the map, too, with linear interpolation of a picture that repeats.
TEST_F(CompareNormals, MagnifiesTheSmallerMapAsASamplerDoes) {
    ASSERT_EQ(shell(scratch_,
                    "pack-normals up.exr -o small.png --format rgb16 --max-size 32 --no-sync && "
                    "convert small.png -virtual-pixel tile -filter triangle -distort Resize "
                    "$(oiiotool --info up.exr | grep -o '[0-9]* x *[0-9]*' | head -1 | tr -d ' ')'!' large.png")
                  .code,
              0);
    const Ran refused = compare({"up.exr", "small.png"});
    EXPECT_EQ(refused.code, 4);
    EXPECT_NE(refused.err.find("--magnify"), std::string::npos) << refused.err;
    const auto mean = [&](const std::vector<std::string>& arguments) {
        const Ran ran = compare(arguments);
        EXPECT_EQ(ran.code, 0) << ran.err;
        return nlohmann::json::parse(lines_of(ran.out).front())["degrees"]["mean"].get<double>();
    };
    const double expected = mean({"up.exr", "large.png", "--json"});
    EXPECT_GT(expected, 0.1);
    EXPECT_NEAR(mean({"up.exr", "small.png", "--magnify", "--json"}), expected, 0.03);
    EXPECT_NEAR(mean({"small.png", "up.exr", "--magnify", "--json"}), expected, 0.03);
    EXPECT_EQ(mean({"up.exr", "down.exr", "--magnify", "--json"}), 0.0) << "nothing to enlarge";
    EXPECT_EQ(compare({"up.exr", "small.png", "--magnify", "--level", "1"}).code, 2);
}

TEST_F(CompareNormals, ShowsProgressWhereItIsAskedFor) {
    const std::vector<std::string> files = {"up.exr",  "down.exr", "--y-b",    "down",
                                            "--level", "all",      "--report", "page.html"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), files.begin(), files.end());
        return compare(more);
    };
    const Ran shown = with({"--progress", "always"});
    EXPECT_NE(shown.err.find("[..............................]   0 % up.exr"), std::string::npos) << shown.err;
    EXPECT_TRUE(shown.err.ends_with("\r\x1b[K")) << "the bar goes away";
    EXPECT_EQ(shown.out, with({}).out);
    EXPECT_EQ(with({}).err, "");
    EXPECT_EQ(with({"--progress", "always", "--quiet"}).err, "");
}

// Here, too, the layout of a file with four channels is guessed from its texels.
TEST_F(CompareNormals, LayoutsThatFilesDoNotNameAreToldFromTheTexels) {
    make("ag.dds", {"--format", "ag8"});
    make("ag.png", {"--format", "ag8"});
    for (const char* file : {"ag.dds", "ag.png"}) remove_marks(scratch_, file);
    for (const char* file : {"ag.dds", "ag.png"}) {
        const Ran ran = compare({"up.exr", file, "--max", "0.7"});
        EXPECT_EQ(ran.code, 0) << file;
        EXPECT_NE(ran.err.find(": layout not stated; guessed dxt5nm from the texels\n"), std::string::npos) << ran.err;
    }
    const Ran grey = compare({"up.exr", "waves.png"});
    EXPECT_EQ(grey.code, 4);
    EXPECT_EQ(
        grey.err,
        "compare-normals: error: waves.png: has one channel, which holds no normals (bake-normals reads heights)\n");
}

TEST_F(CompareNormals, LimitsFailWithTheReason) {
    EXPECT_EQ(compare({"up.exr", "waves.dds", "--max", "90", "--max-mean", "3", "--max-p999", "20"}).code, 0);
    const Ran over = compare({"up.exr", "waves.dds", "--max-mean", "0.001"});
    EXPECT_EQ(over.code, 1);
    EXPECT_NE(over.err.find("mean"), std::string::npos);
    EXPECT_NE(over.err.find("limit of 0.001"), std::string::npos);
    EXPECT_EQ(lines_of(over.err).size(), 1u);
    const Ran rarely = compare({"up.exr", "waves.dds", "--max-p99", "0.001"});
    EXPECT_EQ(rarely.code, 1);
    EXPECT_NE(rarely.err.find("level 0: p99 "), std::string::npos) << rarely.err;
}

TEST_F(CompareNormals, EveryLevelHasALine) {
    const Ran ran = compare({"waves.dds", "waves.dds", "--level", "all", "--json"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const auto lines = lines_of(ran.out);
    ASSERT_EQ(lines.size(), 8u);
    for (std::size_t k = 0; k < lines.size(); ++k) {
        const auto line = nlohmann::json::parse(lines[k]);
        EXPECT_EQ(line["level"], k);
        EXPECT_EQ(line["extent"][0], 128 >> k);
        EXPECT_EQ(line["degrees"]["max"], 0.0);
    }
    const Ran fewer = compare({"up.exr", "waves.dds", "--level", "all"});
    EXPECT_EQ(fewer.code, 0);
    EXPECT_EQ(lines_of(fewer.out).size(), 2u) << "a heading and a level";
    EXPECT_NE(fewer.err.find("waves.dds: has 8 levels, up.exr has 1; "), std::string::npos) << fewer.err;
    EXPECT_EQ(compare({"waves.dds", "waves.dds", "--level", "3"}).code, 0);
    const Ran missing = compare({"waves.dds", "waves.dds", "--level", "8"});
    EXPECT_EQ(missing.code, 4);
    EXPECT_NE(missing.err.find("8 levels"), std::string::npos);
}

TEST_F(CompareNormals, FoldersAreComparedByTheNamesOfTheirFiles) {
    for (const char* folder : {"old/walls", "new/walls"}) std::filesystem::create_directories(scratch_.path(folder));
    scratch_.write("old/up.exr", scratch_.read("up.exr"));
    scratch_.write("new/up.exr", scratch_.read("up.exr"));
    scratch_.write("old/walls/a.exr", scratch_.read("up.exr"));
    scratch_.write("new/walls/a.dds", scratch_.read("waves.dds"));
    scratch_.write("old/gone.exr", scratch_.read("up.exr"));
    scratch_.write("old/broken.dds", scratch_.read("waves.dds"));
    scratch_.write("new/broken.dds", "DDS ");
    scratch_.add_sample("report.png", "old/colour.png");
    scratch_.add_sample("report.png", "new/colour.png");
    const Ran ran = compare({"old", "new/", "--json", "--max-mean", "0.001"});
    EXPECT_EQ(ran.code, 4) << "the damaged file, which is worse than a limit";
    std::map<std::string, nlohmann::json> lines;
    for (const std::string& line : lines_of(ran.out)) {
        const auto json = nlohmann::json::parse(line);
        lines[json["a"]] = json;
    }
    ASSERT_EQ(lines.size(), 3u) << ran.out;
    EXPECT_EQ(lines.at("old/up.exr")["degrees"]["max"], 0.0);
    EXPECT_EQ(lines.at("old/walls/a.exr")["b"], "new/walls/a.dds");
    EXPECT_GT(lines.at("old/walls/a.exr")["degrees"]["mean"], 0.01);
    EXPECT_EQ(lines.at("old/walls/a.exr")["warnings"].size(), 0u) << "those of another pair";
    EXPECT_EQ(lines.at("old/broken.dds")["error"]["code"], "bad-data");
    EXPECT_NE(ran.err.find("old/walls/a.exr: level 0: mean"), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("old: not compared, because new/ has no file of that name: old/gone.exr"), std::string::npos)
        << ran.err;
    EXPECT_NE(ran.err.find("old: files left out, because they are no normal maps: 1\n"), std::string::npos) << ran.err;
    const std::string text = compare({"old", "new", "--quiet"}).out;
    EXPECT_NE(text.find("old/up.exr, new/up.exr:\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\nmaps compared: 2, of which 1 differ; files that failed: 1; files without a partner: 1; "
                        "largest mean: "),
              std::string::npos)
        << text;
    EXPECT_NE(text.find(" degrees, of old/walls/a.exr\n"), std::string::npos) << text;
    EXPECT_EQ(compare({"old", "up.exr"}).err,
              "compare-normals: error: up.exr: old is a folder, and is compared with another folder\n");
    const Ran pictured = compare({"old", "new", "--heatmap", "h.png"});
    EXPECT_EQ(pictured.code, 2);
    EXPECT_NE(pictured.err.find("old: is a folder, and --heatmap and --mesh are for two files"), std::string::npos);
    EXPECT_EQ(compare({"old", "new", "--heatmap", "maps"}).err, pictured.err) << "whatever its name";
    // The page has the pairs that differ and those that failed, and replaces no file of the folders.
    ASSERT_EQ(compare({"old", "new", "--report", "page.html", "--depfile", "d"}).code, 4);
    const std::string page = scratch_.read("page.html"), read = scratch_.read("d");
    EXPECT_NE(page.find("maps compared: 2, of which 1 differ; files that failed: 1; files without"), std::string::npos);
    EXPECT_NE(page.find("old/walls/a.exr and new/walls/a.dds"), std::string::npos);
    EXPECT_NE(page.find("old/broken.dds"), std::string::npos);
    EXPECT_EQ(page.find("old/up.exr and"), std::string::npos);
    EXPECT_NE(read.find(" new/walls/a.dds"), std::string::npos) << read;
    for (const char* kept : {"old/up.exr", "new/walls/a.dds", "old/gone.exr"})
        EXPECT_EQ(compare({"old", "new", "--report", kept}).code, 2) << kept;
}

TEST_F(CompareNormals, HeatMapHasTheMapAndALegend) {
    const Ran ran = compare({"up.exr", "waves.dds", "--heatmap", "heat.png", "--heatmap-scale", "10"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const auto image = read_image(scratch_.path("heat.png"));
    ASSERT_TRUE(image);
    EXPECT_EQ(image->extent(), (Extent{128, 128 + kHeatMapLegendRows}));
}

TEST_F(CompareNormals, PicturesAndPagesNeverReplaceWhatIsCompared) {
    const std::string before = scratch_.read("up.exr");
    scratch_.write("copy.png", before);  // the content, not the extension, decides how it is read
    std::filesystem::create_symlink("copy.png", scratch_.path("link.png"));
    const auto refuses = [&](const std::vector<std::string>& more, const std::string& reason) {
        std::vector<std::string> arguments = {"up.exr", "copy.png"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Ran ran = compare(arguments);
        EXPECT_EQ(ran.code, 2) << ran.err;
        EXPECT_NE(ran.err.find(reason), std::string::npos) << ran.err;
        EXPECT_EQ(scratch_.read("up.exr"), before);
        EXPECT_EQ(scratch_.read("copy.png"), before);
    };
    refuses({"--heatmap", "copy.png"}, "--heatmap: copy.png is the input copy.png");
    refuses({"--heatmap", "./link.png"}, "is the input copy.png");
    refuses({"--report", "up.exr"}, "--report: up.exr is the input up.exr");
    refuses({"--heatmap", "x.png", "--report", "x.png"}, "--report: x.png is the file of --heatmap");
    refuses({"--heatmap", "-"}, "needs the name of a file");
    refuses({"--heatmap", "x.foo"}, "x.foo: unsupported picture format");
    refuses({"--heatmap", "x.exr"}, "x.exr: unsupported picture format");
    EXPECT_EQ(compare({"up.exr", "copy.png", "--report", std::string(300, 'x')}).code, 3);
}

TEST_F(CompareNormals, ResultsThatCannotBeToldAreAFailure) {
    Setting full;
    full.stdout_path = "/dev/full";
    for (const char* json : {"--json", "--quiet"}) {
        const Ran ran = run(scratch_, "compare-normals", {"up.exr", "waves.dds", json}, full);
        EXPECT_EQ(ran.code, 3);
        EXPECT_EQ(ran.err, "compare-normals: error: standard output: no space left on the disk\n");
    }
}

TEST_F(CompareNormals, FailuresHaveALineOfJson) {
    const Ran ran = compare({"up.exr", "gone.exr", "--json"});
    EXPECT_EQ(ran.code, 3);
    const auto line = nlohmann::json::parse(ran.out);
    EXPECT_EQ(line["a"], "up.exr");
    EXPECT_EQ(line["error"]["code"], "io");
    EXPECT_EQ(line["error"]["file"], "gone.exr");
}

TEST_F(CompareNormals, RefusesWhatCannotBeCompared) {
    EXPECT_EQ(compare({"up.exr"}).code, 2);
    EXPECT_EQ(compare({"up.exr", "up.exr", "up.exr"}).code, 2);
    EXPECT_EQ(compare({"up.exr", "up.exr", "--max", "-1"}).code, 2);
    EXPECT_EQ(compare({"up.exr", "up.exr", "--heatmap-scale", "3"}).code, 2);
    EXPECT_EQ(compare({"up.exr", "gone.exr"}).code, 3);
    scratch_.write("text.png", "no picture");
    EXPECT_EQ(compare({"up.exr", "text.png"}).code, 4);
    scratch_.add_sample("ramp.png", "ramp.png");
    ASSERT_EQ(run(scratch_, "bake-normals", {"ramp.png", "-o", "small.dds"}).code, 0);
    const Ran sizes = compare({"up.exr", "small.dds"});
    EXPECT_EQ(sizes.code, 4);
    EXPECT_NE(sizes.err.find("64x64"), std::string::npos);
}

// What is a smaller level of the other map is compared by the command that the error names.
TEST_F(CompareNormals, AdvisesHowMapsOfDifferentSizesAreCompared) {
    ASSERT_EQ(run(scratch_, "pack-normals", {"up.exr", "-o", "half.exr", "--max-size", "64"}).code, 0);
    const Ran ran = compare({"half.exr", "up.exr"});
    const std::string advice =
        "; pack-normals up.exr --max-size 64 -o SMALL makes a map of that extent, and --magnify ";
    EXPECT_NE(ran.err.find(advice), std::string::npos) << ran.err;
    ASSERT_EQ(run(scratch_, "pack-normals", {"up.exr", "--max-size", "64", "-o", "small.exr"}).code, 0);
    EXPECT_EQ(compare({"half.exr", "small.exr"}).code, 0);
}

// Two bakes that agree on the charts and differ between them.
TEST_F(CompareNormals, PaddingDoesNotCountOnAMesh) {
    scratch_.write("half.obj",
                   "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\n"
                   "f 1/1 2/2 3/3 4/4\n");
    ASSERT_EQ(shell(scratch_,
                    "convert -size 128x128 'xc:rgb(128,128,255)' a.png; convert a.png -fill "
                    "'rgb(255,128,128)' -draw 'rectangle 64,0 127,127' b.png")
                  .code,
              0);
    const Ran all = compare({"a.png", "b.png", "--json"});
    EXPECT_GT(nlohmann::json::parse(all.out)["degrees"]["mean"], 40.0) << all.err;
    const Ran covered = compare({"a.png", "b.png", "--mesh", "half.obj", "--json", "--max", "0"});
    EXPECT_EQ(covered.code, 0) << covered.err;
    const auto line = nlohmann::json::parse(covered.out);
    EXPECT_EQ(line["degrees"]["max"], 0.0);
    EXPECT_EQ(line["texels"], 64 * 128);
    const Ran text = compare({"a.png", "b.png", "--mesh", "half.obj"});
    EXPECT_NE(text.out.find("; 8192 texels are covered\n"), std::string::npos) << text.out;
    const Ran page = compare({"a.png", "b.png", "--mesh", "half.obj", "--report", "p.html", "--depfile", "d"});
    EXPECT_EQ(page.code, 0) << page.err;
    EXPECT_NE(scratch_.read("d").find("half.obj"), std::string::npos);
    for (const auto& [arguments, said] : std::vector<std::pair<std::vector<std::string>, std::string>>{
             {{"a.png", "b.png", "--material", "x"}, "--material needs --mesh, or a model"},
             {{"a.png", "b.png", "--uv-set", "0"}, "--uv-set needs --mesh"},
             {{"a.png", "b.png", "--mesh", "half.obj", "--heatmap", "half.obj"}, "is the input"},
             {{"a.png", "--rdo-means", "0", "--mesh", "half.obj"}, "--mesh and --rdo-means contradict each other"}}) {
        const Ran ran = compare(arguments);
        EXPECT_EQ(ran.code, 2) << ran.err;
        EXPECT_NE(ran.err.find(said), std::string::npos) << ran.err;
    }
    EXPECT_EQ(compare({"a.png", "b.png", "--mesh", "half.obj", "--uv-set", "3"}).code, 4);
}

// The number is that of ../shared/data/SOURCES.md, which another program counted.
TEST_F(CompareNormals, ModelsOfGltfpackCoverTheTexelsThatTheyDo) {
    const std::filesystem::path wild = TEX_SOURCE_DIR "/../shared/data/wild";
    if (!std::filesystem::exists(wild)) GTEST_SKIP() << "no ../shared/data";
    const std::string map = (wild / "tangent_map_256.png").string();
    const Ran ran = compare({map, map, "--mesh", (wild / "gltfpack_default_quantized.glb").string(), "--json"});
    EXPECT_EQ(nlohmann::json::parse(ran.out)["texels"], 52900) << ran.err;
}

}  // namespace tex::cli
