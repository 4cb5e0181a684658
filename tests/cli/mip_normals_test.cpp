// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <tex/tex.h>

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
        EXPECT_EQ(ran.err, "");
    }
    Scratch scratch_;
};

TEST_F(MipNormals, ThreeCommandsGiveTheBytesOfOne) {
    const std::vector<std::vector<std::string>> settings = {
        {},
        {"--y", "down"},
        {"--mip-filter", "kaiser", "--mip-domain", "slope", "--fade", "1,4", "--wrap", "clamp,mirror"}};
    for (const std::vector<std::string>& setting : settings) {
        std::vector<std::string> whole = {"bricks.png", "-o",       "whole.dds", "--bumpiness",
                                          "12",         "--effort", "fast"};
        std::vector<std::string> bake = {"bricks.png", "-o",       "n.exr", "--bumpiness",
                                         "12",         "--format", "float"};
        std::vector<std::string> mip = {"n.exr", "-o", "chain.exr", "--format", "float"};
        const bool is_wrap = setting.size() > 2;
        whole.insert(whole.end(), setting.begin(), setting.end());
        if (is_wrap) {
            bake.insert(bake.end(), {"--wrap", "clamp,mirror"});
            mip.insert(mip.end(), setting.begin(), setting.end());
        } else {
            bake.insert(bake.end(), setting.begin(), setting.end());  // y goes along with the files
        }
        does("bake-normals", whole);
        does("bake-normals", bake);
        does("mip-normals", mip);
        does("pack-normals", {"chain.exr", "-o", "packed.dds", "--effort", "fast"});
        EXPECT_TRUE(scratch_.read("packed.dds") == scratch_.read("whole.dds")) << setting.size();
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
}

TEST_F(MipNormals, AFileForOneLevelIsRefused) {
    does("bake-normals", {"ramp.png", "-o", "n.png"});
    const Ran ran = go("mip-normals", {"n.png", "-o", "x.png"});
    EXPECT_EQ(ran.code, 2);
    EXPECT_NE(ran.err.find("x.png: a png file holds one level"), std::string::npos) << ran.err;
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

}  // namespace tex::cli
