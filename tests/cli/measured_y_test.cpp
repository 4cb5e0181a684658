// SPDX-License-Identifier: Apache-2.0
// --y-in measured: the texels show which way green points.

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "cli/program.h"

namespace tex::cli {

class MeasuredY : public testing::Test {
protected:
    MeasuredY() {
        for (const char* name : {"strip.png", "bricks.png"}) scratch_.add_sample(name, name);
        for (const char* y : {"up", "down"}) {
            make("bake-normals", {"strip.png", "-o", std::string(y) + ".png", "--y", y, "--wrap", "clamp"});
            make("bake-normals", {"bricks.png", "-o", std::string(y) + ".dds", "--y", y, "--bumpiness", "2"});
        }
    }
    void make(const std::string& command, std::vector<std::string> arguments, const Setting& setting = {}) {
        arguments.insert(arguments.end(), {"--no-sync", "--quiet"});
        const Ran ran = run(scratch_, command, arguments, setting);
        EXPECT_EQ(ran.code, 0) << command << " " << arguments[0] << ": " << ran.err;
        EXPECT_EQ(ran.err, "");
    }
    // Whether a command makes the same of `input` if it measures y as if it is told y.
    void expect_same(const std::string& command, const std::string& input, const std::string& y,
                     const std::string& output, std::vector<std::string> more) {
        SCOPED_TRACE(command + " " + input);
        more.insert(more.begin(), {input, "-o", output, "--y-in", y});
        make(command, more);
        const std::string told = scratch_.read(output);
        more[4] = "measured";
        make(command, more);
        EXPECT_TRUE(scratch_.read(output) == told);
        more[4] = y == "up" ? "down" : "up";
        make(command, more);
        EXPECT_FALSE(scratch_.read(output) == told);
    }

    Scratch scratch_;
};

TEST_F(MeasuredY, EveryCommandReadsAsIfItWereTold) {
    for (const std::string y : {"up", "down"}) {
        for (const std::string type : {".png", ".dds"}) {
            expect_same("pack-normals", y + type, y, "a.exr", {"--y", "up"});
            expect_same("mip-normals", y + type, y, "a.ktx2", {"--y", "up", "--format", "bc5"});
            expect_same("unpack-normals", y + type, y, "a.png", {"--y", "up"});
            expect_same("scale-normals", y + type, y, "a.png", {"--y", "up", "--scale", "2"});
            expect_same("preview-normals", y + type, y, "a.png", {"--size", "64"});
        }
    }
}

// A statement that the texels contradict, whether or not the output depends on it.
TEST_F(MeasuredY, AWrongStatementIsSaid) {
    for (const char* line : {"pack-normals up.png", "pack-normals up.png --y up", "scale-normals up.png --scale 2"}) {
        const Ran ran = shell(scratch_, std::string(line) + " -o a.png --y-in down --no-sync");
        EXPECT_EQ(ran.code, 0) << line;
        EXPECT_NE(ran.err.find("green is stated to point down, but the texels show the other direction"),
                  std::string::npos)
            << line << ran.err;
    }
}

TEST_F(MeasuredY, EachMapOfABlendShowsItsOwn) {
    // Base and detail have different directions; details are held or streamed, by their extent.
    for (const std::string detail : {"down.png", "down.dds"}) {
        make("blend-normals", {"up.png", "-o", "a.exr", "--detail", detail, "--y-in", "up", "--detail-y-in", "down"});
        const std::string told = scratch_.read("a.exr");
        make("blend-normals", {"up.png", "-o", "a.exr", "--detail", detail, "--y-in", "measured"});
        EXPECT_TRUE(scratch_.read("a.exr") == told) << detail;
        make("blend-normals", {detail, "-o", "a.exr", "--detail", "up.png", "--y-in", "down", "--detail-y-in", "up"});
        const std::string other = scratch_.read("a.exr");
        make("blend-normals", {detail, "-o", "a.exr", "--detail", "up.png", "--y-in", "measured"});
        EXPECT_TRUE(scratch_.read("a.exr") == other) << detail;
    }
}

TEST_F(MeasuredY, DetailsAloneCanBeMeasured) {
    for (const std::string detail : {"down.png", "down.dds"}) {
        make("blend-normals", {"up.png", "-o", "a.exr", "--detail", detail, "--detail-y-in", "down", "--y-in", "up"});
        const std::string told = scratch_.read("a.exr");
        make("blend-normals", {"up.png", "-o", "a.exr", "--detail", detail, "--detail-y-in", "measured"});
        EXPECT_TRUE(scratch_.read("a.exr") == told) << detail;
        make("preview-normals", {"up.png", "-o", "a.png", "--size", "64", "--detail", detail, "--detail-y-in", "down"});
        const std::string picture = scratch_.read("a.png");
        make("preview-normals",
             {"up.png", "-o", "a.png", "--size", "64", "--detail", detail, "--detail-y-in", "measured"});
        EXPECT_TRUE(scratch_.read("a.png") == picture) << detail;
    }
    make("blend-normals",
         {"up.png", "down.dds", "--out-dir", "shared", "--detail", "down.png", "--detail-y-in", "down"});
    const std::string told = scratch_.read("shared/up.dds");
    make("blend-normals",
         {"up.png", "down.dds", "--out-dir", "shared", "--detail", "down.png", "--detail-y-in", "measured"});
    EXPECT_TRUE(scratch_.read("shared/up.dds") == told);
}

TEST_F(MeasuredY, OutputsStateIt) {
    make("pack-normals", {"down.png", "-o", "a.ktx2", "--y-in", "measured"});
    make("pack-normals", {"down.png", "-o", "b.ktx2", "--y-in", "down"});
    EXPECT_TRUE(scratch_.read("a.ktx2") == scratch_.read("b.ktx2"));
}

TEST_F(MeasuredY, StandardInputIsReadToo) {
    const Ran ran = shell(scratch_,
                          "cat down.png | pack-normals - -o a.dds --y-in measured --y up --quiet --no-sync\n"
                          "pack-normals down.png -o b.dds --y-in down --y up --quiet --no-sync; cmp a.dds b.dds");
    EXPECT_EQ(ran.code, 0) << ran.err;
}

TEST_F(MeasuredY, MapsThatDoNotShowItAreErrorsThatNameThem) {
    EXPECT_EQ(shell(scratch_,
                    "head -c 12288 /dev/zero | tr '\\0' '\\200' >flat.rgb; "
                    "convert -size 64x64 -depth 8 rgb:flat.rgb PNG24:flat.png || exit 9")
                  .code,
              0);
    for (const char* command : {"pack-normals", "preview-normals"}) {
        const Ran ran = run(scratch_, command, {"flat.png", "-o", "out.png", "--y-in", "measured", "--quiet"});
        EXPECT_EQ(ran.code, 4);
        EXPECT_EQ(ran.err,
                  std::string(command) +
                      ": error: flat.png: which way green points does not show clearly in the texels; say up or "
                      "down instead of measured, or \"measured, else up\"\n");
        EXPECT_FALSE(scratch_.has("out.png"));
    }
    const Ran blend = run(scratch_, "blend-normals",
                          {"up.png", "-o", "out.png", "--detail", "flat.png", "--y-in", "measured", "--quiet"});
    EXPECT_EQ(blend.code, 4);
    EXPECT_NE(blend.err.find("flat.png: which way green points"), std::string::npos) << blend.err;
}

// Neither direction is right for all of such a map, so nothing is flipped; the words are those of the check.
TEST_F(MeasuredY, MapsOfBothDirectionsAreErrorsToo) {
    EXPECT_EQ(shell(scratch_, "cp " TEX_SOURCE_DIR "/samples/broken/N402-mixed-y.png mixed.png").code, 0);
    const std::string found = run(scratch_, "check-normals", {"mixed.png"}).out;
    const std::size_t first = found.find("N402 mixed-y: Green points up in one part of the map and down in another: ");
    ASSERT_NE(first, std::string::npos) << found;
    const std::size_t begin = found.find("another: ", first) + 9;
    const std::string words = found.substr(begin, found.find('\n', begin) - begin);
    for (const char* command : {"pack-normals", "mip-normals"}) {
        const Ran ran = run(scratch_, command, {"mixed.png", "-o", "out.dds", "--y-in", "measured", "--quiet"});
        EXPECT_EQ(ran.code, 4);
        EXPECT_NE(ran.err.find("mixed.png: green points up in one part of the map and down in another: " + words),
                  std::string::npos)
            << ran.err;
        EXPECT_FALSE(scratch_.has("out.dds"));
    }
    const Ran held = run(scratch_, "preview-normals", {"mixed.png", "-o", "out.png", "--y-in", "measured", "--quiet"});
    EXPECT_EQ(held.code, 4);
    EXPECT_NE(held.err.find(words), std::string::npos) << held.err;
}

// What the check measures is what is read.
TEST_F(MeasuredY, RealMapsHaveOneDirection) {
    const std::string folder = TEX_SOURCE_DIR "/../shared/data/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "../shared/data is not there";
    std::vector<std::string> maps;
    for (const char* below : {"normal", "wild4/normal", "trial"}) {
        std::vector<std::string> here;
        for (const auto& entry : std::filesystem::directory_iterator(folder + below)) {
            const std::string name = entry.path().string();
            if (name.ends_with(".png") || (name.ends_with(".jpg") && name.find("normal") != std::string::npos))
                here.push_back(name);
        }
        std::sort(here.begin(), here.end());
        for (std::size_t k = 0; k < here.size(); k += 9) maps.push_back(here[k]);
    }
    for (const std::string& map : maps) {
        const auto report = check_file(map);
        if (!report || report->error) continue;
        SourceOptions options;
        options.measure_y = true;
        const auto source = read_normals(map, options);
        const std::optional<YAxis> read = source ? std::optional(source->info.y_axis) : std::nullopt;
        EXPECT_TRUE(read == report->y.y) << map << ": " << report->y.correlation << " " << report->y.confidence;
    }
}

TEST_F(MeasuredY, ItIsAKeyOfManifests) {
    scratch_.write(
        "normals.toml",
        "version = 1\n[[rule]]\nmatch = \"*.png\"\nexclude = [\"strip.png\", \"bricks.png\"]\nname = "
        "\"out/{stem}.dds\"\nsteps = [ { scale = { scale = 2, y-in = \"Measured\" } }, { mip = { y = \"up\" } } ]\n");
    make("build-normals", {});
    make("scale-normals", {"down.png", "-o", "s.exr", "--scale", "2", "--y-in", "down", "--format", "float"});
    make("mip-normals", {"s.exr", "-o", "s.dds", "--y", "up"});
    EXPECT_TRUE(scratch_.read("out/down.dds") == scratch_.read("s.dds"));
}

TEST_F(MeasuredY, FallsBackOnlyIfTheOptionSaysWhereTo) {
    const Ran flat = shell(scratch_, "convert -size 64x64 'xc:rgb(128,128,255)' flat.png");
    ASSERT_EQ(flat.code, 0) << flat.err;
    const Ran refused = run(scratch_, "pack-normals", {"flat.png", "-o", "a.tga", "--y-in", "measured", "--no-sync"});
    EXPECT_EQ(refused.code, 4);
    EXPECT_NE(refused.err.find("\"measured, else up\""), std::string::npos) << refused.err;
    for (const std::string y : {"up", "down"}) {
        for (const char* command : {"pack-normals", "unpack-normals"}) {
            const Ran made = run(scratch_, command,
                                 {"flat.png", "-o", "a.exr", "--y-in", "measured, else " + y, "--json", "--no-sync"});
            EXPECT_EQ(made.code, 0) << command << made.err;
        }
        make("pack-normals", {"down.png", "-o", "a.tga", "--y-in", "measured, else " + y, "--y", "up"});
        make("pack-normals", {"down.png", "-o", "b.tga", "--y-in", "down", "--y", "up"});
        EXPECT_TRUE(scratch_.read("a.tga") == scratch_.read("b.tga")) << "what the texels show comes first";
    }
    const Ran json = run(scratch_, "pack-normals",
                         {"flat.png", "-o", "a.exr", "--y-in", "measured, else down", "--json", "--no-sync"});
    EXPECT_NE(json.out.find("\"y\":\"down\""), std::string::npos) << json.out;
    for (const char* wrong : {"up, else down", "measured, down", "measured, else left", "measured,"})
        EXPECT_EQ(run(scratch_, "pack-normals", {"flat.png", "-o", "a.tga", "--y-in", wrong}).code, 2) << wrong;
    scratch_.write("normals.toml",
                   "version = 1\n[[rule]]\nmatch = \"flat.png\"\nname = \"made.tga\"\n"
                   "steps = [ { pack = { y-in = \"measured, else up\" } } ]\n");
    EXPECT_EQ(run(scratch_, "build-normals", {"--no-sync"}).code, 0);
}

// Blocks hold directions, and encoders let lengths go: short vectors of a rough map count, too.
TEST(MeasuredYOfBlocks, ShowsInUastcOfARoughMap) {
    const std::string map = TEX_SOURCE_DIR "/../shared/data/wild4/normal/godotdemos_sand_normal.jpg";
    if (!std::filesystem::exists(map)) GTEST_SKIP() << "no ../shared/data/wild4";
    const Scratch scratch;
    ASSERT_EQ(shell(scratch, "pack-normals " + map + " -o n.ktx2 --format uastc --no-sync --quiet").code, 0);
    EXPECT_NE(shell(scratch, "check-normals --list-y " + map).out.find(": green points down"), std::string::npos);
    const Ran ran = shell(scratch, "check-normals --list-y n.ktx2");
    EXPECT_NE(ran.out.find("n.ktx2: green points down"), std::string::npos) << ran.out;
}

}  // namespace tex::cli
