// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace tex::cli {

class MipNormals : public testing::Test {
protected:
    MipNormals() {
        scratch_.add_sample("bricks.png", "bricks.png");
        scratch_.add_sample("ramp.png", "ramp.png");
    }
    Ran go(const std::string& command, std::vector<std::string> arguments) {
        arguments.push_back("--no-sync");
        return run(scratch_, command, arguments);
    }
    void does(const std::string& command, const std::vector<std::string>& arguments) {
        const Ran ran = go(command, arguments);
        EXPECT_EQ(ran.code, 0) << command << " " << arguments[0] << ": " << ran.err;
        EXPECT_EQ(without_notes(ran.err), "");
    }
    Scratch scratch_;
};

// The settings of a whole run: the options for the bake, the mip chain and the packing.
struct Steps {
    std::vector<std::string> bake, mip, both, pack;  // `both`: for the first two
    std::string kind = ".dds";
};

const Steps kSteps[] = {
    {{}, {}, {}, {}},
    {{"--y", "down"}, {}, {}, {"--dds-mark"}},  // the files keep their y
    {{"--kernel", "sobel"}, {"--mip-filter", "triangle"}, {"--wrap", "clamp"}, {"--format", "bc5"}},
    {{"--kernel", "gaussian:1.5", "--invert"},
     {"--mip-filter", "mitchell", "--mip-domain", "slope"},
     {"--wrap", "mirror"},
     {"--dds-header", "dx10"}},
    {{"--kernel", "forward"}, {"--mip-filter", "lanczos3", "--fade", "0,3"}, {"--wrap", "repeat,clamp"}, {}, ".ktx2"},
    {{"--kernel", "scharr", "--y", "down"},
     {"--mip-filter", "catmull-rom", "--mip-domain", "slope", "--fade", "2,5"},
     {"--wrap", "mirror,repeat"},
     {"--format", "bc5-snorm"},
     ".ktx2"},
    {{"--kernel", "prewitt", "--blur", "1"},
     {"--mip-filter", "kaiser"},
     {"--wrap", "clamp,mirror"},
     {"--format", "rgba8"}},
    {{"--kernel", "sobel5", "--y", "down"}, {"--mip-domain", "slope"}, {}, {"--format", "rgb16"}},
    {{}, {"--fade", "1,4"}, {}, {"--format", "half"}, ".exr"},
    {{}, {"--mip-filter", "kaiser", "--mip-domain", "slope"}, {}, {"--format", "ag8"}},
    {{"--y", "down"}, {}, {}, {"--format", "rg16"}, ".ktx2"},
};

TEST_F(MipNormals, ThreeCommandsGiveTheBytesOfOne) {
    // Heights with an odd size and 16 bits.
    Texture odd;
    odd.format = Format::r16_unorm;
    odd.levels.push_back({{45, 31}, std::vector<std::byte>(2 * 45 * 31)});
    for (std::size_t k = 0; k < odd.levels[0].bytes.size(); ++k)
        odd.levels[0].bytes[k] = static_cast<std::byte>((k * k * 37 + k / 90 * 11) % 251);
    ASSERT_TRUE(write_texture(scratch_.path("odd.png"), odd));
    const auto joined = [](const std::vector<std::vector<std::string>>& parts) {
        std::vector<std::string> all;
        for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
        return all;
    };
    for (const std::string heights : {"ramp.png", "odd.png"}) {
        for (const Steps& steps : kSteps) {
            const std::string whole = "whole" + steps.kind, packed = "packed" + steps.kind;
            std::vector<std::string> pack = steps.pack;
            pack.insert(pack.end(), {"--effort", "fast"});
            does("bake-normals", joined({{heights, "-o", whole, "--mips", "all", "--bumpiness", "7"},
                                         steps.bake,
                                         steps.mip,
                                         steps.both,
                                         pack}));
            does("bake-normals",
                 joined({{heights, "-o", "n.exr", "--bumpiness", "7", "--format", "float"}, steps.bake, steps.both}));
            does("mip-normals", joined({{"n.exr", "-o", "chain.exr", "--format", "float"}, steps.mip, steps.both}));
            does("pack-normals", joined({{"chain.exr", "-o", packed}, pack}));
            EXPECT_TRUE(scratch_.read(packed) == scratch_.read(whole)) << heights << " " << &steps - kSteps;
        }
    }
}

TEST_F(MipNormals, LevelsOfTheInputAreBuiltAgain) {
    does("bake-normals", {"ramp.png", "-o", "n.ktx2", "--format", "float"});
    does("mip-normals", {"n.ktx2", "-o", "same.ktx2", "--format", "float"});
    EXPECT_TRUE(scratch_.read("same.ktx2") == scratch_.read("n.ktx2"));
    does("mip-normals", {"n.ktx2", "-o", "faded.ktx2", "--format", "float", "--fade", "0,1"});
    EXPECT_FALSE(scratch_.read("faded.ktx2") == scratch_.read("n.ktx2"));
}

TEST_F(MipNormals, EachLevelCanHaveAPicture) {
    does("bake-normals", {"ramp.png", "-o", "n.png"});
    does("mip-normals", {"n.png", "--out-dir", "levels", "--name", "{stem}_mip{level}{ext}"});
    for (int level = 0; level < 7; ++level) {
        const auto picture = read_image(scratch_.path("levels/n_mip" + std::to_string(level) + ".png"));
        ASSERT_TRUE(picture);
        EXPECT_EQ(picture->extent(), level_extent({64, 64}, level));
    }
    does("mip-normals", {"n.png", "-o", "one_{level}.png"});
    EXPECT_EQ(scratch_.read("one_3.png"), scratch_.read("levels/n_mip3.png"));
}

TEST_F(MipNormals, LargeLevelsCanBeLeftOut) {
    does("bake-normals", {"ramp.png", "--bumpiness", "1", "--mips", "all", "--name", "all_{level}.exr"});
    does("bake-normals", {"ramp.png", "--bumpiness", "1", "-o", "small.exr", "--max-size", "16"});
    EXPECT_TRUE(scratch_.read("small.exr") == scratch_.read("all_2.exr"));
    does("bake-normals", {"ramp.png", "--bumpiness", "1", "--name", "some_{level}.exr", "--max-size", "16"});
    EXPECT_TRUE(scratch_.read("some_0.exr") == scratch_.read("all_2.exr"));
    EXPECT_TRUE(scratch_.read("some_4.exr") == scratch_.read("all_6.exr"));
    EXPECT_FALSE(scratch_.has("some_5.exr"));
    does("bake-normals", {"ramp.png", "--bumpiness", "1", "-o", "n.exr"});
    does("mip-normals",
         {"n.exr", "-o", "n.dds", "--max-size", "8", "--roughness-out", "r.dds", "--roughness-in", "0.4"});
    EXPECT_EQ(read_texture(scratch_.path("n.dds"))->extent(), (Extent{8, 8}));
    EXPECT_EQ(read_texture(scratch_.path("r.dds"))->extent(), (Extent{8, 8}));
    EXPECT_EQ(read_texture(scratch_.path("r.dds"))->levels.size(), 4u);
    does("blend-normals", {"n.exr", "--detail", "n.exr", "-o", "b.png", "--max-size", "32"});
    EXPECT_EQ(read_image(scratch_.path("b.png"))->extent(), (Extent{32, 32}));
    EXPECT_EQ(go("mip-normals", {"n.exr", "-o", "x.dds", "--max-size", "0"}).code, 2);
}

TEST_F(MipNormals, AFileForOneLevelIsRefused) {
    does("bake-normals", {"ramp.png", "-o", "n.png"});
    const Ran ran = go("mip-normals", {"n.png", "-o", "x.png"});
    EXPECT_EQ(ran.code, 2);
    EXPECT_NE(ran.err.find("x.png: png files hold one level"), std::string::npos) << ran.err;
    does("mip-normals", {"n.png", "-o", "x.png", "--mips", "none"});
}

TEST_F(MipNormals, YIsThatOfTheInputUnlessAskedFor) {
    does("bake-normals", {"bricks.png", "-o", "down.exr", "--y", "down", "--bumpiness", "12"});
    const auto y_of = [&](std::vector<std::string> arguments) {
        arguments.push_back("--json");
        return nlohmann::json::parse(go("mip-normals", arguments).out)["y"].get<std::string>();
    };
    EXPECT_EQ(y_of({"down.exr", "-o", "x.dds"}), "down");
    EXPECT_EQ(y_of({"down.exr", "-o", "x.dds", "--y", "up"}), "up");
    EXPECT_EQ(y_of({"down.exr", "-o", "x.dds", "--y-in", "up"}), "up");
}

// A roughness map with one value everywhere gives the same bytes as that value given as a number, in every file type.
TEST_F(MipNormals, RoughnessComesFromAMapAsFromANumber) {
    scratch_.add_sample("waves.png", "h.png");
    does("bake-normals", {"h.png", "-o", "n.png", "--bumpiness", "8"});
    const std::string grey = "P5\n128 128\n255\n" + std::string(128 * 128, '\x33');
    scratch_.write("same.pgm", grey);
    scratch_.write("other.pgm", "P5\n3 5\n255\n" + std::string(15, '\x33'));
    for (const std::string name : {"r.dds", "r.exr", "r.tif"}) {
        const std::string level = name == "r.tif" ? "r{level}.tif" : name;
        const std::string base = name == "r.tif" ? "r0.tif" : name;
        does("mip-normals", {"n.png", "-o", "x.dds", "--roughness-out", level, "--roughness-in", "0.2"});
        const std::string expected = scratch_.read(base), normals = scratch_.read("x.dds");
        for (const std::string map : {"same.pgm", "other.pgm"}) {
            SCOPED_TRACE(name + " " + map);
            does("mip-normals", {"n.png", "-o", "x.dds", "--roughness-out", level, "--roughness-in", map});
            EXPECT_TRUE(scratch_.read(base) == expected || map == "other.pgm");
            EXPECT_FALSE(scratch_.read(base).empty());
            EXPECT_TRUE(scratch_.read("x.dds") == normals);
        }
    }
}

}  // namespace tex::cli
