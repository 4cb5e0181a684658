// SPDX-License-Identifier: Apache-2.0
// Pictures with the names of normal maps or heights that no rule of a manifest is for: build-normals names them.

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {

class BuildWithoutRule : public testing::Test {
protected:
    BuildWithoutRule() {
        for (const char* folder : {"art/wip", "other"}) std::filesystem::create_directories(scratch_.path(folder));
        scratch_.add_sample("waves.png", "art/a_height.png");
    }
    Ran build(const std::vector<std::string>& options = {}, const std::string& more = {}) {
        scratch_.write("normals.toml",
                       "version = 1\n[[rule]]\nmatch = \"art/**/*_height.png\"\n" + more +
                           "steps = [ { bake = { bumpiness = 8 } } ]\nname = \"{dir}/{stem:-_height}_n.png\"\n");
        std::vector<std::string> all = {"--no-sync"};
        all.insert(all.end(), options.begin(), options.end());
        return run(scratch_, "build-normals", all);
    }
    Scratch scratch_;
};

TEST_F(BuildWithoutRule, IsNamed) {
    for (const char* name : {"b_nrm.png", "cNormal.tga", "d-normal.png", "e_disp.exr"})
        scratch_.write(std::string("art/") + name, "never opened");
    const Ran ran = build();
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.err.find("no rule is for 4 pictures named like normal maps or heights, such as art/b_nrm.png, "
                           "art/cNormal.tga; list under exclude"),
              std::string::npos)
        << ran.err;
    EXPECT_NE(build({"--dry-run"}).err.find("art/d-normal.png, art/e_disp.exr;"), std::string::npos);
    EXPECT_EQ(build({"--quiet"}).err, "");
}

TEST_F(BuildWithoutRule, SaysNothingOfWhatNeedsNone) {
    // Colours; heights whose normal map is here; a texture; what is left out on purpose; another folder.
    for (const char* name : {"art/b_basecolor.png", "art/a_disp.png", "art/b_n.dds", "art/wip/c_n.png",
                             "art/notes_n.txt", "other/d_n.png"})
        scratch_.write(name, "never opened");
    const Ran first = build({}, "exclude = \"art/wip/**\"\n");
    EXPECT_EQ(first.code, 0);
    EXPECT_EQ(first.err, "");
    // Now art/a_n.png, which this manifest makes, is there.
    EXPECT_EQ(build({}, "exclude = \"art/wip/**\"\n").err, "");
}

}  // namespace tex::cli
