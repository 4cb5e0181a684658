// SPDX-License-Identifier: Apache-2.0
// Rules of manifests that leave inputs alone beside which there is another file.

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {

class BuildUnless : public testing::Test {
protected:
    BuildUnless() {
        for (const char* name : {"a_Height.png", "b_Height.png", "sub/[c]_Height.png"}) {
            std::filesystem::create_directories(scratch_.path("art/sub"));
            scratch_.add_sample("waves.png", std::string("art/") + name);
        }
        scratch_.write("art/a_Normal.tga", "made by hand");
        scratch_.write("art/sub/c_Normal.png", "of another texture");
    }
    Ran build(const std::string& rule) {
        scratch_.write("normals.toml",
                       "version = 1\n[[rule]]\nmatch = \"art/**/*_Height.png\"\n"
                       "steps = [ { bake = { bumpiness = 8 } } ]\n" +
                           rule);
        return run(scratch_, "build-normals", {"--no-sync"});
    }
    Scratch scratch_;
};

TEST_F(BuildUnless, AFileOfThatNameLiesBesideTheInput) {
    const Ran ran =
        build("unless = \"{dir}/{stem:-_Height}_Normal.*\"\nout-dir = \"out\"\nname = \"{dir}/{stem}.dds\"\n");
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_FALSE(scratch_.has("out/art/a_Height.dds"));
    EXPECT_TRUE(scratch_.has("out/art/b_Height.dds"));
    EXPECT_TRUE(scratch_.has("out/art/sub/[c]_Height.dds")) << "brackets in names are letters";
}

TEST_F(BuildUnless, OutputsOfTheManifestDoNotCount) {
    const std::string rule =
        "unless = [\"{dir}/{stem:-_Height}_Normal.???\"]\nname = \"{dir}/{stem:-_Height}_Normal.dds\"\n";
    EXPECT_EQ(build(rule).code, 0);
    EXPECT_TRUE(scratch_.has("art/b_Normal.dds"));
    const Ran again = run(scratch_, "build-normals", {"--no-sync", "--prune"});
    EXPECT_EQ(again.out, "0 made, 2 up to date\n") << again.out << again.err;
    EXPECT_TRUE(scratch_.has("art/b_Normal.dds"));
}

TEST_F(BuildUnless, MistakesHaveTheirPlace) {
    for (const char* wrong : {"{dir}/{level}.png", "{dir", "*/{stem}_Normal.png"}) {
        const Ran ran = build("name = \"x/{stem}.dds\"\nunless = \"" + std::string(wrong) + "\"\n");
        EXPECT_EQ(ran.code, 2) << wrong;
        EXPECT_NE(ran.err.find("normals.toml: line 6, column "), std::string::npos) << ran.err;
    }
}

}  // namespace tex::cli
